#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "dovetail/report/front.hpp"
#include "dovetail/report/table.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::report {
namespace {

TEST(Text, FormatsAnyLengthAndQuotes) {
  EXPECT_EQ(format("%d of %.2f", 3, 0.5), "3 of 0.50");
  EXPECT_EQ(format("%s", std::string(1000, 'x').c_str()), std::string(1000, 'x'));
  EXPECT_EQ(quoted("say \"no\", twice"), "\"say \"\"no\"\", twice\"");
}

TEST(Tables, OneLinePerObjectBelowProvenanceAndNames) {
  Json first{{"label", "a \"b\""}, {"value", 0.1}, {"good", true}, {"none", nullptr}, {"count", 3}};
  first["step"] = {{"solid", 0.5}};
  first["settings"] = objectOf({{"scheme", "paper"}});
  Json second = first;
  second["value"] = numberOrNull(std::numeric_limits<double>::infinity());
  EXPECT_EQ(csvOf({first, second}, {{"version", "dovetail 1"}}),
            "# version: dovetail 1\n"
            "label,value,good,none,count,step_solid,scheme\n"
            "\"a \"\"b\"\"\",0.1,1,nan,3,0.5,\"paper\"\n"
            "\"a \"\"b\"\"\",nan,1,nan,3,0.5,\"paper\"\n");
}

TEST(Fronts, HoldWhatNothingBeatsInBoth) {
  struct Row {
    double seconds, error;
    bool ran = true;
  };
  const std::vector<Row> rows{{1, 3}, {2, 1}, {2, 2}, {3, 2}, {3, 1}, {0, 0, false}, {0, std::nan("")}};
  const auto front = onFront(
      rows, [](const Row& r) { return r.ran; }, [](const Row& r) { return r.seconds; },
      [](const Row& r) { return r.error; });
  EXPECT_EQ(front, (std::vector<bool>{true, true, true, false, true, false, false}));
}

}  // namespace
}  // namespace dovetail::report
