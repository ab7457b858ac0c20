#include <gtest/gtest.h>

#include "../io/scratch_folder.hpp"
#include "dovetail/core/archive.hpp"
#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"

namespace dovetail {
namespace {

namespace fs = std::filesystem;
using io::test::messageOf;
using io::test::readText;
using io::test::ScratchFolder;
using io::test::writeText;

const std::string kind = "test of states 1";
const std::vector<char> older{'o', 'l', 'd'}, newer{'n', 'e', 'w', 'e', 'r'};

TEST(CheckedFile, ReplacesItsOwnOfAnyKind) {
  const ScratchFolder scratch;
  writeChecked(scratch / "state", "another kind", older);
  writeChecked(scratch / "state", kind, newer);
  EXPECT_EQ(readChecked(scratch / "state", kind), newer);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"state"});
}

TEST(CheckedFile, NeverReplacesWhatIsNotItsOwn) {
  const ScratchFolder scratch;
  writeText(scratch / "notes", "precious");
  writeText(scratch / "empty", "");
  fs::create_directory(scratch / "folder");
  writeChecked(scratch / "target", kind, older);
  fs::create_symlink("target", scratch / "link");
  const auto before = scratch.content();
  for (const fs::path& path : {scratch / "notes", scratch / "empty", scratch / "folder", scratch / "link",
                               fs::path("/dev/full"), scratch / "absent/state"}) {
    const std::string message = messageOf<InputError>([&] { writeChecked(path, kind, newer); });
    EXPECT_NE(message.find(path.string()), std::string::npos) << path << ": " << message;
  }
  EXPECT_EQ(scratch.content(), before);
  EXPECT_EQ(readText(scratch / "notes"), "precious");
  EXPECT_EQ(readChecked(scratch / "target", kind), older);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(CheckedFile, LeavesFilesOfTheNameItOnceUsedAlone) {
  const ScratchFolder scratch;
  writeText(scratch / "target", "precious");
  fs::create_symlink("target", scratch / "state.part");
  writeChecked(scratch / "state", kind, newer);
  EXPECT_EQ(readText(scratch / "target"), "precious");
  EXPECT_TRUE(fs::is_symlink(scratch / "state.part"));
}

TEST(CheckedFile, KeepsTheOldStateWhenTheDiskIsFull) {
  const ScratchFolder scratch;
  writeChecked(scratch / "state", kind, older);
  {
    const io::test::FullDisk full(20);
    EXPECT_THROW(writeChecked(scratch / "state", kind, newer), Error);
  }
  EXPECT_EQ(readChecked(scratch / "state", kind), older);
  EXPECT_EQ(scratch.content(), std::set<std::string>{"state"});
}

TEST(ByteReader, TruthsAreNoughtOrOne) {
  ByteWriter writer;
  writer(true, std::optional<double>{2.5}, false);
  bool first = false, last = true;
  std::optional<double> number;
  const auto read = [&](const std::vector<char>& bytes) {
    ByteReader reader(bytes);
    reader(first, number, last);
  };
  read(writer.bytes());
  EXPECT_TRUE(first && number == 2.5 && !last);
  for (const std::size_t place : {std::size_t{0}, std::size_t{1}, writer.bytes().size() - 1})
    for (const char wrong : {'\2', '%', '\377'}) {
      std::vector<char> damaged = writer.bytes();
      damaged[place] = wrong;
      EXPECT_THROW(read(damaged), InputError) << place;
    }
}

bool startsWithMine(const fs::path& path) { return headOf(path, 4) == "mine"; }

TEST(AtomicFile, AppendsToItsOwnAndTakesBackWhatDoesNotFit) {
  const ScratchFolder scratch;
  replaceFile(scratch / "file", {"mine", " one"}, startsWithMine);
  appendToFile(scratch / "file", " two", startsWithMine);
  EXPECT_EQ(readText(scratch / "file"), "mine one two");
  {
    const io::test::FullDisk full(20);
    EXPECT_THROW(appendToFile(scratch / "file", std::string(50, 'x'), startsWithMine), Error);
  }
  EXPECT_EQ(readText(scratch / "file"), "mine one two");
  writeText(scratch / "other", "theirs");
  EXPECT_THROW(appendToFile(scratch / "other", "x", startsWithMine), InputError);
  EXPECT_THROW(appendToFile(scratch / "absent", "x", startsWithMine), InputError);
  EXPECT_EQ(readText(scratch / "other"), "theirs");
  EXPECT_EQ(scratch.content(), (std::set<std::string>{"file", "other"}));
}

}  // namespace
}  // namespace dovetail
