// STL, OBJ and PLY: what is written is read back, and every format gives the same cube.
#include <gtest/gtest.h>

#include <algorithm>

#include "cube_files.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/geometry/surface_checks.hpp"
#include "dovetail/mesh_io/surface_files.hpp"

namespace dovetail::mesh_io {
namespace {

using namespace test;
using geometry::Facet;

/// The same triangles in the same order with corners at the same places.
void expectSameTriangles(const TriangleMesh& a, const TriangleMesh& b) {
  ASSERT_EQ(a.facets.size(), b.facets.size());
  for (std::size_t f = 0; f < a.facets.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(a.x[a.facets[f][k]], b.x[b.facets[f][k]]) << f << " " << k;
}

void expectCube(const TriangleMesh& mesh) {
  EXPECT_EQ(mesh.x.size(), 8u);
  expectSameTriangles(mesh, cube());
  EXPECT_TRUE(geometry::checkSurface(mesh.x, mesh.facets).none());
  EXPECT_DOUBLE_EQ(geometry::signedVolume(mesh.x, mesh.facets), 1.0);
}

TEST(SurfaceFiles, EveryFormatGivesTheCube) {
  const ScratchFolder folder;
  const TriangleMesh wanted = cube();
  writeStl(folder / "binary.stl", wanted.x, wanted.facets);
  writeText(folder / "ascii.STL", asciiStl(wanted));
  writeText(folder / "cube.obj", cubeObj());
  writeText(folder / "ascii.ply", asciiPly());
  writeText(folder / "binary.ply", binaryPly());
  for (const char* name : {"binary.stl", "ascii.STL", "cube.obj", "ascii.ply", "binary.ply"}) {
    SCOPED_TRACE(name);
    expectCube(readSurface(folder / name));
  }
  EXPECT_NE(messageOf<InputError>([&] { readSurface(folder / "cube.step"); }).find(".stl, .obj or .ply"),
            std::string::npos);
}

TEST(SurfaceFiles, BinaryStlKeepsThirtyTwoBitCoordinatesToTheBit) {
  std::mt19937_64 random(5);
  TriangleMesh mesh;
  for (int v = 0; v < 300; ++v) {
    float value[3];
    for (float& f : value) do {
        f = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
      } while (!(std::abs(f) <= 1e15f));
    mesh.x.push_back({value[0], value[1], value[2]});
  }
  for (int f = 0; f < 500; ++f) {
    const int a = static_cast<int>(random() % 100);
    mesh.facets.push_back({a, a + 100, a + 200});
  }
  const ScratchFolder folder;
  writeStl(folder / "random.stl", mesh.x, mesh.facets);
  expectSameTriangles(readStl(folder / "random.stl"), mesh);
  EXPECT_EQ(readText(folder / "random.stl").size(), 84u + 50u * 500u);
  writeStl(folder / "random.stl", mesh.x, std::span(mesh.facets).first(1));  // an earlier file of ours is replaced
  EXPECT_EQ(readStl(folder / "random.stl").facets.size(), 1u);
}

TEST(SurfaceFiles, ABinaryStlMayCallItselfSolid) {
  const ScratchFolder folder;
  writeStl(folder / "cube.stl", cube().x, cube().facets);
  writeText(folder / "solid.stl", "solid" + readText(folder / "cube.stl").substr(5));
  expectCube(readStl(folder / "solid.stl"));
}

TEST(SurfaceFiles, AsciiStlKeepsDoublesAndTakesSeveralSolidsAndPolygons) {
  TriangleMesh mesh = cube();
  for (Vec3& x : mesh.x) x = 0.1 * x + Vec3{1.0 / 3.0, 1e-9, -7.1e12};
  const ScratchFolder folder;
  writeText(folder / "two.stl", "\n " + asciiStl(mesh) + asciiStl(cube()));
  const TriangleMesh both = readStl(folder / "two.stl");
  TriangleMesh wanted = mesh;
  for (const Vec3& x : cube().x) wanted.x.push_back(x);
  for (const Facet& f : cube().facets) wanted.facets.push_back({f[0] + 8, f[1] + 8, f[2] + 8});
  expectSameTriangles(both, wanted);
  writeText(
      folder / "quad.stl",
      "SOLID\nFACET NORMAL nan nan nan OUTER LOOP\nVERTEX 0 0 0 VERTEX 1 0 0\nVERTEX 1 1 0\nVERTEX 0 1 0\nENDLOOP\n"
      "ENDFACET\nENDSOLID quad");
  EXPECT_EQ(readStl(folder / "quad.stl").facets, (std::vector<Facet>{{0, 1, 2}, {0, 2, 3}}));
}

std::string withCarriageReturns(std::string text) {
  std::replace(text.begin(), text.end(), '\n', '\r');
  return text;
}

TEST(SurfaceFiles, MarksLineEndsAndCommentsOfOthersAreTaken) {
  const ScratchFolder folder;
  const std::string stl = asciiStl(cube()), mark = "\xEF\xBB\xBF";
  std::string line = stl;
  std::replace(line.begin(), line.end(), '\n', ' ');
  const std::pair<std::string, std::string> files[] = {{"mark.stl", mark + stl},
                                                       {"comments.stl", "# solid by someone\n\n// of today\n" + stl},
                                                       {"both.stl", mark + "; by someone\r\n" + stl},
                                                       {"cr.stl", withCarriageReturns(stl)},
                                                       {"line.stl", line},
                                                       {"mark.obj", mark + cubeObj()},
                                                       {"cr.obj", withCarriageReturns(cubeObj())},
                                                       {"mark.ply", mark + asciiPly()},
                                                       {"cr.ply", withCarriageReturns(asciiPly())}};
  for (const auto& [name, content] : files) {
    SCOPED_TRACE(name);
    writeText(folder / name, content);
    expectCube(readSurface(folder / name));
  }
  writeText(folder / "two.stl", line + " " + line);
  EXPECT_EQ(readStl(folder / "two.stl").facets.size(), 24u);
  writeText(folder / "name.stl", "solid facet\n" + stl.substr(stl.find('\n') + 1));
  expectCube(readStl(folder / "name.stl"));
  const std::string body = stl.substr(stl.find('\n') + 1);
  writeText(folder / "words.stl", "solid with facet normal in its endsolid name facet normal\n" +
                                      body.substr(0, body.rfind("endsolid")) + "endsolid a solid facet normal name\n");
  expectCube(readStl(folder / "words.stl"));
  writeText(folder / "empty.stl", "solid a endsolid a\n" + stl);
  expectCube(readStl(folder / "empty.stl"));
}

TEST(SurfaceFiles, WeldingJoinsVerticesWithinTheToleranceOnly) {
  TriangleMesh mesh;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> shift(-0.4e-3, 0.4e-3);
  for (const Facet& f : cube().facets) {
    const int first = static_cast<int>(mesh.x.size());
    for (const int v : f) mesh.x.push_back(corner(v) + Vec3{shift(random), shift(random), shift(random)});
    mesh.facets.push_back({first, first + 1, first + 2});
  }
  const ScratchFolder folder;
  writeStl(folder / "loose.stl", mesh.x, mesh.facets);
  EXPECT_EQ(readStl(folder / "loose.stl").x.size(), 36u);
  const TriangleMesh welded = readStl(folder / "loose.stl", 2e-3);
  EXPECT_EQ(welded.x.size(), 8u);
  EXPECT_TRUE(geometry::checkSurface(welded.x, welded.facets).closedAndOriented());
  EXPECT_NE(messageOf<InputError>([&] { readStl(folder / "loose.stl", -1.0); }), "");
}

TEST(SurfaceFiles, TheWriterRefusesWhatTheFormatCannotHold) {
  const ScratchFolder folder;
  const std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {0, 1e39, 0}};
  const std::vector<Facet> facets{{0, 1, 2}}, wrong{{0, 1, 3}};
  EXPECT_NE(messageOf<InputError>([&] { writeStl(folder / "a.stl", x, facets); }).find("facet 0"), std::string::npos);
  EXPECT_NE(messageOf<InputError>([&] { writeStl(folder / "a.stl", x, wrong); }).find("facet 0"), std::string::npos);
  EXPECT_NE(messageOf<InputError>([&] { writeStl(folder / "a.stl", x, {}); }), "");
  EXPECT_TRUE(folder.content().empty());
  writeText(folder / "a.stl", "somebody else's");
  EXPECT_NE(messageOf<InputError>([&] { writeStl(folder / "a.stl", cube().x, cube().facets); }), "");
  EXPECT_EQ(readText(folder / "a.stl"), "somebody else's");
}

TEST(SurfaceFiles, ACtrlZAtTheEndIsTheEnd) {
  const ScratchFolder folder;
  for (const auto& [name, text] : {std::pair{"a.stl", asciiStl(cube())}, {"a.obj", cubeObj()}, {"a.ply", asciiPly()}}) {
    writeText(folder / name, text + "\x1A");
    expectCube(readSurface(folder / name));
  }
}

TEST(SurfaceFiles, NormalsAgainstTheOrderOfTheVerticesAreNoted) {
  const ScratchFolder folder;
  const TriangleMesh wanted = cube();
  writeStl(folder / "a.stl", wanted.x, wanted.facets);
  std::vector<std::string> notes;
  readSurface(folder / "a.stl", &notes);
  EXPECT_TRUE(notes.empty());
  std::string bytes = readText(folder / "a.stl");
  for (const std::size_t facet : {2u, 5u})
    for (std::size_t k = 0; k < 3; ++k) bytes[84 + 50 * facet + 4 * k + 3] ^= '\x80';  // the signs
  writeText(folder / "b.stl", bytes);
  expectCube(readSurface(folder / "b.stl", &notes));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("2 of its 12 facets"), std::string::npos) << notes[0];
}

}  // namespace
}  // namespace dovetail::mesh_io
