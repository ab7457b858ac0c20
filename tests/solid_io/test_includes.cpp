// Decks in several files.
#include <gtest/gtest.h>

#include "../io/scratch_folder.hpp"
#include "abaqus_deck.hpp"

namespace dovetail::solid_io {
namespace {

using io::test::writeText;

class Includes : public testing::Test {
protected:
  std::string refusal(const std::string& deck) {
    writeText(folder_ / "deck.inp", deck);
    return messageOf([&] { readAbaqus(folder_ / "deck.inp"); });
  }
  SolidFile read(const std::string& deck) {
    writeText(folder_ / "deck.inp", deck);
    return readAbaqus(folder_ / "deck.inp");
  }
  io::test::ScratchFolder folder_;
};

TEST_F(Includes, CardsAndDataComeFromOtherFiles) {
  const std::size_t split = columnMesh.find("*Element");
  const std::string nodes = columnMesh.substr(6, split - 6), elements = columnMesh.substr(split);
  std::filesystem::create_directories(folder_ / "sub");
  writeText(folder_ / "sub" / "nodes.txt", "\xEF\xBB\xBF" + nodes.substr(0, nodes.size() - 1));  // no line end
  writeText(folder_ / "sub" / "elements.inp", elements + "*include, input=sets.inp\n");
  writeText(folder_ / "sub" / "sets.inp", "*Nset, nset=Top\n9, 10, 11, 12\n");
  const SolidFile file = read(
      "*Heading\n*Node, nset=All, input=sub/nodes.txt\n*Nset, nset=Low\n1, 2\n*INCLUDE,\n"
      "INPUT = \"sub\\elements.inp\"\n*Nset, nset=Mid\n5, 6\n");
  EXPECT_EQ(file.mesh.X.size(), 12u);
  EXPECT_EQ(file.mesh.elementCount(), 2u);
  EXPECT_EQ(fem::nodeSet(file.mesh, "All").size(), 12u);
  EXPECT_EQ(fem::nodeSet(file.mesh, "Low"), range(0, 1));
  EXPECT_EQ(fem::nodeSet(file.mesh, "Mid"), range(4, 5));
  EXPECT_EQ(fem::nodeSet(file.mesh, "Top"), range(8, 11));
}

TEST_F(Includes, DataMayComeFromAnotherFile) {
  const std::size_t split = columnMesh.find("*Element");
  writeText(folder_ / "nodes.txt", columnMesh.substr(6, split - 6));
  const SolidFile file = read("*Node, nset=All\n*include, input=nodes.txt\n" + columnMesh.substr(split));
  EXPECT_EQ(fem::nodeSet(file.mesh, "All").size(), 12u);
}

TEST_F(Includes, TheFolderOfTheDeckComesFirst) {
  std::filesystem::create_directories(folder_ / "sub");
  writeText(folder_ / "sub" / "first.inp", "*include, input=sets.inp\n");
  writeText(folder_ / "sub" / "sets.inp", "*Nset, nset=a\n1\n");
  writeText(folder_ / "sets.inp", "*Nset, nset=a\n2\n");
  EXPECT_EQ(fem::nodeSet(read(columnMesh + "*include, input=sub/first.inp\n").mesh, "a"), range(1, 1));
}

TEST_F(Includes, ErrorsNameTheFileAndItsLine) {
  writeText(folder_ / "sets.inp", "** sets\n*Nset, nset=a\n99\n");
  const std::string deck = columnMesh + "*include, input=sets.inp\n";
  EXPECT_NE(refusal(deck).find("node 99 does not exist [" + (folder_ / "sets.inp").string() + ", line 3]"),
            std::string::npos)
      << refusal(deck);
  writeText(folder_ / "sets.inp", "*Nset, nset=a\n9\n");
  EXPECT_NE(refusal(deck + "*Nset, nset=b\nx\n").find((folder_ / "deck.inp").string() + ", line 19]"),
            std::string::npos)
      << refusal(deck + "*Nset, nset=b\nx\n");
}

TEST_F(Includes, CirclesAndDeepNestingAreRefused) {
  writeText(folder_ / "a.inp", "*include, input=b.inp\n");
  writeText(folder_ / "b.inp", "*include, input=./a.inp\n");
  const std::string circle = refusal("*include, input=a.inp\n");
  EXPECT_NE(circle.find("includes itself"), std::string::npos) << circle;
  EXPECT_NE(circle.find("b.inp, line 1"), std::string::npos) << circle;
  EXPECT_NE(refusal("*include, input=deck.inp\n").find("includes itself"), std::string::npos);
  const auto chain = [&](int files) {
    for (int k = 0; k < files; ++k)
      writeText(folder_ / ("n" + std::to_string(k) + ".inp"),
                k + 1 < files ? "*include, input=n" + std::to_string(k + 1) + ".inp\n" : columnMesh);
    return refusal("*include, input=n0.inp\n");
  };
  EXPECT_EQ(chain(16), "");
  EXPECT_NE(chain(17).find("more than 16 deep"), std::string::npos);
  // Each takes the next one twice: 2^16 files.
  for (int k = 0; k < 16; ++k) {
    const std::string card = k < 15 ? "*include, input=n" + std::to_string(k + 1) + ".inp\n" : "** end\n";
    writeText(folder_ / ("n" + std::to_string(k) + ".inp"), card + card);
  }
  EXPECT_NE(refusal("*include, input=n0.inp\n").find("more than 1000 files"), std::string::npos);
}

TEST_F(Includes, WhatIsNoFileIsRefused) {
  EXPECT_NE(refusal("*include, input=none.inp\n").find("no file 'none.inp' for *include"), std::string::npos);
  EXPECT_NE(refusal("*include\n").find("no parameter input"), std::string::npos);
  EXPECT_NE(refusal("*include, input=.\n").find("no file '.'"), std::string::npos);
  EXPECT_NE(refusal("*include, file=a.inp\n").find("parameter 'file'"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::solid_io
