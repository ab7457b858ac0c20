#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <thread>

#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/report/study.hpp"

namespace dovetail::report {
namespace {

using io::test::readText;
using io::test::ScratchFolder;

/// Errors 1, 0.5, …; the third is refused, the fourth throws, the fifth ends its process where it has one.
Study studyIn(const std::filesystem::path& folder, int workers) {
  Study study;
  study.program = "test";
  study.name = "five";
  study.folder = folder;
  study.workers = workers;
  study.fronts = {{"error", "on_front"}};
  study.shown = {"error"};
  for (int k = 0; k < 5; ++k)
    study.cases.push_back(
        {"run " + std::to_string(k), {{"number", std::to_string(k)}}, [k, workers]() -> Json {
           // Later ones end earlier.
           if (workers > 0) std::this_thread::sleep_for(std::chrono::milliseconds(40 - 10 * k));
           if (k == 2) throw InputError("too much", "here", "give less");
           if (k == 3) throw NumericalError("NaN", "node 3", "");
           if (k == 4 && workers > 0) ::_exit(3);
           return {{"finished", true}, {"stable", k != 4}, {"wall_seconds", k + 1.0}, {"error", std::pow(0.5, k)}};
         }});
  return study;
}

TEST(Study, WritesTheSameTableWhateverTheProcesses) {
  std::vector<std::string> tables;
  for (const int workers : {0, 1, 3}) {
    const ScratchFolder folder;
    std::ostringstream log, error;
    EXPECT_TRUE(runStudy(studyIn(folder.path(), workers), log, error));
    EXPECT_EQ(error.str(), "");
    EXPECT_EQ(folder.content(), (std::set<std::string>{"five.csv", "five.json", "five.md", "five.svg"}));
    const Json json = Json::parse(readText(folder / "five.json"));
    ASSERT_EQ(json["runs"].size(), 5u);
    const char* const outcomes[] = {"finished", "finished", "refused", "broke down",
                                    workers > 0 ? "broke down" : "not stable"};
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_EQ(json["runs"][k]["label"], "run " + std::to_string(k));
      EXPECT_EQ(json["runs"][k]["outcome"], outcomes[k]) << k;
      EXPECT_EQ(json["runs"][k]["on_front"], k < 2);
    }
    EXPECT_EQ(json["runs"][2]["message"], "too much [here]: give less");
    EXPECT_NE(readText(folder / "five.md").find("| run 1 | finished | 2 | 0.5 | yes |"), std::string::npos);
    EXPECT_NE(log.str().find("error 0.5"), std::string::npos);
    if (workers > 0) tables.push_back(readText(folder / "five.csv"));
  }
  EXPECT_EQ(tables[0], tables[1]);
  EXPECT_NE(tables[0].find("\nlabel,outcome,message,finished,stable,wall_seconds,error,on_front,number\n"),
            std::string::npos)
      << tables[0];
}

TEST(Study, RepeatsAreOnePointAndWaysAreCurves) {
  const ScratchFolder folder;
  Study study;
  study.program = "test";
  study.name = "ways";
  study.folder = folder.path();
  study.fronts = {{"error", "on_front"}};
  study.quiet = true;
  // Way a: errors 1, 3 and 2, 2 at 1 and 4 s; way b: 4 in 2 s, and one that fails; a third is beaten.
  const auto add = [&](const char* way, const char* point, double seconds, double error) {
    study.cases.push_back({std::string(way) + point + std::to_string(study.cases.size()),
                           {},
                           [=]() -> Json {
                             if (error == 0.0) throw NumericalError("NaN", "", "");
                             return {{"wall_seconds", seconds}, {"error", error}};
                           },
                           way,
                           point});
  };
  add("a", "fine", 3.0, -1.0);
  add("a", "fine", 5.0, 1.0);
  add("a", "coarse", 1.0, 1.0);
  add("a", "coarse", 1.0, -3.0);
  add("b", "b", 2.0, 4.0);
  add("b", "b", 2.0, 0.0);
  study.relate = [](std::vector<Json>& rows) -> Json {
    for (Json& row : rows)
      if (!row.is_null()) row["rows"] = rows.size();
    return {{"scatter", 0.5}};
  };
  std::ostringstream log, error;
  EXPECT_TRUE(runStudy(study, log, error));
  const Json json = Json::parse(readText(folder / "ways.json"));
  EXPECT_EQ(json["scatter"], 0.5);
  ASSERT_EQ(json["points"].size(), 3u);
  const auto expect = [&](std::size_t k, const char* point, int runs, double seconds, double mean, double low,
                          double high, bool front) {
    const Json& row = json["points"][k];
    EXPECT_EQ(row["point"], point);
    EXPECT_EQ(row["runs"], runs);
    EXPECT_EQ(row["wall_seconds"], seconds);
    EXPECT_EQ(row["error"], mean);
    EXPECT_EQ(row["lowest"], low);
    EXPECT_EQ(row["highest"], high);
    EXPECT_EQ(row["on_front"], front) << point;
  };
  expect(0, "fine", 2, 4.0, 1.0, 1.0, 1.0, true);
  expect(1, "coarse", 2, 1.0, 2.0, 1.0, 3.0, true);
  expect(2, "b", 1, 2.0, 4.0, 4.0, 4.0, false);
  for (const Json& run : json["runs"]) EXPECT_EQ(run["rows"], 6u);
  EXPECT_EQ(json["runs"][3]["on_front"], true);
  EXPECT_EQ(json["runs"][5]["on_front"], false);
  EXPECT_NE(readText(folder / "ways.md").find("| a: coarse | 2 | 1 | 2 | 1 | 3 | yes |"), std::string::npos);
  EXPECT_NE(readText(folder / "ways.md").find("| b | 1 | 2 | 4 | 4 | 4 |  |"), std::string::npos);
  const std::string svg = readText(folder / "ways.svg");
  for (const char* const name : {">a<", ">b<", ">scatter of the reference<"})
    EXPECT_NE(svg.find(name), std::string::npos) << name;
}

TEST(Study, CasesBeginWhenThoseBeforeHaveFinished) {
  for (const int workers : {0, 1, 3}) {
    const ScratchFolder folder;
    Study study;
    study.program = "test";
    study.name = "after";
    study.folder = folder.path();
    study.workers = workers;
    study.quiet = true;
    const auto file = [&](int k) { return folder / ("of-" + std::to_string(k)); };
    const auto add = [&](bool fails, std::vector<std::size_t> after) {
      const int number = static_cast<int>(study.cases.size());
      study.cases.push_back({"case " + std::to_string(number), {}, [=]() -> Json {
                               for (const std::size_t k : after)
                                 if (!std::filesystem::exists(file(static_cast<int>(k))))
                                   throw InputError("early", "", "");
                               std::this_thread::sleep_for(std::chrono::milliseconds(number == 0 ? 30 : 1));
                               if (fails) throw NumericalError("NaN", "", "");
                               io::test::writeText(file(number), "done");
                               return {{"wall_seconds", 1.0}};
                             }});
      study.cases.back().after = std::move(after);
    };
    add(false, {});
    add(false, {0});  // waits, while the third goes on
    add(true, {});
    add(false, {0, 2});
    add(false, {1});
    add(false, {3});
    std::ostringstream log, error;
    EXPECT_TRUE(runStudy(study, log, error));
    const Json runs = Json::parse(readText(folder / "after.json"))["runs"];
    const char* const outcomes[] = {"finished", "finished", "broke down", "refused", "finished", "refused"};
    ASSERT_EQ(runs.size(), 6u);
    for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(runs[k]["outcome"], outcomes[k]) << k << " " << runs[k]["message"];
    EXPECT_NE(runs[3]["message"].get<std::string>().find("\"case 2\", which did not finish"), std::string::npos);
  }
}

TEST(Study, RefusesAFolderThatHoldsSomebodyElsesTable) {
  const ScratchFolder folder;
  io::test::writeText(folder / "five.csv", "mine");
  std::ostringstream log, error;
  EXPECT_THROW(runStudy(studyIn(folder.path(), 0), log, error), InputError);
  EXPECT_EQ(readText(folder / "five.csv"), "mine");
}

}  // namespace
}  // namespace dovetail::report
