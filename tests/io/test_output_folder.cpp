#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/provenance.hpp"
#include "scratch_folder.hpp"

namespace dovetail::io {
namespace {

namespace fs = std::filesystem;
using test::messageOf;
using test::readText;
using test::ScratchFolder;
using test::writeText;

std::string marked(const std::string& text) { return provenanceLines(withMark({}), "# ") + text; }

/// One line that ends with a remedy after the place.
void expectOneClearLine(const std::string& message, const std::string& place) {
  EXPECT_NE(message.find("[" + place), std::string::npos) << message;
  EXPECT_NE(message.find("]: "), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(OutputFolder, IsMadeWithItsParentsAndLeftEmpty) {
  const ScratchFolder scratch;
  EXPECT_EQ(prepareOutputFolder(scratch / "a/b"), scratch / "a/b");
  EXPECT_EQ(scratch.content(), (std::set<std::string>{"a", "a/b"}));
}

TEST(OutputFolder, OnTrialGoesUnlessItIsKeptOrUsed) {
  const ScratchFolder scratch;
  const auto tryOut = [&](const fs::path& folder, auto&& use) {
    FolderOnTrial trial(folder);
    prepareOutputFolder(folder);
    const FolderLock lock(folder, trial);
    use(trial);
  };
  fs::create_directory(scratch / "mine");
  const auto nothing = [](FolderOnTrial&) {};
  for (const char* const name : {"a/b/c", "a/b/c/", "mine/d", "mine"}) tryOut(scratch / name, nothing);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"mine"});
  tryOut(scratch / "kept", [](FolderOnTrial& trial) { trial.keep(); });
  tryOut(scratch / "used/in", [&](FolderOnTrial&) { writeText(scratch / "used/log", "mine"); });
  EXPECT_EQ(scratch.content(), (std::set<std::string>{"mine", "kept", "used", "used/log"}));
  {  // of two that begin at once, the one that does not hold the folder
    const FolderOnTrial other(scratch / "shared");
    prepareOutputFolder(scratch / "shared");
  }
  EXPECT_TRUE(scratch.content().contains("shared"));
}

TEST(OutputFolder, KeepsWhatIsThere) {
  const ScratchFolder scratch;
  writeText(scratch / "notes.txt", "mine");
  prepareOutputFolder(scratch.path(), {"energies.csv"});
  EXPECT_EQ(scratch.content(), std::set<std::string>{"notes.txt"});
  EXPECT_EQ(readText(scratch / "notes.txt"), "mine");
}

TEST(OutputFolder, RefusesAFileAndAPathBelowOne) {
  const ScratchFolder scratch;
  writeText(scratch / "file", "mine");
  for (const fs::path& path : {scratch / "file", scratch / "file/out"})
    expectOneClearLine(messageOf<InputError>([&] { prepareOutputFolder(path); }), path.string());
  EXPECT_EQ(readText(scratch / "file"), "mine");
  EXPECT_EQ(scratch.content(), std::set<std::string>{"file"});
  EXPECT_THROW(prepareOutputFolder(""), InputError);
}

TEST(OutputFolder, RefusesPlacesWhereNothingCanBeWritten) {
  if (!fs::exists("/proc/self")) GTEST_SKIP() << "there is no /proc here";
  expectOneClearLine(messageOf<InputError>([] { prepareOutputFolder("/proc"); }), "/proc");  // a folder, but no files
  expectOneClearLine(messageOf<InputError>([] { prepareOutputFolder("/proc/out"); }), "/proc/out");
}

TEST(OutputFolder, RefusesAFolderWithoutPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "permissions do not stop root";
  const ScratchFolder scratch;
  fs::permissions(scratch.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(prepareOutputFolder(scratch.path()), InputError);
  fs::permissions(scratch.path(), fs::perms::owner_all);
}

TEST(OutputFolder, RefusesAFullDisk) {
  const ScratchFolder scratch;
  const test::FullDisk full(0);
  EXPECT_THROW(prepareOutputFolder(scratch.path()), InputError);
  EXPECT_TRUE(scratch.content().empty());
}

TEST(OutputFolder, RefusesNamesTakenByOthersBeforeTheRun) {
  const ScratchFolder scratch;
  writeText(scratch / "energies.csv", "mine");
  writeText(scratch / "summary.json", marked("{}"));
  EXPECT_NO_THROW(prepareOutputFolder(scratch.path(), {"summary.json", "new.csv"}));
  const std::string message = messageOf<InputError>([&] {
    prepareOutputFolder(scratch.path(), {"summary.json", "energies.csv"});
  });
  expectOneClearLine(message, (scratch / "energies.csv").string());
  EXPECT_EQ(readText(scratch / "energies.csv"), "mine");
}

TEST(OutputFolder, LosesWhatKilledRunsLeftAndNothingElse) {
  const ScratchFolder scratch;
  const std::string left = "series.csv.part-123-4";
  writeText(scratch / left, marked("half a ro"));
  const std::set<std::string> others{"mine.part-1-2", "series.csv.part-1", "series.csv.part-1-x",
                                     "a.part--1",     "b.part-1-2.csv",    "series.csv.part"};
  for (const std::string& name : others) writeText(scratch / name, name == "mine.part-1-2" ? "mine" : marked(""));
  fs::create_symlink(left, scratch / "link.part-5-6");
  prepareOutputFolder(scratch.path());
  auto after = others;
  after.insert("link.part-5-6");
  EXPECT_EQ(scratch.content(), after);
}

TEST(OutputFolder, LosesPartsInItsFoldersAndEmptyOnesOfDeadPrograms) {
  const ScratchFolder scratch, elsewhere;
  const std::string alive = "series.csv.part-" + std::to_string(::getpid()) + "-7", dead = "frame.vtu.part-999999998-7";
  const std::string film = "film.part-999999998-7";
  writeText(scratch / film, "");
  fs::create_directory(scratch / "mine");
  writeText(scratch / "mine" / dead, "");
  for (const char* const folder : {"grains", "solid"}) {
    writeText(scratch / (std::string(folder) + ".pvd"), "<?xml version=\"1.0\"?>\n<!-- dovetail 1 -->");
    fs::create_directory(scratch / folder);
    writeText(scratch.path() / folder / "frame.vtu.part-12-3", marked("half a fra"));
    for (const std::string& name : {alive, dead}) writeText(scratch.path() / folder / name, "");
  }
  writeText(elsewhere / "a.part-1-2", marked(""));
  fs::create_symlink(elsewhere.path(), scratch / "link");
  prepareOutputFolder(scratch.path());
  for (const char* const folder : {"grains", "solid"}) {
    EXPECT_FALSE(fs::exists(scratch.path() / folder / "frame.vtu.part-12-3"));
    EXPECT_FALSE(fs::exists(scratch.path() / folder / dead));
    EXPECT_TRUE(fs::exists(scratch.path() / folder / alive)) << "its program may be about to write it";
  }
  EXPECT_TRUE(fs::exists(elsewhere / "a.part-1-2"));
  EXPECT_TRUE(fs::exists(scratch / film)) << "no name of ours";
  EXPECT_TRUE(fs::exists(scratch / "mine" / dead)) << "no folder of frames";
}

TEST(OutputFolder, KeepsAFileThatAnotherProgramIsWriting) {
  const ScratchFolder scratch;
  const fs::path path = scratch / "series.csv.part-123-4";
  writeText(path, marked("half a ro"));
  const int file = ::open(path.c_str(), O_WRONLY);
  ASSERT_EQ(::flock(file, LOCK_EX), 0);
  prepareOutputFolder(scratch.path());
  EXPECT_TRUE(fs::exists(path));
  ::close(file);
  prepareOutputFolder(scratch.path());
  EXPECT_FALSE(fs::exists(path));
}

TEST(OutputFolder, IsHeldByOneRunAtATime) {
  const ScratchFolder scratch;
  {
    const FolderLock lock(scratch.path());
    expectOneClearLine(messageOf<InputError>([&] { const FolderLock second(scratch.path()); }),
                       scratch.path().string());
  }
  EXPECT_NO_THROW(FolderLock(scratch.path()));
  EXPECT_TRUE(scratch.content().empty());
}

TEST(OwnFiles, AreRemovedAndOthersAreNot) {
  const ScratchFolder scratch;
  writeText(scratch / "old.csv", marked(""));
  writeText(scratch / "notes", "mine");
  removeOurs(scratch / "old.csv");
  removeOurs(scratch / "absent");
  EXPECT_THROW(removeOurs(scratch / "notes"), InputError);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"notes"});
}

TEST(OwnFiles, AreKnownByTheirMark) {
  const ScratchFolder scratch;
  const auto check = [&](const std::string& text) {
    writeText(scratch / "file", text);
    return isOurs(scratch / "file");
  };
  EXPECT_TRUE(check(marked("")));
  for (const char* const ours : {"// version: dovetail 0.1.0\n{}", "<!-- dovetail 0.1.0 -->\n<svg>",
                                 "<?xml version=\"1.0\"?>\n<!-- dovetail 1 -->",
                                 "{\n  \"provenance\": {\n    \"version\": \"dovetail 0.1.0\",\n    \"commit\": \"1a\"",
                                 "{\n \"version\": \"dovetail 0.1.0\",\n \"commit\": \"1a\"",
                                 "binary STL, dovetail 0.1.0", "** dovetail 0.1.0\n*NODE"})
    EXPECT_TRUE(check(ours)) << ours;
  for (const char* const others :
       {"dovetail joints, dovetail 2", "my notes on dovetail 0.1.0\n", "# run with dovetail 0.1.0\nt,x\n",
        "\n# version: dovetail 0.1.0\n", "// dovetail 0.1.0\n{\"title\": \"mine\"}",
        "{\"title\": \"x\", \"provenance\": {\"version\": \"dovetail 0.1.0\"}}", "{\"note\": \"dovetail 0.1.0\"}",
        "# version: dovetail x", "<!-- dovetail -->", "mine {\"version\": \"dovetail 0.1.0\"}",
        "{\"version\": \"dovetail 0.1.0\", \"mine\": 1}", "\x89HDF\r\n\x1a\n cites dovetail 0.1.0"})
    EXPECT_FALSE(check(others)) << others;
  EXPECT_FALSE(check("dovetail joints"));
  EXPECT_FALSE(check("dovetail "));
  EXPECT_FALSE(check(""));
  EXPECT_FALSE(check(std::string(70000, 'x') + marked("")));
  EXPECT_FALSE(isOurs(scratch / "absent"));
  EXPECT_FALSE(isOurs(scratch.path()));
}

TEST(WriteFile, WritesAndReplacesItsOwn) {
  const ScratchFolder scratch;
  std::string longer(100000, 'x');
  longer.push_back('\0');
  longer += "two";
  const std::string first = marked("one"), second = marked(longer);
  writeFileAtomically(scratch / "file", first);
  EXPECT_EQ(readText(scratch / "file"), first);
  writeFileAtomically(scratch / "file", second);
  EXPECT_EQ(readText(scratch / "file"), second);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"file"});
}

TEST(WriteFile, NeverOverwritesOthersAndLosesNoResult) {
  const ScratchFolder scratch;
  writeText(scratch / "file", "mine");
  const std::string message = messageOf<InputError>([&] { writeFileAtomically(scratch / "file", marked("result")); });
  expectOneClearLine(message, (scratch / "file").string());
  EXPECT_EQ(readText(scratch / "file"), "mine");
  std::set<std::string> content = scratch.content();
  ASSERT_EQ(content.size(), 2u);
  content.erase("file");
  EXPECT_EQ(readText(scratch / *content.begin()), marked("result"));
  EXPECT_NE(message.find(*content.begin()), std::string::npos) << message;
}

TEST(WriteFile, DoesNotReplaceAFileOfAnotherKind) {
  const ScratchFolder scratch;
  writeText(scratch / "series.csv", marked("t\n"));
  EXPECT_THROW(writeFileAtomically(scratch / "series.csv", "<!-- dovetail 0.1.0 -->\n<VTKFile>"), InputError);
  EXPECT_EQ(readText(scratch / "series.csv"), marked("t\n"));
  EXPECT_EQ(scratch.content(), std::set<std::string>{"series.csv"});
}

TEST(WriteFile, LeavesNothingBesideADevice) {
  const ScratchFolder scratch;
  ASSERT_EQ(::mkfifo((scratch / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(writeFileAtomically(scratch / "pipe", marked("t\n")), InputError);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"pipe"});
}

TEST(OutputFolder, FoldersOfARunAreNoLinks) {
  const ScratchFolder scratch, elsewhere;
  fs::create_directory_symlink(elsewhere.path(), scratch / "grains");
  EXPECT_THROW(prepareInnerFolder(scratch / "grains"), InputError);
  EXPECT_TRUE(elsewhere.content().empty());
}

TEST(WriteFile, DoesNotReplaceThroughALink) {
  const ScratchFolder scratch;
  writeText(scratch / "target", marked("old"));
  fs::create_symlink("target", scratch / "link");
  EXPECT_THROW(writeFileAtomically(scratch / "link", marked("new")), InputError);
  EXPECT_TRUE(fs::is_symlink(scratch / "link"));
  EXPECT_EQ(readText(scratch / "target"), marked("old"));
}

TEST(WriteFile, KeepsTheOldFileWhenTheDiskIsFull) {
  const ScratchFolder scratch;
  const std::string old = marked("old");
  writeFileAtomically(scratch / "file", old);
  {
    const test::FullDisk full(1000);
    EXPECT_THROW(writeFileAtomically(scratch / "file", marked(std::string(5000, 'x'))), Error);
  }
  EXPECT_EQ(readText(scratch / "file"), old);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"file"});
}

TEST(WriteFile, RefusesAFolderThatIsNotThere) {
  const ScratchFolder scratch;
  EXPECT_THROW(writeFileAtomically(scratch / "absent/file", "text"), InputError);
  EXPECT_TRUE(scratch.content().empty());
}

}  // namespace
}  // namespace dovetail::io
