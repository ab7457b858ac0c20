#include <gtest/gtest.h>

#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/run_report.hpp"

namespace dovetail::report {
namespace {

using io::test::messageOf;
using io::test::readText;
using io::test::ScratchFolder;
using io::test::writeText;

const char* const summary = R"(# version: dovetail 0.1.0
A plate
stage 1: 10.268 s
WARNING: at t = 1 s the step exceeds the limit of 2 s set by a contact: take a smaller steps.dt
44 particles, "plate" of 315 nodes at 0.0199998 s
step 8.1429e-07 s, 8.1429e-07 s of the solids; at most 4.06467e-06 s, set by element 121 of "plate"
  channel (J)                           at opening           now        change
  particles: kinetic                     0.0589782     0.0305167    -0.0284615
  particles: dashpots [booked]                   0    0.00956859    0.00956859
  stored total                           0.0589782     0.0305167    -0.0284615
  residual                                                        -1.50222e-06
momentum (kg m/s) and angular momentum about the origin (kg m^2/s)
  now                                 1.6796e-04  2.3863e-04  2.4066e-02 -2.7360e-05 -3.9850e-03  3.8971e-05
  residual over all impulses 3.21553e-15, over their moments 2.83337e-14; mass 0.109489 kg, residual 1e-17 kg
  stage                            seconds     fraction   us per call
  solids kick and drift              0.085    99.1 %           1.7
)";

std::string figure(const RunRecord& record, const std::string& name) {
  for (const auto& [key, value] : record.figures)
    if (key == name) return value;
  return "";
}

TEST(RunRecord, TakesWhatASummarySays) {
  RunRecord record;
  readSummaryText(summary, record);
  ASSERT_EQ(record.channels.size(), 2u);
  EXPECT_EQ(record.channels[0].name, "particles: kinetic");
  EXPECT_EQ(record.channels[0].joulesAtOpening, 0.0589782);
  EXPECT_EQ(record.channels[1].kind, EnergyLedger::Kind::booked);
  EXPECT_EQ(record.channels[1].joules, 0.00956859);
  EXPECT_EQ(record.residual, -1.50222e-06);
  EXPECT_EQ(figure(record, "seconds of stage 1"), "10.268");
  EXPECT_EQ(figure(record, "step (s)"), "8.1429e-07");
  EXPECT_EQ(figure(record, "critical step at the end (s)"), "4.06467e-06");
  EXPECT_EQ(figure(record, "set by"), "element 121 of \"plate\"");
  EXPECT_EQ(figure(record, "momentum residual over all impulses"), "3.21553e-15");
  EXPECT_EQ(figure(record, "mass residual (kg)"), "1e-17");
  ASSERT_EQ(record.warnings.size(), 1u);
  ASSERT_EQ(record.stages.size(), 1u);
  EXPECT_EQ(record.stages[0].seconds, 0.085);
  EXPECT_EQ(record.stages[0].calls, 50000);
}

TEST(RunRecord, TakesWhatAJsonSummarySays) {
  RunRecord record;
  readSummaryJson(R"({"time_mean_error_m": 0.5, "failure": "node 3", "none": null, "settings": {"scheme": "paper"},
    "ledger": [{"channel": "kinetic", "kind": "stored", "at_opening_J": 1, "at_end_J": 2.5}],
    "profile": [{"stage": "sweep", "seconds": 0.25, "calls": 10}]})",
                  "summary.json", record);
  EXPECT_EQ(figure(record, "time_mean_error_m"), "0.5");
  EXPECT_EQ(record.channels.at(0).joules, 2.5);
  EXPECT_EQ(record.stages.at(0).calls, 10);
  EXPECT_EQ(record.warnings.at(0), "node 3");
  for (const char* bad : {"[]", "{", "{\"ledger\": [1]}", "{\"profile\": [{}]}"})
    EXPECT_NE(messageOf<InputError>([&] { readSummaryJson(bad, "there.json", record); }).find("there.json"),
              std::string::npos);
}

TEST(RunRecord, TakesWhatTheJsonSummaryOfASceneSays) {
  RunRecord record;
  readSummaryJson(R"({"time_s": 1, "step": {"dt_s": 1e-6, "window_s": 1e-6, "limit_s": 4e-6, "limited_by": "node 7"},
    "energy": {"channels": {"plate: kinetic": {"kind": "stored", "now_J": 2.5, "at_start_J": 1},
                            "plate: work": {"kind": "booked", "now_J": null, "at_start_J": 0}},
               "residual_J": -1e-7, "largest_residual_J": 2e-7},
    "momentum": {"residual": {"linear_Ns": [1e-15, 0, null]}, "turned_over_Ns": 3, "mass_residual_kg": 0},
    "times": {"stages": [{"stage": 1, "do": "run", "seconds": 12.5}], "parts": [{"part": "sweep", "seconds": 0.5, "calls": 10}]},
    "warnings": ["WARNING: beyond"]})",
                  "summary.json", record);
  ASSERT_EQ(record.channels.size(), 2u);
  EXPECT_EQ(record.channels[0].joules, 2.5);
  EXPECT_EQ(record.channels[0].joulesAtOpening, 1.0);
  EXPECT_EQ(record.channels[1].kind, EnergyLedger::Kind::booked);
  EXPECT_EQ(record.residual, -1e-7);
  EXPECT_EQ(figure(record, "critical step at the end (s)"), "4e-06");
  EXPECT_EQ(figure(record, "set by"), "node 7");
  EXPECT_EQ(figure(record, "seconds of stage 1 (run)"), "12.5");
  EXPECT_EQ(record.stages.at(0).name, "sweep");
  EXPECT_EQ(record.warnings, (std::vector<std::string>{"WARNING: beyond"}));
}

TEST(RunReport, IsOnePageWithFiguresTablesAndOrigin) {
  const ScratchFolder folder;
  writeText(folder / "summary.txt", summary);
  writeText(folder / "series.csv",
            "# version: dovetail 0.1.0\ntime_s,plate_kinetic_J,residual_J,momentum_x_Ns\n0,1,0,2\n1,3,1e-6,2\n");
  writeText(folder / "scene.json", "// version: dovetail 0.1.0\n{\"title\": \"A <plate>\", \"gravity\": 1}\n");
  EXPECT_EQ(writeRunReport(folder.path()), folder / "report.html");
  const std::string html = readText(folder / "report.html"), markdown = readText(folder / "report.md");
  for (const char* part :
       {"<h1>A &lt;plate&gt;</h1>", "plate kinetic", "4.06467e-06", "element 121", "10.268", "WARNING", "0.0305167",
        "-1.5e-06", "3.21553e-15", "solids kick and drift", "dovetail 0.1.0"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  for (const char* part : {"src=", "href=", "<script", "http://localhost"})
    EXPECT_EQ(html.find(part), std::string::npos) << part << ": the page stands alone";
  for (const char* part : {"# A <plate>", "| particles: kinetic | 0.0589782 | 0.0305167 |", "(report_energies.svg)"})
    EXPECT_NE(markdown.find(part), std::string::npos) << part << " in\n" << markdown;
  for (const char* name : {"report_energies.svg", "report_residual.svg", "report_stages.svg"})
    EXPECT_TRUE(io::isOurs(folder / name)) << name;
  writeRunReport(folder.path());  // anew
}

TEST(RunReport, FiguresOfOneColumnSayWhatItIs) {
  const ScratchFolder folder;
  writeText(folder / "series.csv", "time_s,particles,limit_s\n0,2,1e-4\n1,3,2e-4\n");
  const std::string html = readText(writeRunReport(folder.path()));
  for (const char* part : {">Particles<", ">number<", ">Largest stable step<", "largest stable step (s)"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(RunReport, OfARunThatWasBrokenOffSaysSo) {
  const ScratchFolder folder;
  writeText(folder / "series.csv", "time_s,plate_kinetic_J\n0,1\n");
  EXPECT_NE(readText(writeRunReport(folder.path())).find("has not finished"), std::string::npos);
}

TEST(RunReport, RefusesWhatIsNoRunAndWhatOthersWrote) {
  const ScratchFolder folder;
  EXPECT_NE(messageOf<InputError>([&] { writeRunReport(folder.path()); }).find("no series.csv"), std::string::npos);
  writeText(folder / "series.csv", "time_s\n0\n");
  writeText(folder / "report.html", "mine");
  EXPECT_THROW(writeRunReport(folder.path()), InputError);
  EXPECT_EQ(readText(folder / "report.html"), "mine");
}

TEST(Page, MapsTellTheirOutcomesAndOpenTheirDetails) {
  Map map{"Steps",    "dt",        "mass",
          {"1", "2"}, {"<heavy>"}, {{{Map::Outcome::survived, "1e-5", "as asked\nrun --dt 1"}, {}}}};
  map.cells[0][1] = {Map::Outcome::refused, "", "too long"};
  const std::string html = htmlOf({"t", {{"h", {map, map}}}}, "mark");
  for (const char* part : {"class=\"survived\"", ">1e-5</button>", "run --dt 1", "mass &lt;heavy&gt;, dt 2: refused",
                           "popovertarget=\"map0-0-0\"", "id=\"map1-0-1\""})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  const std::string markdown = markdownOf({"t", {{"h", {map}}}}, "");
  EXPECT_NE(markdown.find("| &lt;heavy> | 1e-5 survived | refused |"), std::string::npos) << markdown;
  EXPECT_NE(markdown.find("- mass &lt;heavy>, dt 2: too long"), std::string::npos) << markdown;
}

TEST(Page, CellsOfTablesCannotBreakThem) {
  const Table table{{"name", "value"}, {{"a|b <c>\nd", "1.5"}}};
  EXPECT_EQ(markdownOf(table), "| name | value |\n|---|---:|\n| a\\|b &lt;c> d | 1.5 |\n");
  const std::string html = htmlOf({"t", {{"h", {table}}}}, "mark");
  EXPECT_NE(html.find("a|b &lt;c&gt;"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"n\">1.5</td>"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::report
