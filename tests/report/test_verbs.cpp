#include <gtest/gtest.h>

#include <cmath>

#include "bounce.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/report/table.hpp"

namespace dovetail::report {
namespace {

TEST(ReportVerb, WritesAPageOnARunWithItsNumbers) {
  const Bounce bounce;
  ASSERT_EQ(runProgram({"run", bounce.file, "--out", bounce.out}).code, 0);
  const Outcome outcome = runProgram({"report", bounce.out});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, bounce.out + "/report.html\n");
  const std::string html = readText(bounce.folder / "out/report.html");
  for (const char* part :
       {"<h1>A grain bounces</h1>", "particles: kinetic", "particles kinetic", "critical step", "<svg"})
    EXPECT_NE(html.find(part), std::string::npos) << part;
  EXPECT_EQ(runProgram({"report", bounce.folder.path().string()}).code, 2);
}

#if WITH_PICTURES
TEST(PictureVerb, DrawsNaturalModes) {
  const ScratchFolder folder;
  const std::string out = (folder / "out").string(), scene = std::string(SCENES) + "/frequencies.json";
  ASSERT_EQ(runProgram({"run", scene, "--set", "solids.0.cells=[4, 1, 1]", "--out", out}).code, 0);
  const std::filesystem::directory_iterator modes(folder / "out/modes_beam");
  EXPECT_EQ(std::distance(begin(modes), end(modes)), 6);
  const Outcome first = runProgram({"picture", out, "--mode", "1"});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("mode 1; solids: shape"), std::string::npos) << first.out;
  const std::string one = readText(folder / "out/picture.png");
  ASSERT_EQ(runProgram({"picture", out, "--mode", "3"}).code, 0);
  EXPECT_NE(readText(folder / "out/picture.png"), one);
  EXPECT_EQ(runProgram({"picture", out, "--mode", "1", "--film"}).code, 0);
  const Outcome seventh = runProgram({"picture", out, "--mode", "7"});
  EXPECT_EQ(seventh.code, 2);
  EXPECT_NE(seventh.err.find("from 1 to 6"), std::string::npos) << seventh.err;
  const Bounce bounce;
  ASSERT_EQ(runProgram({"run", bounce.file, "--set", "output.frames=0.1 ms", "--out", bounce.out}).code, 0);
  EXPECT_NE(runProgram({"picture", bounce.out, "--mode", "1"}).err.find("stage \"do\": \"modes\""), std::string::npos);
}

TEST(PictureVerb, DrawsFramesAndFilmsAndReplacesItsOwnFilesOnly) {
  const Bounce bounce;
  ASSERT_EQ(runProgram({"run", bounce.file, "--set", "output.frames=0.1 ms", "--out", bounce.out}).code, 0);
  for (int time = 0; time < 2; ++time) {
    const Outcome drawn = runProgram({"picture", bounce.out, "--size", "300", "200"});
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    const std::string png = readText(bounce.folder / "out/picture.png");
    EXPECT_EQ(png.substr(1, 3), "PNG");
    EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x01\x2c\0\0\0\xc8", 8));
  }
  ASSERT_EQ(runProgram({"picture", bounce.out, "--film"}).code, 0);
  const std::string film = readText(bounce.folder / "out/film.gif");
  EXPECT_EQ(film.substr(0, 6), "GIF89a");
  std::size_t images = 0;
  for (std::size_t at = film.find("\x21\xF9\x04"); at != std::string::npos; at = film.find("\x21\xF9\x04", at + 1))
    ++images;
  const std::filesystem::directory_iterator frames(bounce.folder / "out/grains");
  EXPECT_EQ(images, static_cast<std::size_t>(std::distance(begin(frames), end(frames))));
  ASSERT_EQ(runProgram({"report", bounce.out}).code, 0);
  for (const char* const name : {"out/picture.png", "out/film.gif", "out/report_picture.png"})
    EXPECT_TRUE(io::isOurs(bounce.folder / name)) << name;
  // A run that replaces this one takes its pictures away, but not those of others.
  writeText(bounce.folder / "out/picture.png", "mine");
  const Outcome taken = runProgram({"picture", bounce.out});
  EXPECT_EQ(taken.code, 2);
  EXPECT_NE(taken.err.find("not from an earlier run"), std::string::npos) << taken.err;
  ASSERT_EQ(runProgram({"run", bounce.file, "--out", bounce.out, "--replace"}).code, 0);
  for (const char* const name : {"out/film.gif", "out/report_picture.png", "out/report.html"})
    EXPECT_FALSE(std::filesystem::exists(bounce.folder / name)) << name;
  EXPECT_EQ(readText(bounce.folder / "out/picture.png"), "mine");
}

TEST(PictureVerb, RefusalsSayWhatToWrite) {
  const Bounce bounce;
  ASSERT_EQ(runProgram({"run", bounce.file, "--out", bounce.out}).code, 0);
  const auto refused = [&](std::vector<std::string> more, const std::string& words) {
    std::vector<std::string> all{"picture", bounce.out};
    all.insert(all.end(), more.begin(), more.end());
    const Outcome outcome = runProgram(all);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  };
  refused({}, "\"frames\": \"10 ms\"");
  ASSERT_EQ(runProgram({"run", bounce.file, "--set", "output.frames=0.1 ms", "--out", bounce.out, "--replace"}).code,
            0);
  refused({"--grains", "sped"}, "write \"speed\"");
  refused({"--frame", "60"}, "give a number from 0 to");
  refused({"--lines", "contacts"}, "add \"contacts\"");
  refused({"--out", "a.gif"}, "ends in .png");
  refused({"--film", "--frame", "2"}, "--frame");
  refused({"--cut", "w", "0.1"}, "x, y or z");
  refused({"--cut", "y", "here"}, "no number");
  refused({"--background", "greenish"}, "#e8eef4");
  refused({"--grain-range", "2", "1"}, "smaller number first");
  refused({"--size", "10", "10"}, "150 to 8000");
}
#endif

}  // namespace
}  // namespace dovetail::report
