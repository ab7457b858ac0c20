#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/io/provenance.hpp"
#include "scratch_folder.hpp"

namespace dovetail::io {
namespace {

using test::ScratchFolder;

TEST(Provenance, HoldsBuildMachineAndSettingsInOrder) {
  const KeyValues entries = provenance({{"z", "1"}, {"a", ""}, {"threads", "7"}});
  std::vector<std::string> keys;
  std::map<std::string, std::string> values;
  for (const auto& [key, value] : entries) {
    keys.push_back(key);
    values[key] = value;
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"version", "commit", "compiler", "flags", "build type", "processor",
                                            "threads", "setting.z", "setting.a", "setting.threads"}));
  for (const char* key : {"version", "commit", "compiler", "flags", "build type", "processor", "threads"})
    EXPECT_FALSE(values[key].empty()) << key;
  EXPECT_EQ(values["version"], "dovetail " + buildInfo().version);
  EXPECT_EQ(values["threads"], std::to_string(threads()));
  EXPECT_EQ(values["setting.z"], "1");
  EXPECT_EQ(values["setting.threads"], "7");
}

TEST(Provenance, NamesTheCompilerThatCompiledThis) {
#ifdef __clang__
  EXPECT_NE(buildInfo().compiler.find("Clang " + std::to_string(__clang_major__)), std::string::npos);
#else
  EXPECT_NE(buildInfo().compiler.find("GNU " + std::to_string(__GNUC__)), std::string::npos);
#endif
}

TEST(Provenance, CommitIsAHashOrUnknown) {
  std::string commit = buildInfo().commit;
  const std::string dirty = "-dirty";
  if (commit.size() > dirty.size() && commit.substr(commit.size() - dirty.size()) == dirty)
    commit.resize(commit.size() - dirty.size());
  if (commit == "unknown") return;
  EXPECT_EQ(commit.size(), 40u);
  EXPECT_EQ(commit.find_first_not_of("0123456789abcdef"), std::string::npos) << commit;
}

TEST(Provenance, RefusesSettingsWithoutOrWithRepeatedNames) {
  EXPECT_THROW(provenance({{"", "1"}}), InputError);
  EXPECT_THROW(provenance({{"dt", "1"}, {"dt", "1"}}), InputError);
}

TEST(Provenance, LinesStayOneLineEach) {
  EXPECT_EQ(provenanceLines({{"a", "1\n2"}, {"b", "c:\\d\r"}}, "# "), "# a: 1\\n2\n# b: c:\\\\d\\r\n");
}

TEST(Provenance, MarkIsAddedOnlyWhereItIsMissing) {
  EXPECT_EQ(withMark({{"a", "1"}}), (KeyValues{{"version", "dovetail " + buildInfo().version}, {"a", "1"}}));
  const KeyValues complete = provenance({{"a", "1"}});
  EXPECT_EQ(withMark(complete), complete);
}

/// Runs the script of the build on `root` and returns the commit it wrote.
std::string commitOf(const std::filesystem::path& root, const std::filesystem::path& archived,
                     const std::filesystem::path& output) {
  const std::string command = std::string(TEST_CMAKE) + " -DGIT=" + TEST_GIT + " -DROOT=" + root.string() +
                              " -DARCHIVED=" + archived.string() + " -DOUTPUT=" + output.string() + " -P " +
                              TEST_COMMIT_SCRIPT;
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::string text = test::readText(output);
  EXPECT_GE(text.size(), 3u);
  return text.size() < 3 ? text : text.substr(1, text.size() - 3);
}

TEST(CommitScript, TellsCloneChangedCloneForeignRepositoryAndTarball) {
  if (std::string(TEST_GIT).empty()) GTEST_SKIP() << "there is no git here";
  const ScratchFolder scratch;
  const auto root = scratch / "clone";
  const auto output = scratch / "commit.inc";
  std::filesystem::create_directories(root / "vendored");
  test::writeText(root / "file", "one\n");
  const std::string git =
      std::string(TEST_GIT) + " -C " + root.string() + " -c user.name=t -c user.email=t@example.org ";
  ASSERT_EQ(std::system((git + "init -q && " + git + "add file && " + git + "commit -q -m first && " + git +
                         "rev-parse HEAD > " + (scratch / "head").string())
                            .c_str()),
            0);
  std::string head = test::readText(scratch / "head");
  head.pop_back();
  EXPECT_EQ(commitOf(root, "", output), head);
  // Not our repository, only one around us.
  EXPECT_EQ(commitOf(root / "vendored", "", output), "unknown");
  // What git archive leaves in a tarball; before, the file holds a placeholder.
  test::writeText(scratch / "archived", "$Format:%H$\n");
  EXPECT_EQ(commitOf(root / "vendored", scratch / "archived", output), "unknown");
  test::writeText(scratch / "archived", head + "\n");
  EXPECT_EQ(commitOf(root / "vendored", scratch / "archived", output), head);
  test::writeText(root / "file", "two\n");
  EXPECT_EQ(commitOf(root, "", output), head + "-dirty");
}

TEST(CommitScript, LeavesAFileThatNeedsNoChange) {
  const ScratchFolder scratch;
  const auto output = scratch / "commit.inc";
  EXPECT_EQ(commitOf(scratch.path(), "", output), "unknown");
  const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  std::filesystem::last_write_time(output, old);
  const auto before = std::filesystem::last_write_time(output);
  EXPECT_EQ(commitOf(scratch.path(), "", output), "unknown");
  EXPECT_EQ(std::filesystem::last_write_time(output), before);
}

}  // namespace
}  // namespace dovetail::io
