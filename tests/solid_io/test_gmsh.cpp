#include <gtest/gtest.h>

#include "mesh_files.hpp"

namespace dovetail::solid_io {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string refusal(const std::string& text) {
  return messageOf([&] { gmshFromText(text, "test.msh"); });
}

TEST(Gmsh, AllFourVariantsGiveTheSameMesh) {
  const GmshTet tet;
  for (const bool version4 : {false, true})
    for (const bool binary : {false, true}) {
      const SolidFile file = gmshFromText(gmshTet(version4, binary), "test.msh");
      const std::string what = std::string(version4 ? "4.1" : "2.2") + (binary ? " binary" : "");
      EXPECT_EQ(file.mesh.X, tet.X) << what;
      EXPECT_EQ(file.nodeNumber, std::vector<std::int64_t>(tet.nodes.begin(), tet.nodes.end())) << what;
      EXPECT_EQ(file.elementNumber, std::vector<std::int64_t>{3}) << what;
      ASSERT_EQ(file.mesh.groups.size(), 1u) << what;
      EXPECT_EQ(file.mesh.groups[0].node, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 9, 8})) << what;
      EXPECT_EQ(fem::elementSet(file.mesh, "body"), std::vector<int>{0}) << what;
      EXPECT_EQ(fem::nodeSet(file.mesh, "the tip"), std::vector<int>{3}) << what;
      EXPECT_EQ(fem::nodeSet(file.mesh, "7"), (std::vector<int>{0, 1, 2, 4, 5, 6})) << what;
      const fem::Face face = fem::faceSet(file.mesh, "7").at(0);  // turned outwards
      EXPECT_EQ(face.node, (std::array<int, 9>{0, 2, 1, 6, 5, 4, -1, -1, -1})) << what;
      EXPECT_TRUE(file.notes.empty()) << what;
    }
}

TEST(Gmsh, WithoutGroupsTheEntitiesGiveTheSets) {
  for (const bool version4 : {false, true})
    for (const bool binary : {false, true}) {
      const fem::SolidMesh mesh = gmshFromText(gmshTet(version4, binary, false), "test.msh").mesh;
      EXPECT_EQ(fem::elementSet(mesh, "volume 3").size(), 1u);
      EXPECT_EQ(fem::faceSet(mesh, "surface 2").size(), 1u);
      EXPECT_EQ(fem::nodeSet(mesh, "point 4").size(), 1u);
      EXPECT_EQ(mesh.elementSets.size() + mesh.faceSets.size() + mesh.nodeSets.size(), 4u);
    }
}

TEST(Gmsh, UnusedNodesAndOtherSectionsArePassedOver) {
  std::string text =
      replaced(gmshTet(false, false), "$Nodes\n10\n", "$Periodic\nnonsense\n$EndPeriodic\n$Nodes\n11\n99 7 7 7\n");
  const SolidFile file = gmshFromText(text, "test.msh");
  EXPECT_EQ(file.mesh.X.size(), 10u);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_NE(file.notes[0].find("1 node that no volume element uses"), std::string::npos);
}

TEST(Gmsh, AFaceBetweenTwoVolumesBelongsToTheOneItPointsOutOf) {
  const std::string head =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n"
      "$EndNodes\n$Elements\n3\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 1 3 2 5\n";
  const auto faceOf = [&](const std::string& nodes) {
    const SolidFile file = gmshFromText(head + "3 2 2 5 1 " + nodes + "\n$EndElements\n", "test.msh");
    return fem::faceSet(file.mesh, "5").at(0).node;
  };
  EXPECT_EQ(faceOf("1 3 2"), (std::array<int, 9>{0, 2, 1, -1, -1, -1, -1, -1, -1}));
  EXPECT_EQ(faceOf("1 2 3"), (std::array<int, 9>{0, 1, 2, -1, -1, -1, -1, -1, -1}));
}

TEST(Gmsh, WithoutVolumesSurfacesAreElementsAndCurvesTheirFaces) {
  const std::string head =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"end\"\n2 2 \"body\"\n"
      "$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 2 1 0\n5 1 1 0\n6 0 1 0\n$EndNodes\n";
  const auto with = [&](const std::string& elements) { return head + "$Elements\n" + elements + "$EndElements\n"; };
  const SolidFile file = gmshFromText(with("3\n1 1 2 1 7 4 3\n2 3 2 2 8 1 2 5 6\n3 3 2 2 8 2 3 4 5\n"), "test.msh");
  EXPECT_EQ(file.mesh.groups.at(0).shape, fem::ElementShape::quad4);
  EXPECT_EQ(fem::elementSet(file.mesh, "body"), (std::vector<int>{0, 1}));
  EXPECT_EQ(fem::nodeSet(file.mesh, "end"), (std::vector<int>{2, 3}));
  // Turned outwards, whatever the line in the file.
  EXPECT_EQ(fem::faceSet(file.mesh, "end").at(0).node, (std::array<int, 9>{2, 3, -1, -1, -1, -1, -1, -1, -1}));
  EXPECT_EQ(file.mesh.thickness, 1.0);
  const SolidFile between = gmshFromText(with("3\n1 1 2 1 7 5 2\n2 3 2 2 8 1 2 5 6\n3 3 2 2 8 2 3 4 5\n"), "test.msh");
  EXPECT_EQ(fem::faceSet(between.mesh, "end").at(0).node[0], 4);  // runs around the second element
  const auto refusal = [&](const std::string& elements) {
    return messageOf([&] { gmshFromText(with(elements), "test.msh"); });
  };
  EXPECT_NE(refusal("2\n1 1 2 1 7 1 4\n2 3 2 2 8 1 2 5 6\n").find("line 1 is no side"), std::string::npos);
  EXPECT_NE(refusal("1\n1 2 2 2 8 1 2 5\n").find("element 1 is a triangle"), std::string::npos);
}

TEST(Gmsh, BrokenFilesAreRefusedWithTheirLine) {
  const std::string text = gmshTet(false, false);
  const std::pair<std::string, std::string> broken[] = {
      {"", "$Elements"},
      {"hello\n", "line 1"},
      {replaced(text, "2.2 0 8", "3.0 0 8"), "'3.0'"},
      {replaced(text, "2.2 0 8", "2.2 0 4"), "data size"},
      {replaced(text, "$Nodes\n10", "$Nodes\n1000000000"), "line 11"},
      {replaced(text, "$Nodes\n10", "$Nodes\n-1"), "announces -1"},
      {replaced(text, "$Nodes\n10", "$Nodes\nten"), "'ten' is not a whole number"},
      {replaced(text, "$Nodes\n10", "$Nodes\n9"), "where $EndNodes should be"},
      {replaced(text, "$Nodes\n10\n5 0", "$Nodes\n10\n5 nan"), "line 12"},
      {replaced(text, "$Nodes\n10\n5 0", "$Nodes\n10\n10 0"), "node 10 occurs twice"},
      {replaced(text, "\n1 15 2", "\n3 15 2"), ""},  // points have no numbers of their own
      {replaced(text, "2 9 2", "3 9 2"), "element 3 occurs twice"},
      {replaced(text, "3 11 2", "3 6 2"), "a prism"},
      {replaced(text, "3 11 2", "3 93 2"), "type 93"},
      {replaced(text, "1 3 5 10 15 20", "1 3 5 10 15 21"), "node 21 does not exist"},
      {replaced(text, "1 3 5 10 15 20", "1 3 5 15 10 20"), "inside out or too distorted: element 3 [test.msh, line"},
      {replaced(text, "1 3 5 10 15 20", "1 3 5 10 15 15"), "names node 15 twice"},
      {replaced(text, "7 2 5 10 15", "7 2 5 10 25"), "surface element 2 is no face"},
      {replaced(text, "\"body\"", "body"), "quotes"},
      {replaced(text, "3 11 2 ", "3 11 3 -9223372036854775808 "), "physical group"},
      {text + "$Nodes\n0\n$EndNodes\n", "second $Nodes"},
      {replaced(text, "$Nodes", "$Junk"), "$EndJunk"},
      {"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PartitionedEntities\n", "save it whole"},
      {"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n0\n$EndElements\n",
       "no volume elements"}};
  for (const auto& [file, wanted] : broken) {
    if (wanted.empty())
      EXPECT_EQ(refusal(file), "") << file;
    else
      EXPECT_NE(refusal(file).find(wanted), std::string::npos) << wanted << " not in: " << refusal(file);
  }
}

TEST(Gmsh, BinaryFilesNameTheByte) {
  std::string text = gmshTet(true, true);
  const std::size_t one = text.find("1 8\n") + 4;
  std::string swapped = text;
  std::swap(swapped[one], swapped[one + 3]);
  EXPECT_NE(refusal(swapped).find("byte order"), std::string::npos);
  EXPECT_NE(refusal(text.substr(0, text.size() - 60)).find("byte "), std::string::npos);
}

/// A file with a section moved behind all others.
std::string movedToEnd(std::string text, const std::string& section) {
  const std::string end = "$End" + section + "\n";
  const std::size_t from = text.find("$" + section), to = text.find(end) + end.size();
  const std::string moved = text.substr(from, to - from);
  return text.erase(from, to - from) + moved;
}

TEST(Gmsh, SectionsMayStandInAnyOrder) {
  for (const bool version4 : {false, true})
    for (const bool binary : {false, true})
      for (const char* const section : {"PhysicalNames", "Entities", "Nodes"}) {
        if (!version4 && section == std::string("Entities")) continue;
        const SolidFile file = gmshFromText(movedToEnd(gmshTet(version4, binary), section), "test.msh");
        EXPECT_EQ(fem::elementSet(file.mesh, "body"), std::vector<int>{0}) << section;
        EXPECT_EQ(fem::nodeSet(file.mesh, "the tip"), std::vector<int>{3}) << section;
        EXPECT_EQ(fem::faceSet(file.mesh, "7").size(), 1u) << section;
        EXPECT_EQ(file.mesh.elementSets.size() + file.mesh.faceSets.size(), 2u) << section;
      }
}

TEST(Gmsh, GroupsOfOneDimensionAndNameAreOneSetAndSayIt) {
  const std::string text = replaced(gmshTet(false, false), "2\n3 1 \"body\"", "3\n3 1 \"body\"\n3 2 \"body\"");
  EXPECT_TRUE(gmshFromText(text, "test.msh").notes.empty());  // nothing is in the other
  const SolidFile file = gmshFromText(
      replaced(text, "$Elements\n3\n", "$Elements\n4\n4 11 2 2 3 5 10 15 20 25 30 35 40 45 50\n"), "test.msh");
  EXPECT_EQ(fem::elementSet(file.mesh, "body"), std::vector<int>{0});
  ASSERT_EQ(file.notes.size(), 2u);  // and of the element that is there twice
  EXPECT_EQ(file.notes[0], "The groups 1, 2 of volumes have one name, \"body\", and are one set.");
}

TEST(Gmsh, ACtrlZAtTheEndIsTheEnd) {
  EXPECT_EQ(gmshFromText(gmshTet(false, false) + "\x1A", "test.msh").mesh.X.size(), 10u);
}

}  // namespace
}  // namespace dovetail::solid_io
