#include <gtest/gtest.h>

#include "../../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "results.hpp"

namespace dovetail::atlas {
namespace {

using io::test::messageOf;
using io::test::ScratchFolder;
using io::test::writeText;
using report::Json;

Result resultOf(const std::string& id, const std::string& command, const char* content) {
  return {id, command, 1.0, 0, Json::parse(content)};
}

TEST(Fronts, HoldWhatNoOtherRunBeats) {
  const Result study = resultOf("wave-pareto", "wave --study pareto --only 'n = 1' --out there", R"({"runs": [
    {"label": "n = 1, penalty", "outcome": "finished", "wall_seconds": 1, "waveform_error_fem": 0.1, "energy_lost_fraction": -1e-5},
    {"label": "n = 1, multiplier", "outcome": "finished", "wall_seconds": 2, "waveform_error_fem": 0.2, "energy_lost_fraction": 1e-6},
    {"label": "n = 1, paper", "outcome": "broke down", "wall_seconds": 0.1, "waveform_error_fem": 0.001}]})");
  const Chapter chapter = frontsOf({study});
  ASSERT_EQ(chapter.rows.size(), 4u);  // two figures of the two that finished
  EXPECT_EQ(chapter.rows[0]["on_front"], true);
  EXPECT_EQ(chapter.rows[1]["on_front"], false);
  EXPECT_EQ(chapter.rows[2]["error"], 1e-5);
  EXPECT_EQ(chapter.rows[3]["on_front"], true);
  EXPECT_EQ(chapter.rows[1]["command"], "wave --study pareto --only 'n = 1, multiplier'");
}

TEST(Maps, TellSurvivedRefusedAndFailedWithTheCommandThatRepeatsThem) {
  const Result study = resultOf("wave-stability", "wave --study stability --out there", R"({"runs": [
    {"label": "penalty, weight floor 0.1", "outcome": "finished", "message": "", "ledger_residual_relative": 2e-5},
    {"label": "penalty, weight floor 0.01, dt auto", "outcome": "refused", "message": "too long a step"},
    {"label": "multiplier, weight floor 0.1", "outcome": "not stable", "message": ""},
    {"label": "penalty, dt at 1.2 of the critical step, insisted on", "outcome": "not stable", "message": ""}]})");
  const Chapter chapter = mapsOf({study});
  ASSERT_EQ(chapter.rows.size(), 3u);  // what was insisted on against the limit is no cell
  EXPECT_EQ(chapter.rows[0]["outcome"], "survived");
  EXPECT_EQ(chapter.rows[1]["outcome"], "refused");
  EXPECT_EQ(chapter.rows[1]["row"], "penalty, dt auto");
  EXPECT_EQ(chapter.rows[1]["column"], "0.01");
  EXPECT_NE(chapter.rows[1]["detail"].get<std::string>().find("too long a step"), std::string::npos);
  EXPECT_EQ(chapter.rows[2]["outcome"], "failed");
  EXPECT_NE(chapter.rows[2]["detail"].get<std::string>().find(
                "wave --study stability --out there --only 'multiplier, weight floor 0.1'"),
            std::string::npos);
}

TEST(Maps, OfScenesAskForTheEnergy) {
  const Result study =
      resultOf("map: Grains", "dovetail study a.json --over m=1,2 --over k=3,4 --out there", R"({"runs": [
    {"label": "m=1, k=3", "outcome": "finished", "message": "", "largest_residual_fraction": 1e-4, "settings": {"m": "1", "k": "3"}},
    {"label": "m=1, k=4", "outcome": "finished", "message": "", "largest_residual_fraction": 0.12, "settings": {"m": "1", "k": "4"}},
    {"label": "m=2, k=3", "outcome": "finished", "message": "", "largest_residual_fraction": null, "settings": {"m": "2", "k": "3"}}]})");
  const Chapter chapter = mapsOf({study});
  ASSERT_EQ(chapter.rows.size(), 3u);
  EXPECT_EQ(chapter.rows[0]["outcome"], "survived");
  EXPECT_EQ(chapter.rows[1]["outcome"], "failed");
  EXPECT_EQ(chapter.rows[2]["outcome"], "failed");  // nothing is known of its energy
  EXPECT_NE(chapter.rows[1]["detail"].get<std::string>().find("dovetail run a.json --set 'm=1' --set 'k=4'"),
            std::string::npos);
}

TEST(Overhead, AreTablesAndRowsOfNumbers) {
  const Result study = resultOf("overhead", "scripts/overhead", R"({"unit": "s",
    "by_hand": {"grains": 27000, "hand_ns": 23, "ns": 24, "ratio": 1.04, "ratio_lower_quartile": 1.03, "ratio_upper_quartile": 1.06},
    "features": [{"feature": "nothing", "used": false, "ns": 24, "cost_fraction": 0.001},
                 {"feature": "friction", "used": true, "ns": 60, "cost_fraction": 1.5, "bytes_per_grain": 137}],
    "parts": [{"part": "grains only", "grains": 8000, "elements": 0, "bytes": 1500000, "libraries": ["libA", "libB"],
               "start_scene_s": 0.02, "start_program_s": 0.01, "bytes_each_scene": 580, "bytes_each_program": 570, "steps": 100,
               "cost_scene": 1.01, "cost_program": 1.0, "cost_fraction": 0.011, "profile": [{"part": "pairs", "fraction": 0.8}, {"part": "move", "fraction": 0.2}]}],
    "dovetail": {"bytes": 9000000, "libraries": ["libA"]}})");
  const Chapter chapter = overheadOf({study});
  ASSERT_EQ(chapter.rows.size(), 5u);
  EXPECT_EQ(chapter.rows[3]["libraries"], 2);
  EXPECT_EQ(chapter.rows[3]["profile"], "pairs 80, move 20");
  const std::string page = report::markdownOf({"Overhead", chapter.sections}, "");
  for (const char* const told : {"1.040", "nothing", "friction", "+150.00", "20 / 10", "+1.1", "9.0 MB, 1 libraries"})
    EXPECT_NE(page.find(told), std::string::npos) << told << " in " << page;
}

TEST(Results, AreReadFromTheirFolderOrRefused) {
  const ScratchFolder folder;
  EXPECT_NE(messageOf<InputError>([&] { readResults(folder.path()); }).find("runs.json"), std::string::npos);
  writeText(folder / "runs.json", R"([{"id": "a", "command": "b", "seconds": 2, "status": 0, "result": "a.json"},
                                      {"id": "c", "command": "d", "seconds": 2, "status": 1, "result": "c.json"}])");
  writeText(folder / "a.json", "{\"runs\": []}");
  const std::vector<Result> results = readResults(folder.path());
  ASSERT_EQ(results.size(), 2u);
  EXPECT_NE(find(results, "a"), nullptr);
  EXPECT_EQ(find(results, "c"), nullptr);  // it left nothing
  writeText(folder / "a.json", "{");
  EXPECT_NE(messageOf<InputError>([&] { readResults(folder.path()); }).find("a.json"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::atlas
