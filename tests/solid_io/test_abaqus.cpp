#include <gtest/gtest.h>

#include "mesh_files.hpp"

namespace dovetail::solid_io {
namespace {

const std::string nodes =
    "*Heading\n two bricks\n** a comment\n*Node, nset=ALL\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n"
    "11, 0., 0., 1.\n12, 1., 0., 1.\n13, 1., 1., 1.\n14, 0., 1., 1.\n"
    "21, 0., 0., 2.\n22, 1.D0, 0., 2.0e0\n23, 1., 1., 2.\n24, 0., 1., 2.\n99, 5., 5., 5.\n";
const std::string elements =
    "*ELEMENT, TYPE = C3D8R, ELSET=Lower\n7, 1,2,3,4,\n11,12,13,14\n*element,elset=\"the upper\",type=c3d8i\n"
    "9, 11,12,13,14, 21,22,23,24\n";

std::string abaqusRefusal(const std::string& text) {
  return messageOf([&] { abaqusFromText(text, "test.inp"); });
}

TEST(Abaqus, NodesElementsAndSetsAreRead) {
  const SolidFile file =
      abaqusFromText(nodes + elements +
                         "*NSET, NSET=Bottom, GENERATE\n1, 4\n*nset, nset=some,\n GENERATE\n11,13,2\n"
                         "*NSET, NSET=more\nbottom, SOME, 99\n*ELSET, ELSET=both\nLOWER, 9\n"
                         "*Surface, name=Top\n\"the upper\", S2\n*SURFACE, NAME=sides, TYPE=ELEMENT\n"
                         "7, S3\n9, s6\n*SURFACE, TYPE=NODE, NAME=points\nbottom,\n21, 1.\n"
                         "*MATERIAL, NAME=steel\n*ELASTIC\n210e9, 0.3\n",
                     "test.inp");
  const fem::SolidMesh& mesh = file.mesh;
  EXPECT_EQ(mesh.X.size(), 12u);
  EXPECT_EQ(mesh.X[9], (Vec3{1.0, 0.0, 2.0}));
  EXPECT_EQ(file.elementNumber, (std::vector<std::int64_t>{7, 9}));
  EXPECT_EQ(fem::nodeSet(mesh, "Bottom"), (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(fem::nodeSet(mesh, "some"), (std::vector<int>{4, 6}));
  EXPECT_EQ(fem::nodeSet(mesh, "more"), (std::vector<int>{0, 1, 2, 3, 4, 6}));
  EXPECT_EQ(fem::nodeSet(mesh, "points"), (std::vector<int>{0, 1, 2, 3, 8}));
  EXPECT_EQ(fem::nodeSet(mesh, "ALL").size(), 12u);
  EXPECT_EQ(fem::elementSet(mesh, "Lower"), std::vector<int>{0});
  EXPECT_EQ(fem::elementSet(mesh, "the upper"), std::vector<int>{1});
  EXPECT_EQ(fem::elementSet(mesh, "both"), (std::vector<int>{0, 1}));
  EXPECT_EQ(sortedFaces(fem::faceSet(mesh, "Top"))[0], (std::vector<int>{8, 9, 10, 11, -1, -1, -1, -1, -1}));
  EXPECT_EQ(fem::faceSet(mesh, "sides").size(), 2u);
  EXPECT_EQ(fem::nodeSet(mesh, "sides"), (std::vector<int>{0, 1, 4, 5, 7, 8, 11}));
  ASSERT_EQ(file.notes.size(), 3u);
  EXPECT_NE(file.notes[0].find("*elastic, *material"), std::string::npos);
  EXPECT_NE(file.notes[1].find("C3D8I, C3D8R"), std::string::npos) << file.notes[1];
  EXPECT_NE(file.notes[2].find("1 node "), std::string::npos);
}

TEST(Abaqus, EveryFaceHasItsName) {
  // Corners of S1 … S6 as the manual lists them.
  const std::vector<std::vector<int>> brick = {{1, 2, 3, 4}, {5, 8, 7, 6}, {1, 5, 6, 2},
                                               {2, 6, 7, 3}, {3, 7, 8, 4}, {4, 8, 5, 1}};
  const std::vector<std::vector<int>> tet = {{1, 2, 3}, {1, 4, 2}, {2, 4, 3}, {3, 4, 1}};
  for (const fem::ElementShape shape : {fem::ElementShape::hex8, fem::ElementShape::tet4}) {
    fem::SolidMesh one;
    const bool isBrick = shape == fem::ElementShape::hex8;
    one.X = isBrick ? fem::boxOf(shape, {1, 1, 1}, {}, {1, 1, 1}).X
                    : std::vector<Vec3>{{}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    one.groups = isBrick ? fem::boxOf(shape, {1, 1, 1}, {}, {1, 1, 1}).groups
                         : std::vector<fem::ElementGroup>{{shape, {0, 1, 2, 3}}};
    std::ostringstream text;
    writeAbaqus(one, text);
    const auto& faces = isBrick ? brick : tet;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const std::string surface = "*SURFACE, NAME=s\n1, S" + std::to_string(f + 1) + "\n";
      const SolidFile file = abaqusFromText(text.str() + surface, "test.inp");
      std::vector<int> expected;
      for (const int corner : faces[f]) expected.push_back(one.groups[0].node[static_cast<std::size_t>(corner - 1)]);
      std::sort(expected.begin(), expected.end());
      EXPECT_EQ(fem::nodeSet(file.mesh, "s"), expected) << fem::name(shape) << " S" << f + 1;
    }
    EXPECT_NE(abaqusRefusal(text.str() + "*SURFACE, NAME=s\n1, S" + std::to_string(faces.size() + 1) + "\n"), "");
  }
}

TEST(Abaqus, ShellsAndBeamsNameFacesAndNodes) {
  const SolidFile file = abaqusFromText(
      nodes + elements +
          "*ELEMENT, TYPE=S4R, ELSET=skin\n20, 21, 24, 23, 22\n*ELEMENT, TYPE=T3D2, ELSET=edge\n30, 1, 2\n",
      "test.inp");
  EXPECT_EQ(fem::faceSet(file.mesh, "skin").size(), 1u);
  EXPECT_EQ(fem::nodeSet(file.mesh, "edge"), (std::vector<int>{0, 1}));
  EXPECT_FALSE(file.mesh.elementSets.contains("skin"));
}

const std::string planeNodes = "*NODE\n1, 0, 0\n2, 2, 0\n3, 2, 1\n4, 0, 1\n5, 3, 0\n6, 3, 1\n";

TEST(Abaqus, PlaneStrainIsReadWhereThereAreNoVolumes) {
  const SolidFile file =
      abaqusFromText(planeNodes +
                         "*ELEMENT, TYPE=CPE4R, ELSET=left\n1, 1,2,3,4\n*ELEMENT, TYPE=CPE4H\n2, 2,5,6,3\n"
                         "*SURFACE, NAME=right\n2, S2\n*SURFACE, NAME=all\n"
                         "1, S1\n1, S2\n1, S3\n1, S4\n*NSET, NSET=foot\n1, 2, 5\n",
                     "test.inp");
  const fem::SolidMesh& mesh = file.mesh;
  ASSERT_EQ(mesh.groups.size(), 1u);
  EXPECT_EQ(mesh.groups[0].shape, fem::ElementShape::quad4);
  EXPECT_EQ(fem::elementSet(mesh, "left"), std::vector<int>{0});
  EXPECT_EQ(fem::nodeSet(mesh, "foot"), (std::vector<int>{0, 1, 4}));
  EXPECT_EQ(fem::faceSet(mesh, "right").at(0).node, (std::array<int, 9>{4, 5, -1, -1, -1, -1, -1, -1, -1}));
  const std::vector<fem::Face>& all = fem::faceSet(mesh, "all");
  ASSERT_EQ(all.size(), 4u);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(all[static_cast<std::size_t>(k)].node[0], k);
    EXPECT_EQ(all[static_cast<std::size_t>(k)].node[1], (k + 1) % 4);
  }
  ASSERT_EQ(file.notes.size(), 2u);
  EXPECT_NE(file.notes[0].find("plane strain"), std::string::npos) << file.notes[0];
  EXPECT_NE(file.notes[1].find("CPE4H, CPE4R"), std::string::npos) << file.notes[1];
}

TEST(Abaqus, OtherElementsOfAPlaneAreRefusedByName) {
  const auto with = [](const std::string& type, const std::string& list) {
    return abaqusRefusal(planeNodes + "*ELEMENT, TYPE=" + type + "\n1, " + list + "\n");
  };
  EXPECT_NE(with("CPS4", "1,2,3,4").find("element 1 is of plane stress"), std::string::npos) << with("CPS4", "1,2,3,4");
  EXPECT_NE(with("CPE3", "1,2,3").find("a triangle"), std::string::npos);
  EXPECT_NE(with("S4R", "1,2,3,4").find("a shell"), std::string::npos);
  EXPECT_NE(with("CAX4", "1,2,3,4").find("not known"), std::string::npos);
  EXPECT_NE(with("CPE4", "1,4,3,2").find("order of their nodes is reversed"), std::string::npos)
      << with("CPE4", "1,4,3,2");
  EXPECT_NE(abaqusRefusal(planeNodes + "*ELEMENT, TYPE=CPE4\n1, 1,2,3,4\n*SURFACE, NAME=a\n1, S5\n").find("S1 to S4"),
            std::string::npos);
}

TEST(Abaqus, OnePartThatIsNotMovedIsFlat) {
  const std::string part =
      "*PART, NAME=p\n" + nodes + elements + "*END PART\n*ASSEMBLY, NAME=a\n*INSTANCE, NAME=p-1, PART=p\n";
  const SolidFile file =
      abaqusFromText(part + "*END INSTANCE\n*NSET, NSET=top, INSTANCE=p-1\n21, 22\n*END ASSEMBLY\n", "test.inp");
  EXPECT_EQ(fem::nodeSet(file.mesh, "top").size(), 2u);
  EXPECT_NE(abaqusRefusal(part + "1., 0., 0.\n*END INSTANCE\n").find("the instance is moved"), std::string::npos);
  EXPECT_NE(abaqusRefusal(part + "*END INSTANCE\n*INSTANCE, NAME=p-2, PART=p\n").find("second *instance"),
            std::string::npos);
  EXPECT_NE(abaqusRefusal(part + "*PART, NAME=q\n").find("second *part"), std::string::npos);
}

TEST(Abaqus, BrokenFilesAreRefusedWithTheirLine) {
  const std::string good = nodes + elements;
  ASSERT_EQ(abaqusRefusal(good), "");
  const std::pair<std::string, std::string> broken[] = {
      {"", "no volume elements"},
      {nodes, "no volume elements"},
      {good + "*INCLUDE, INPUT=other.inp\n", "there is no file 'other.inp' for *include [test.inp, line 23]"},
      {good + "*NGEN\n", "*ngen"},
      {good + "*NODE, INPUT=other.inp\n", "there is no file 'other.inp' for *node"},
      {good + "*NODE, SYSTEM=C\n", "system"},
      {good + "*NODE\n1, 0., 0., 0.\n", "node 1 occurs twice [test.inp, line 24]"},
      {good + "*NODE\n31\n", "entries"},
      {good + "*NODE\n31, a, 0., 0.\n", "'a' is not a number [test.inp, line"},
      {good + "*NODE\n31, inf, 0., 0.\n", "finite"},
      {good + "*NODE\n31, 1e30, 0., 0.\n", "node 31 lies farther than 1e15 m"},
      {good + "*ELEMENT\n", "no parameter type"},
      {good + "*ELEMENT, TYPE=C3D6\n", "'C3D6'"},
      {good + "*ELEMENT, TYPE=C3D8X\n", "'C3D8X'"},
      {good + "*ELEMENT, TYPE=C3D8\n7, 1,2,3,4,11,12,13,14\n", "element 7 occurs twice"},
      {good + "*ELEMENT, TYPE=C3D4\n8, 1,2,3\n", "has 3 nodes"},
      {good + "*ELEMENT, TYPE=C3D4\n8, 1,2,3,11,12\n", "has 5 nodes"},
      {good + "*ELEMENT, TYPE=C3D4\n8, 1,2,3,77\n", "node 77 does not exist [test.inp, line 24]"},
      {good + "*ELEMENT, TYPE=C3D4\n8, 1,3,2,11\n", "inside out or too distorted: element 8 [test.inp, line 24]"},
      {good + "*ELEMENT, TYPE=S3, ELSET=a\n8, 1,2,11\n", "surface element 8 is no face"},
      {good + "*NSET\n1\n", "no parameter nset"},
      {good + "*NSET, NSET=a\nnothing\n", "there is no set 'nothing' yet"},
      {good + "*NSET, NSET=a\n1, 2\n77\n", "node 77 does not exist [test.inp, line 25]"},
      {good + "*NSET, NSET=a, GENERATE\n4, 1\n", "makes no sense"},
      {good + "*NSET, NSET=a, GENERATE\n1, 4, 0\n", "makes no sense"},
      {good + "*NSET, NSET=a, GENERATE\n1\n", "GENERATE has 1"},
      {good + "*NSET, NSET=a, GENERATE\n1, 2000000000, 1\n", "GENERATE names 2000000000 nodes"},
      {good + "*NSET, NSET=a\n1\n*NSET, NSET=a\n2\n77\n", "node 77 does not exist [test.inp, line 27]"},
      {good + "*NSET, NSET=a, GENERATE\n1, 4\n14, 15\n", "node 15 does not exist [test.inp, line 25]"},
      {good + "*NSET, NSET=a\n77\n*NSET, NSET=b\n1\na\n", "node 77 does not exist [test.inp, line 24]"},
      {good + "*NSET, NSET=a\n77\n*SURFACE, NAME=A, TYPE=NODE\na\n", "node 77 does not exist [test.inp, line 24]"},
      {good + "*ELSET, ELSET=a\n\n7\n77\n", "element 77 does not exist [test.inp, line 26]"},
      {good + "*ELSET, ELSET=a\n77\n*SURFACE, NAME=A\na, S1\n", "element 77 does not exist [test.inp, line 24]"},
      {good + "*ELEMENT, TYPE=T3D2, ELSET=a\n8, 1, 77\n*NSET, NSET=b, ELSET=a\n",
       "node 77 does not exist [test.inp, line 24]"},
      {good + "*SURFACE, NAME=a\n7\n", "the face of a surface is nothing"},
      {good + "*SURFACE, NAME=a\n7, SPOS\n", "'spos'"},
      {good + "*SURFACE, NAME=a\n77, S1\n", "no volume element 77"},
      {good + "*SURFACE, NAME=a\nnone, S1\n", "there is no set 'none'"},
      {good + "*SURFACE, NAME=a, TYPE=CYLINDER\n", "'cylinder'"}};
  for (const auto& [file, wanted] : broken)
    EXPECT_NE(abaqusRefusal(file).find(wanted), std::string::npos) << wanted << " not in: " << abaqusRefusal(file);
}

TEST(Abaqus, ManyRangesOfManyLabelsTakeNoMemory) {
  std::string text = nodes + elements + "*NSET, NSET=big, GENERATE\n";
  for (int line = 0; line < 1000; ++line) text += "1, 2000000000, 1\n";
  for (int line = 0; line < 60; ++line) text += "*NSET, NSET=big\nbig, big\n";
  EXPECT_NE(abaqusRefusal(text).find("GENERATE names 2000000000 nodes"), std::string::npos) << abaqusRefusal(text);
  text = nodes + elements + "*NSET, NSET=a, GENERATE\n";
  for (int line = 0; line < 1000; ++line) text += "11, 14, 1\n";
  EXPECT_EQ(fem::nodeSet(abaqusFromText(text, "test.inp").mesh, "a"), (std::vector<int>{4, 5, 6, 7}));
}

TEST(Abaqus, UpToTenBadElementsAreNamed) {
  std::ostringstream text;
  fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {12, 1, 1}, {}, {12, 1, 1});
  writeAbaqus(mesh, text);
  std::string flat = text.str();
  for (std::size_t at = 0; (at = flat.find(", 1\n", at)) != std::string::npos;) flat.replace(at, 4, ", 0\n");
  const std::string message = abaqusRefusal(flat);
  EXPECT_NE(message.find("elements 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 2 more"), std::string::npos) << message;
}

TEST(Abaqus, ACtrlZAtTheEndIsTheEnd) {
  const std::string good = nodes + elements + "*NSET, NSET=a\n1, 2\n";
  for (const char* end : {"\x1A", "\r\n\x1A", "\x1A\x1A\n"})
    EXPECT_EQ(fem::nodeSet(abaqusFromText(good + end, "test.inp").mesh, "a").size(), 2u);
  EXPECT_NE(abaqusRefusal(good + "\x1A\n3\n").find("there is no set '?' yet [test.inp, line 25]"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::solid_io
