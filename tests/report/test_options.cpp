#include <gtest/gtest.h>

#include <sstream>

#include "program/options.hpp"

namespace dovetail::program {
namespace {

enum class Shape { round, square };

struct Settings {
  double width = 1.0;
  int count = 2;
  Shape shape = Shape::round;
  std::optional<double> until;
  bool quiet = false;
  std::vector<std::string> over;
  std::string file, corner;
};

Options tableOf(Settings& s) {
  Options o("test", "");
  o.number("--width W", s.width, between(0.0, 2.0), "").in("m");
  o.integer("--count N", s.count, 1, 9, "of what is counted, told in so many words that one line cannot hold them all");
  o.choice("--shape", s.shape, "round|square", "");
  o.number("--until T", s.until, positive(), "", "end").in("s");
  o.group("Not in files", false);
  o.flag("--quiet", s.quiet, "");
  o.text("FILE", s.file, "");
  o.texts("--over KEY", s.over, "of what");
  o.text("--corner X Y Z", s.corner, "");
  return o;
}

bool parse(
    Settings& s, std::vector<std::string> words, const std::function<void()>& between = [] {}) {
  std::vector<char*> argv{const_cast<char*>("test")};
  for (std::string& word : words) argv.push_back(word.data());
  return tableOf(s).parse(static_cast<int>(argv.size()), argv.data(), between);
}

std::string refusal(std::vector<std::string> words) {
  Settings s;
  try {
    parse(s, std::move(words));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Options, AreReadAndToldByOneTable) {
  Settings s;
  EXPECT_TRUE(parse(s, {"a.json", "--width", "1.5", "--shape=square", "--over", "a=1", "--over", "b=2", "--quiet"}));
  EXPECT_EQ(s.file, "a.json");
  EXPECT_EQ(s.over, (std::vector<std::string>{"a=1", "b=2"}));
  EXPECT_TRUE(s.quiet);
  EXPECT_EQ(tableOf(s).described(),
            (io::KeyValues{{"width_m", "1.5"}, {"count", "2"}, {"shape", "square"}, {"until_s", "end"}}));
}

TEST(Options, WhatIsWrittenWinsOverWhatIsSetBetween) {
  Settings s;
  parse(s, {"--width", "1.5"}, [&] { s.width = 0.5, s.count = 7; });
  EXPECT_EQ(s.width, 1.5);
  EXPECT_EQ(s.count, 7);
}

TEST(Options, ValuesOfSeveralWordsAreTakenTogether) {
  Settings s;
  parse(s, {"--corner", "-1", "2", "0.5", "a"});
  EXPECT_EQ(s.corner, "-1 2 0.5");
  EXPECT_EQ(s.file, "a");
}

TEST(Options, HelpHasEveryRowWithItsDefaultInLinesOf100) {
  Settings s;
  testing::internal::CaptureStdout();
  EXPECT_FALSE(parse(s, {"a", "--help"}));
  const std::string help = testing::internal::GetCapturedStdout();
  for (const char* part : {"usage: test [FILE] [options]\n", "\n  --width W ", "(default 1)", "--shape round|square ",
                           "(default round)", "\n\nNot in files:\n", "of what; may be given several times"})
    EXPECT_NE(help.find(part), std::string::npos) << part << " in\n" << help;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
}

TEST(Options, RefuseWhatCannotBeNamingTheOption) {
  EXPECT_EQ(refusal({"--width", "3"}), "the value 3 is not possible [--width]: give a number from 0 to 2");
  EXPECT_EQ(refusal({"--width", "nan"}), "the value nan is not possible [--width]: give a number from 0 to 2");
  EXPECT_EQ(refusal({"--width", "two"}), "'two' is no number [--width]: give a number");
  EXPECT_EQ(refusal({"--count", "1.5"}), "'1.5' is no whole number [--count]: give a whole number");
  EXPECT_EQ(refusal({"--shape", "0"}), "there is no '0' [--shape]: take one of round|square");
  EXPECT_EQ(refusal({"--width", ""}), "the value is empty [--width]: give one, or leave the option out");
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--widht", "1"},
                                                {"--width"},
                                                {"--width", "1", "--width", "2"},
                                                {"a", "b"},
                                                {"--quiet=1"}})
    EXPECT_NE(refusal(words).find("test --help"), std::string::npos) << refusal(words);
  EXPECT_EQ(refusal({"--widht", "1"}), "there is no option --widht [command line]: write --width, or see test --help");
  EXPECT_EQ(refusal({"--shape", "squrae"}), "there is no 'squrae' [--shape]: write square, or another of round|square");
}

}  // namespace
}  // namespace dovetail::program
