#include <gtest/gtest.h>

#include <sstream>

#include "dovetail/core/profile.hpp"

namespace dovetail {
namespace {

std::string printed(const Profile& profile) {
  std::ostringstream text;
  text << profile;
  return text.str();
}

TEST(Profile, StagesThatNeverRanHaveNoRowAndAnEmptyOneNoTable) {
  Profile off(false), on(true);
  { Profile::Stage stage(off, "kick"); }
  EXPECT_EQ(printed(off), "");
  EXPECT_EQ(printed(on), "");
  { Profile::Stage stage(on, "kick"); }
  EXPECT_NE(printed(on).find("kick"), std::string::npos);
  EXPECT_EQ(printed(on).find("drift"), std::string::npos);
}

}  // namespace
}  // namespace dovetail
