#include <gtest/gtest.h>

#include <cmath>

#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/run_report.hpp"
#include "dovetail/report/summary.hpp"

namespace dovetail::report {
namespace {

using io::test::messageOf;
using io::test::readText;
using io::test::ScratchFolder;
using io::test::writeText;

const char* const summary = R"({
  "provenance": {"version": "dovetail 0.1.0"}, "version": 1, "title": "A plate", "time_s": 0.02, "particles": 44,
  "step": {"dt_s": 8.1429e-07, "window_s": 1e-6, "limit_s": 4.06467e-06, "limited_by": "element 121 of \"plate\""},
  "energy": {"channels": {"particles: kinetic": {"kind": "stored", "now_J": 0.0305167, "at_start_J": 0.0589782},
                          "plate: work": {"kind": "booked", "now_J": null, "at_start_J": 0}},
             "residual_J": -1.50222e-06, "largest_residual_J": 2e-6},
  "momentum": {"residual": {"linear_Ns": [3.21553e-15, 0, null]}, "turned_over_Ns": 3, "mass_residual_kg": 0},
  "times": {"stages": [{"stage": 1, "do": "run", "seconds": 10.268}],
            "parts": [{"part": "solids kick and drift", "seconds": 0.085, "calls": 50000}]},
  "notes": ["a mesh was cut"], "warnings": ["at t = 1 s the step is beyond"]
})";

RunRecord recordOf(const std::string& text) {
  const ScratchFolder folder;
  writeText(folder / "summary.json", text);
  return readRunFolder(folder.path());
}

std::string figure(const RunRecord& record, const std::string& name) {
  for (const auto& [key, value] : record.figures)
    if (key == name) return value;
  return "";
}

TEST(RunRecord, TakesWhatTheSummaryOfASceneSays) {
  const RunRecord record = recordOf(summary);
  ASSERT_EQ(record.channels.size(), 2u);
  EXPECT_EQ(record.channels[0].name, "particles: kinetic");
  EXPECT_EQ(record.channels[0].joulesAtOpening, 0.0589782);
  EXPECT_EQ(record.channels[0].joules, 0.0305167);
  EXPECT_EQ(record.channels[1].kind, EnergyLedger::Kind::booked);
  EXPECT_EQ(record.residual, -1.50222e-06);
  EXPECT_EQ(figure(record, "critical step at the end (s)"), "4.06467e-06");
  EXPECT_EQ(figure(record, "set by"), "element 121 of \"plate\"");
  EXPECT_EQ(figure(record, "seconds of stage 1 (run)"), "10.268");
  EXPECT_EQ(record.stages.at(0).name, "solids kick and drift");
  EXPECT_EQ(record.stages.at(0).calls, 50000);
  EXPECT_EQ(record.warnings, (std::vector<std::string>{"at t = 1 s the step is beyond"}));
  EXPECT_EQ(record.notes, (std::vector<std::string>{"a mesh was cut", "44 particles at t = 0.02 s"}));
}

TEST(RunRecord, TakesWhatTheSummaryOfACaseSays) {
  const RunRecord record = recordOf(R"({"provenance": {}, "version": 1,
    "results": {"time_mean_error_m": 0.5, "failure": "node 3", "none": null}, "settings": {"scheme": "paper"}})");
  EXPECT_EQ(figure(record, "time_mean_error_m"), "0.5");
  EXPECT_EQ(record.warnings.at(0), "node 3");
  EXPECT_NE(record.scene.find("paper"), std::string::npos);
}

TEST(RunRecord, SummariesThatAreDamagedOrOfOtherVersionsAreRefused) {
  for (const char* bad : {"[]", "{", "{}", R"({"provenance": {}, "version": 1, "energy": {}})",
                          R"({"provenance": {}, "version": 1, "times": {"parts": [{}]}})", R"({"provenance": {}})",
                          R"({"provenance": {}, "version": 2})"})
    EXPECT_NE(messageOf<InputError>([&] { recordOf(bad); }).find("summary.json"), std::string::npos) << bad;
}

TEST(Summary, IsReadAsItWasWritten) {
  const ScratchFolder folder;
  EnergyLedger ledger;
  ledger.set(ledger.addStored("kinetic"), 2.0);
  ledger.add(ledger.addBooked("lost"), 1.0);
  Profile profile(true);
  profile.add("part", 0.25);
  io::TimeSeries series({"time_s", "x_m"});
  for (const double x : {1.0, -2.0, 0.5}) series.append(std::vector{std::abs(x), x});
  writeSummary(folder / "summary.json", io::provenance(),
               {{"energy", energyOf(ledger)},
                {"times", timesOf(profile)},
                {"figures", figuresOf(series)},
                {"time_s", std::nan("")}});
  EXPECT_TRUE(io::isOurs(folder / "summary.json"));
  const Json read = readSummary(folder / "summary.json");
  EXPECT_EQ(read.at("version"), summaryVersion);
  EXPECT_EQ(read.at("energy"), energyOf(ledger));
  EXPECT_EQ(read.at("energy").at("channels").at("lost").at("now_J"), 1.0);
  EXPECT_EQ(read.at("times").at("parts").at(0).at("seconds"), 0.25);
  EXPECT_EQ(read.at("figures").at("x_m"), (Json{{"first", 1.0}, {"last", 0.5}, {"least", -2.0}, {"largest", 1.0}}));
  EXPECT_TRUE(read.at("time_s").is_null());
}

TEST(RunReport, IsOnePageWithFiguresTablesAndOrigin) {
  const ScratchFolder folder;
  writeText(folder / "summary.json", summary);
  writeText(folder / "series.csv",
            "# version: dovetail 0.1.0\ntime_s,plate_kinetic_J,residual_J,momentum_x_Ns\n0,1,0,2\n1,3,1e-6,2\n");
  writeText(folder / "scene.json", "// version: dovetail 0.1.0\n{\"title\": \"A <plate>\", \"gravity\": 1}\n");
  EXPECT_EQ(writeRunReport(folder.path()), folder / "report.html");
  const std::string html = readText(folder / "report.html"), markdown = readText(folder / "report.md");
  for (const char* part : {"<h1>A &lt;plate&gt;</h1>", "plate kinetic", "4.0647e-06", "element 121", "10.268", "beyond",
                           "0.030517", "-1.5e-06", "3.2155e-15", "solids kick and drift", "dovetail 0.1.0"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  for (const char* part : {"src=\"http", "src=\"report", "href=", "<script", "http://localhost"})
    EXPECT_EQ(html.find(part), std::string::npos) << part << ": the page stands alone";
  for (const char* part : {"# A &lt;plate>", "| particles: kinetic | 0.058978 | 0.030517 |", "(report_energies.svg)"})
    EXPECT_NE(markdown.find(part), std::string::npos) << part << " in\n" << markdown;
  for (const char* name : {"report_energies.svg", "report_residual.svg", "report_stages.svg"})
    EXPECT_TRUE(io::isOurs(folder / name)) << name;
  writeRunReport(folder.path());  // anew
}

TEST(RunReport, ThePictureStandsFirstInBothPages) {
  const ScratchFolder folder;
  writeText(folder / "summary.json", summary);
  const std::string png =
      std::string("\x89PNG\r\n\x1a\n") + std::string(33, 'x') + "Software" + '\0' + "dovetail 0.1.0 abc";
  writeRunReport(folder.path(), {"picture", "t = 1 s; grains: <speed>", png});
  const std::string html = readText(folder / "report.html"), markdown = readText(folder / "report.md");
  EXPECT_NE(html.find("src=\"data:image/png;base64,iVBORw0KGgp4eHh4"), std::string::npos);
  EXPECT_NE(html.find("grains: &lt;speed&gt;</figcaption>"), std::string::npos);
  EXPECT_NE(markdown.find("![t = 1 s; grains: &lt;speed>](report_picture.png)"), std::string::npos) << markdown;
  EXPECT_EQ(readText(folder / "report_picture.png"), png);
  EXPECT_LT(html.find("<img"), html.find("<svg"));
  writeRunReport(folder.path());  // without one, none is left
  EXPECT_FALSE(std::filesystem::exists(folder / "report_picture.png"));
}

TEST(RunReport, LinesEndWhereAStageRelaxesAndFlatOnesAreLeftOut) {
  const ScratchFolder folder;
  std::string rows = "time_s,a_x_m,a_y_m,momentum_x_Ns,momentum_y_Ns,limit_s\n0,77,1,5,1e-17,1e-4\n";
  for (int k = 0; k < 10; ++k)
    rows += std::to_string(10.0 + 0.1 * k) + "," + std::to_string(k) + ",1,5,2e-17,1.0000000000001e-4\n";
  rows += "30,20,1,5,1e-17,1e-4\n";
  writeText(folder / "series.csv", rows);
  const std::string html = readText(writeRunReport(folder.path()));
  EXPECT_NE(html.find("begin at the end of the first stage"), std::string::npos);
  EXPECT_NE(html.find("Lines end where no rows were written"), std::string::npos);
  EXPECT_NE(html.find("<circle"), std::string::npos);  // the row behind the second gap stands alone
  EXPECT_EQ(html.find(">80<"), std::string::npos);     // an axis up to the first row, which is not shown
  EXPECT_EQ(html.find("Momentum"), std::string::npos);
  EXPECT_EQ(html.find("argest stable step"), std::string::npos);
  std::size_t lines = 0;
  for (std::size_t at = html.find("<path class=\"c0\""); at != std::string::npos;
       at = html.find("<path class=\"c0\"", at + 1))
    ++lines;
  EXPECT_EQ(lines, 2u);  // its line and the one of the legend
}

TEST(RunReport, FiguresOfOneColumnSayWhatItIs) {
  const ScratchFolder folder;
  writeText(folder / "series.csv", "time_s,particles,limit_s\n0,2,1e-4\n1,3,2e-4\n");
  const std::string html = readText(writeRunReport(folder.path()));
  for (const char* part : {">Particles<", ">number<", ">Largest stable step<", "largest stable step (s)"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
}

TEST(RunReport, HasTheFrequenciesOfModes) {
  const ScratchFolder folder;
  writeText(folder / "summary.json", summary);
  writeText(folder / "modes.csv", "stage,solid,mode,frequency_Hz\n1,0,1,16.47301\n1,0,2,32.85663\n");
  const std::string html = readText(writeRunReport(folder.path()));
  for (const char* part : {"Natural frequencies", "frequency (Hz)", ">16.473<", ">32.857<"})
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
