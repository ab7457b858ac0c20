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

TEST(Study, RefusesAFolderThatHoldsSomebodyElsesTable) {
  const ScratchFolder folder;
  io::test::writeText(folder / "five.csv", "mine");
  std::ostringstream log, error;
  EXPECT_THROW(runStudy(studyIn(folder.path(), 0), log, error), InputError);
  EXPECT_EQ(readText(folder / "five.csv"), "mine");
}

}  // namespace
}  // namespace dovetail::report
