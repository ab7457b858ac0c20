// Sets of one name that come from different things of a file stay apart.
#include <gtest/gtest.h>

#include "abaqus_deck.hpp"

namespace dovetail::solid_io {
namespace {

TEST(NameSpaces, SetsOfTheAssemblyComeBeforeThoseOfThePart) {
  const SolidFile file = column(
      "*Nset, nset=Set-1, generate\n1, 12, 1\n*Elset, elset=Set-1, generate\n1, 2, 1\n*Surface, name=Surf-1\n1, S1\n",
      "*Nset, nset=Set-1, instance=Part-1-1\n1, 2, 3, 4\n*Elset, elset=SET-1, instance=Part-1-1\n2,\n"
      "*Surface, name=Surf-1\nset-1, S2\n");
  const fem::SolidMesh& mesh = file.mesh;
  EXPECT_EQ(fem::nodeSet(mesh, "Set-1"), range(0, 3));
  EXPECT_EQ(fem::nodeSet(mesh, "Part-1-1.Set-1"), range(0, 11));
  EXPECT_EQ(fem::elementSet(mesh, "SET-1"), std::vector<int>{1});
  EXPECT_EQ(fem::elementSet(mesh, "Part-1-1.Set-1"), range(0, 1));
  EXPECT_EQ(fem::nodeSet(mesh, "Surf-1"), range(8, 11));
  EXPECT_EQ(fem::faceSet(mesh, "Surf-1").size(), 1u);
  EXPECT_EQ(fem::nodeSet(mesh, "Part-1-1.Surf-1"), range(0, 3));
  EXPECT_EQ(fem::faceSet(mesh, "Part-1-1.Surf-1").size(), 1u);
  EXPECT_NE(notesOf(file).find("The assembly and the part have a node set \"Set-1\" each: the name is the assembly's, "
                               "the part's is \"Part-1-1.Set-1\"."),
            std::string::npos)
      << notesOf(file);
}

TEST(NameSpaces, SetsOfThePartAloneKeepTheirNames) {
  const SolidFile file = column("*Nset, nset=Base\n1, 2, 3, 4\n", "*Nset, nset=Top, instance=Part-1-1\n9, 10\n");
  EXPECT_EQ(fem::nodeSet(file.mesh, "Base"), range(0, 3));
  EXPECT_EQ(fem::nodeSet(file.mesh, "Top"), range(8, 9));
  EXPECT_EQ(file.mesh.nodeSets.size(), 2u);
  EXPECT_TRUE(file.notes.empty()) << notesOf(file);
}

TEST(NameSpaces, SetsOfTheAssemblyAreMadeOfThoseOfThePartByTheNameOfTheInstance) {
  const SolidFile file = column("*Nset, nset=Set-1, generate\n1, 8, 1\n*Elset, elset=Set-1\n1,\n",
                                "*Nset, nset=Fixed\nPart-1-1.1, part-1-1.2\n*Nset, nset=Set-1\nPart-1-1.Set-1, "
                                "PART-1-1.12\n*Surface, name=Top\nPart-1-1.2, S2\n*Surface, name=Foot\nPart-1-1.Set-1, "
                                "S1\n*Nset, nset=Whole, instance=Part-1-1\nSet-1\n");
  EXPECT_EQ(fem::nodeSet(file.mesh, "Fixed"), range(0, 1));
  EXPECT_EQ(fem::nodeSet(file.mesh, "Set-1"), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 11}));
  EXPECT_EQ(fem::nodeSet(file.mesh, "Whole"), range(0, 7));
  EXPECT_EQ(fem::nodeSet(file.mesh, "Top"), range(8, 11));
  EXPECT_EQ(fem::nodeSet(file.mesh, "Foot"), range(0, 3));
  EXPECT_NE(messageOf([] {
              column("", "*Nset, nset=a, instance=Part-1-2\n1,\n");
            }).find("no *instance 'Part-1-2' [deck.inp, line 24]: name 'Part-1-1'"),
            std::string::npos);
  EXPECT_NE(messageOf([] { column("", "*Nset, nset=a\nPart-1-2.1\n"); }).find("no set 'Part-1-2.1' yet"),
            std::string::npos);
}

TEST(NameSpaces, NumbersOfTheAssemblyAreItsOwn) {
  for (const std::string number : {"1", "101"}) {
    const SolidFile file = column("", "*Node\n" + number + ", 0.5, 0.5, 3.\n*Nset, nset=RP-1\n" + number +
                                          ",\n*Nset, nset=Fixed, instance=Part-1-1\n1, 2, 3, 4\n");
    EXPECT_EQ(fem::nodeSet(file.mesh, "Fixed"), range(0, 3));
    EXPECT_FALSE(file.mesh.nodeSets.contains("RP-1"));
    EXPECT_EQ(file.mesh.X.size(), 12u);
    EXPECT_NE(notesOf(file).find("\"RP-1\" is left out"), std::string::npos);
  }
  EXPECT_NE(messageOf([] { column("", "*Node\n1, 0., 0., 3.\n1, 0., 0., 4.\n"); }).find("node 1 occurs twice"),
            std::string::npos);
  // An element of the assembly on its own nodes, all of them with numbers of the part's.
  const SolidFile two = column("",
                               "*Node\n1, 5., 0., 0.\n2, 6., 0., 0.\n3, 5., 1., 0.\n4, 5., 0., 1.\n*Element, "
                               "type=C3D4, elset=Tet\n1, 1, 2, 3, 4\n");
  EXPECT_EQ(two.mesh.X.size(), 16u);
  EXPECT_EQ(two.nodeNumber[12], 1);
  EXPECT_EQ(two.elementNumber, (std::vector<std::int64_t>{1, 2, 1}));
  EXPECT_EQ(fem::elementSet(two.mesh, "Tet"), std::vector<int>{2});
}

TEST(NameSpaces, MeshesInTheInstanceAndInstancesMovedByNothingAreRead) {
  const std::string inInstance = "*Part, name=P\n*End Part\n*Assembly, name=A\n*Instance, name=P-1, part=P\n" +
                                 columnMesh +
                                 "*Nset, nset=Set-1, generate\n1, 12, 1\n*End Instance\n*Nset, nset=Set-1, "
                                 "instance=P-1\n1, 2\n*End Assembly\n";
  const SolidFile file = abaqusFromText(inInstance, "deck.inp");
  EXPECT_EQ(fem::nodeSet(file.mesh, "Set-1"), range(0, 1));
  EXPECT_EQ(fem::nodeSet(file.mesh, "P-1.Set-1"), range(0, 11));
  EXPECT_EQ(column("", "", "0., 0., 0.\n").mesh.X.size(), 12u);
  EXPECT_EQ(column("", "", "0., -0.,\n1., 0., 0., 1., 1., 0., 0.\n").mesh.X.size(), 12u);
  const auto moved = [](const std::string& lines) { return messageOf([&] { column("", "", lines); }); };
  EXPECT_NE(moved("0., 0., 1e-9\n").find("the instance is moved [deck.inp, line 23]"), std::string::npos);
  EXPECT_NE(moved("0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n").find("the instance is moved [deck.inp, line 24]"),
            std::string::npos);
}

TEST(NameSpaces, NodeSetsElementSetsAndSurfacesOfOneNameStayApart) {
  const SolidFile file =
      abaqusFromText(columnMesh +
                         "*Element, type=S4, elset=all\n3, 9, 10, 11, 12\n*Element, type=T3D2, elset=all\n4, 1, 5\n"
                         "*Nset, nset=all\n1, 2\n*Surface, name=all\n1, S1\n*Surface, name=dots, type=node\n3,\n"
                         "*Nset, nset=dots\n4,\n",
                     "deck.inp");
  const fem::SolidMesh& mesh = file.mesh;
  EXPECT_EQ(fem::nodeSet(mesh, "all"), range(0, 1));
  EXPECT_EQ(fem::nodeSet(mesh, "all (surface)"), range(0, 3));
  EXPECT_EQ(fem::nodeSet(mesh, "all (elements)"), (std::vector<int>{0, 4, 8, 9, 10, 11}));
  ASSERT_EQ(fem::faceSet(mesh, "all").size(), 1u);
  EXPECT_EQ(fem::faceSet(mesh, "all")[0].node[0] % 4, fem::faceSet(mesh, "all")[0].node[0]);
  EXPECT_EQ(fem::faceSet(mesh, "all (elements)").size(), 1u);
  EXPECT_EQ(fem::nodeSet(mesh, "dots"), std::vector<int>{3});
  EXPECT_EQ(fem::nodeSet(mesh, "dots (surface)"), std::vector<int>{2});
  EXPECT_NE(notesOf(file).find("There are different node sets \"all\"; that of the surface is \"all (surface)\"."),
            std::string::npos)
      << notesOf(file);
}

TEST(NameSpaces, AFaceThatIsNamedTwiceIsOne) {
  const SolidFile file =
      abaqusFromText(columnMesh + "*Elset, elset=upper\n2\n*Surface, name=top\nupper, S2\n2, S2\n", "deck.inp");
  EXPECT_EQ(fem::faceSet(file.mesh, "top").size(), 1u);
}

TEST(NameSpaces, ANodeSetTakesTheNodesOfAnElementSet) {
  const SolidFile file =
      column("*Elset, elset=Set-1\n1,\n",
             "*Elset, elset=Set-1, instance=Part-1-1, generate\n2, 2, 1\n*Nset, nset=a, elset=Set-1\n"
             "*Nset, nset=b, elset=Part-1-1.Set-1\n*Nset, nset=c\na, Part-1-1.1\n");
  EXPECT_EQ(fem::nodeSet(file.mesh, "a"), range(4, 11));
  EXPECT_EQ(fem::nodeSet(file.mesh, "b"), range(0, 7));
  EXPECT_EQ(fem::nodeSet(file.mesh, "c"), (std::vector<int>{0, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_NE(messageOf([] { column("", "*Nset, nset=a, elset=none\n"); }).find("no element set 'none' yet"),
            std::string::npos);
}

/// A unit cube in MSH 2.2: the groups "fixed" of its lower face, of one edge of the upper and of a corner.
std::string gmshCube() {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n0 1 \"fixed\"\n1 2 \"fixed\"\n2 3 \"fixed\"\n3 4 "
         "\"fixed\"\n$EndPhysicalNames\n$Nodes\n8\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 "
         "1 "
         "1\n$EndNodes\n$Elements\n4\n1 15 2 1 1 7\n2 1 2 2 1 5 6\n3 3 2 3 1 1 4 3 2\n4 5 2 4 1 1 2 3 4 5 6 7 "
         "8\n$EndElements\n";
}

TEST(NameSpaces, GroupsOfGmshWithOneNameInSeveralDimensionsStayApart) {
  const SolidFile file = gmshFromText(gmshCube(), "cube.msh");
  EXPECT_EQ(fem::nodeSet(file.mesh, "fixed"), range(0, 3));
  EXPECT_EQ(fem::nodeSet(file.mesh, "fixed (curves)"), range(4, 5));
  EXPECT_EQ(fem::nodeSet(file.mesh, "fixed (points)"), std::vector<int>{6});
  EXPECT_EQ(fem::faceSet(file.mesh, "fixed").size(), 1u);
  EXPECT_EQ(fem::elementSet(file.mesh, "fixed"), std::vector<int>{0});
  EXPECT_NE(notesOf(file).find("that of the curves is \"fixed (curves)\""), std::string::npos) << notesOf(file);
}

TEST(NameSpaces, AGroupWithoutANameIsNotTheOneThatIsCalledByItsNumber) {
  std::string text = gmshCube();
  text.replace(text.find("2 3 \"fixed\""), 11, "2 3 \"5\"");
  text.replace(text.find("$Elements\n4\n"), 12, "$Elements\n5\n5 3 2 5 2 5 6 7 8\n");
  const SolidFile file = gmshFromText(text, "cube.msh");
  EXPECT_EQ(fem::nodeSet(file.mesh, "5"), range(0, 3));
  EXPECT_EQ(fem::nodeSet(file.mesh, "5 (surfaces without a name)"), range(4, 7));
  EXPECT_EQ(fem::faceSet(file.mesh, "5").size(), 1u);
}

TEST(NameSpaces, ASetOfTheFileWithTheNameOfAShapeIsKept) {
  const SolidFile file = abaqusFromText(
      columnMesh +
          "*Node\n21, 3., 0., 0.\n22, 4., 0., 0.\n23, 3., 1., 0.\n24, 3., 0., 1.\n*Element, type=C3D4\n3, 21, "
          "22, 23, 24\n*Elset, elset=hex8\n2\n",
      "deck.inp");
  EXPECT_EQ(fem::elementSet(file.mesh, "hex8"), std::vector<int>{1});
  EXPECT_EQ(fem::elementSet(file.mesh, "tet4"), std::vector<int>{2});
}

}  // namespace
}  // namespace dovetail::solid_io
