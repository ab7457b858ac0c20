// What stands on a card and is not known, and what is ignored with a word.
#include <gtest/gtest.h>

#include "../io/scratch_folder.hpp"
#include "abaqus_deck.hpp"

namespace dovetail::solid_io {
namespace {

std::string refusalOfCards(const std::string& cards) {
  return messageOf([&] { abaqusFromText(columnMesh + cards, "deck.inp"); });
}

TEST(Cards, UnknownAndMalformedOnesAreRefusedWithTheirLine) {
  const std::pair<std::string, std::string> bad[] = {
      {"*NSET, NSET=a, GENRATE\n1, 4, 1\n",
       "*nset has the parameter 'genrate' [deck.inp, line 17]: use nset, generate"},
      {"*NSET, NSET=a GENERATE\n1, 4, 1\n",
       "parameter nset has the value 'a GENERATE' [deck.inp, line 17]: put commas"},
      {"*NSET, NSET=a ELSET=b\n1, 4, 1\n", "put commas"},
      {"*NSET NSET=a\n1, 4\n", "no comma after *nset"},
      {"*ELSET, ELSET=\"a, GENERATE\n1, 2\n", "quotes on both sides"},
      {"*NSET, NSET=a, NSET=b\n1, 4\n", "nset twice"},
      {"*NSET, NSET=a, GENERATE=YES\n1, 4\n", "generate has the value 'YES'"},
      {"*NSET, NSET=a, GENERATE\n1, 4, 1, 2\n", "GENERATE has 4 entries"},
      {"*NSET, NSET=a, INSTANCE=b\n1, 4\n", "no *instance 'b'"},
      {"*SURFACE, NAME=a, COMBINE=UNION\nb, c\n", "*surface has the parameter 'combine'"},
      {"*SURFACE, NAME=a, CROP\n1, S1\n", "'crop'"},
      {"*SURFACE, NAME=a\n1, S1, 2, S2\n", "a line of a surface has 4 entries [deck.inp, line 18]"},
      {"*SURFACE, NAME=a\n, S1\n", "names no set"},
      {"*ELEMENT, TYPE=C3D8, OFFSET=10\n", "*element has the parameter 'offset'"},
      {"*NODE, NSE=a\n20, 0, 0, 0\n", "*node has the parameter 'nse'"},
      {"*NSETS, NSET=a\n1, 4\n", "there is no card *nsets [deck.inp, line 17]: write *nset"},
      {"*ELMENT, TYPE=C3D8\n", "write *element"},
      {"*NDOE\n20, 0, 0, 0\n", "write *node"},
      {"*\n1, 4\n", "* has a line of data [deck.inp, line 18]"},
      {"*NSET, NSET=a,\nGENRATE\n1, 4\n", "no set 'GENRATE' yet [deck.inp, line 18]"},
      {"*ELEMENT, TYPE=C3D8\n3, 1,2,,4,5,6,7,8\n", "nothing between two commas [deck.inp, line 18]"},
      {"*PART, NAME=p\n", "nodes come before the *part"},
      {"*END PART\n1, 2\n", "*endpart has a line of data [deck.inp, line 18]"},
      {"*NSET, NSET=a, ELSET=b\n1, 2\n", "no element set 'b' yet"},
      {"*PARAMETER\nh = 2\n", "*parameter is not known"}};
  for (const auto& [cards, wanted] : bad)
    EXPECT_NE(refusalOfCards(cards).find(wanted), std::string::npos) << wanted << " not in: " << refusalOfCards(cards);
  for (const std::string line : {"NODE", "NODE, NSET=a", "1, 0., 0., 0.", ">*NODE"})
    EXPECT_NE(messageOf([&] {
                abaqusFromText("\n" + line + "\n" + columnMesh, "deck.inp");
              }).find("there is '" + line + "' before the first card [deck.inp, line 2]"),
              std::string::npos)
        << line;
}

TEST(Cards, HarmlessParametersArePassedOverWithAWord) {
  const SolidFile file = abaqusFromText(
      columnMesh +
          "*NSET, NSET=a, INTERNAL, UNSORTED\n4, 1\n*SURFACE, NAME=s, REGION TYPE=SLIDING, TRIM=YES, INTERNAL\n1, S1\n",
      "deck.inp");
  EXPECT_EQ(fem::nodeSet(file.mesh, "a"), (std::vector<int>{0, 3}));
  EXPECT_NE(notesOf(file).find("ignored: UNSORTED (sets are sorted), regiontype of *surface, trim of *surface."),
            std::string::npos)
      << notesOf(file);
}

TEST(Cards, HabitsOfManyDecksAreRead) {
  const SolidFile file = abaqusFromText(">**\n" + columnMesh +
                                            "*\n*NSET, NSET=a,\n 1, 2\n*NSET, NSET=b,\nGENERATE,\n3, 5\n*NSET, "
                                            "NSET=c, FREQUENCY=9\n6\n*NSET, NSET=d,\na, b\n",
                                        "deck.inp");
  EXPECT_EQ(fem::nodeSet(file.mesh, "a"), range(0, 1));
  EXPECT_EQ(fem::nodeSet(file.mesh, "b"), range(2, 4));
  EXPECT_EQ(fem::nodeSet(file.mesh, "c"), range(5, 5));
  EXPECT_EQ(fem::nodeSet(file.mesh, "d"), range(0, 4));
  EXPECT_NE(notesOf(file).find("text before the first card was ignored: '>**'."), std::string::npos);
  EXPECT_NE(notesOf(file).find("frequency of *nset"), std::string::npos);
}

TEST(Cards, WhatIsNoPartOfTheSolidIsTold) {
  const SolidFile file = abaqusFromText(columnMesh +
                                            "*ELEMENT, TYPE=T3D2, ELSET=REBAR\n11, 1, 9\n12, 2, 10\n*ELEMENT, TYPE=S4\n"
                                            "21, 9, 10, 11, 12\n*EQUATION\n2\n9,1,1.,10,1,-1.\n*TIE, NAME=t\na, b\n"
                                            "*NSET, NSET=none\n*SURFACE, NAME=bare\n*SOLID SECTION, ELSET=e\n0.1,\n",
                                        "deck.inp");
  const std::string notes = notesOf(file);
  for (const char* wanted : {"2 elements of type T3D2 are no part of the solid", "1 element of type S4 is no part",
                             "constraints and contacts of the file were ignored: *equation, *tie.",
                             "\"none\" has no members", "\"bare\" has no lines"})
    EXPECT_NE(notes.find(wanted), std::string::npos) << wanted << " not in: " << notes;
  EXPECT_EQ(notes.find("thickness"), std::string::npos) << notes;
}

TEST(Cards, TheThicknessOfPlaneStrainIsTold) {
  const SolidFile file = abaqusFromText(
      "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 1\n4, 0, 1\n*ELEMENT, TYPE=CPE4, ELSET=e\n1, 1,2,3,4\n*SOLID SECTION, ELSET=e, "
      "MATERIAL=m\n0.02,\n",
      "deck.inp");
  EXPECT_NE(notesOf(file).find("The thickness of *solid section was ignored: 0.02."), std::string::npos)
      << notesOf(file);
}

TEST(Cards, RangesMayRunBackwards) {
  const SolidFile file =
      abaqusFromText(columnMesh + "*NSET, NSET=a, GENERATE\n12, 9, -1\n*NSET, NSET=b, GENERATE\n12, 7, -2,\n", "d.inp");
  EXPECT_EQ(fem::nodeSet(file.mesh, "a"), range(8, 11));
  EXPECT_EQ(fem::nodeSet(file.mesh, "b"), (std::vector<int>{7, 9, 11}));
  EXPECT_NE(refusalOfCards("*NSET, NSET=a, GENERATE\n1, 4, -1\n").find("makes no sense"), std::string::npos);
}

TEST(Cards, MarksAndLineEndsOfOtherMachinesAreTaken) {
  const std::string mark = "\xEF\xBB\xBF";
  std::string carriage = columnMesh;
  std::replace(carriage.begin(), carriage.end(), '\n', '\r');
  for (const std::string& text : {mark + columnMesh, carriage, mark + carriage})
    EXPECT_EQ(abaqusFromText(text, "deck.inp").mesh.X.size(), 12u);
  EXPECT_NE(messageOf([] { abaqusFromText("\xFF\xFE*\0N\0", "deck.inp"); }).find("UTF-16"), std::string::npos);
  const std::string gmsh = gmshTet(true, false);
  EXPECT_EQ(gmshFromText(mark + gmsh, "a.msh").mesh.X.size(), 10u);
}

TEST(Cards, TheContentOfAFileSaysWhatItIs) {
  const io::test::ScratchFolder folder;
  io::test::writeText(folder / "deck.msh", "** made by a mesher\n" + columnMesh);
  EXPECT_EQ(readSolid(folder / "deck.msh").mesh.X.size(), 12u);
  io::test::writeText(folder / "tet.inp", "\xEF\xBB\xBF" + gmshTet(false, false));
  EXPECT_EQ(readSolid(folder / "tet.inp").mesh.X.size(), 10u);
  io::test::writeText(folder / "fluent.msh", "(0 \"GAMBIT\")\n");
  EXPECT_NE(messageOf([&] { readSolid(folder / "fluent.msh"); }).find("$Nodes should begin"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::solid_io
