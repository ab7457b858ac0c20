#include <gtest/gtest.h>

#include <filesystem>

#include "../io/scratch_folder.hpp"
#include "mesh_files.hpp"

namespace dovetail::solid_io {
namespace {

void expectSame(const fem::SolidMesh& a, const fem::SolidMesh& b, const std::string& what) {
  EXPECT_EQ(a.X, b.X) << what;
  EXPECT_EQ(a.thickness, b.thickness) << what;
  ASSERT_EQ(a.groups.size(), b.groups.size()) << what;
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    EXPECT_EQ(a.groups[g].shape, b.groups[g].shape) << what;
    EXPECT_EQ(a.groups[g].node, b.groups[g].node) << what;
  }
  EXPECT_EQ(a.nodeSets, b.nodeSets) << what;
  EXPECT_EQ(a.elementSets, b.elementSets) << what;
  ASSERT_EQ(a.faceSets.size(), b.faceSets.size()) << what;
  for (const auto& [name, faces] : a.faceSets)
    EXPECT_EQ(sortedFaces(faces), sortedFaces(fem::faceSet(b, name))) << what << " " << name;
}

TEST(SolidFiles, MeshesOfAllShapesGoToGmshAndBack) {
  for (const fem::ElementShape shape : fem::allCellShapes) {
    const fem::SolidMesh mesh = testMesh(shape);
    std::ostringstream text;
    writeGmsh(mesh, text);
    const SolidFile back = gmshFromText(text.str(), "test.msh");
    expectSame(mesh, back.mesh, fem::name(shape));
    const bool plane = fem::dimensionOf(shape) == 2;
    ASSERT_EQ(back.notes.size(), plane ? 2u : 1u);  // elements of two sets are written twice
    EXPECT_NE(back.notes.back().find("2 elements"), std::string::npos) << back.notes.back();
    if (plane) {
      EXPECT_NE(back.notes[0].find("plane strain"), std::string::npos) << back.notes[0];
    }
  }
}

TEST(SolidFiles, MeshesOfAllShapesGoToAbaqusAndBack) {
  for (const fem::ElementShape shape : fem::allCellShapes) {
    const fem::SolidMesh mesh = testMesh(shape);
    std::ostringstream text;
    writeAbaqus(mesh, text);
    const SolidFile back = abaqusFromText(text.str(), "test.inp");
    expectSame(mesh, back.mesh, fem::name(shape));
    EXPECT_EQ(back.notes.size(), fem::dimensionOf(shape) == 2 ? 1u : 0u);
  }
}

TEST(SolidFiles, MixedMeshesGoThereAndBack) {
  fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex20, {1, 1, 1}, {}, {1.0, 1.0, 1.0});
  const fem::SolidMesh tets = fem::boxOf(fem::ElementShape::tet10, {1, 1, 1}, {2.0, 0.0, 0.0}, {3.0, 1.0, 1.0});
  const int first = static_cast<int>(mesh.X.size());
  mesh.X.insert(mesh.X.end(), tets.X.begin(), tets.X.end());
  mesh.groups.push_back(tets.groups[0]);
  for (int& node : mesh.groups[1].node) node += first;
  mesh.faceSets["end"] = tets.faceSets.at("x+");
  for (fem::Face& face : mesh.faceSets["end"])
    for (int& node : face.node)
      if (node >= 0) node += first;
  mesh.nodeSets["end"] = tets.nodeSets.at("x+");
  for (int& node : mesh.nodeSets["end"]) node += first;
  mesh.elementSets["both"] = {0, 1, 2};
  std::ostringstream gmsh, abaqus;
  writeGmsh(mesh, gmsh);
  writeAbaqus(mesh, abaqus);
  const std::vector<int> bricks = {0}, tetrahedra = {1, 2, 3, 4, 5, 6};
  mesh.elementSets.insert({{"hex20", bricks}, {"tet10", tetrahedra}, {"both hex20", bricks}, {"both tet10", {1, 2}}});
  expectSame(mesh, abaqusFromText(abaqus.str(), "test.inp").mesh, "Abaqus");
  expectSame(mesh, gmshFromText(gmsh.str(), "test.msh").mesh, "Gmsh");
  std::ostringstream again;
  writeGmsh(mesh, again);
  expectSame(mesh, gmshFromText(again.str(), "test.msh").mesh, "Gmsh, with sets by shape");
}

TEST(SolidFiles, FilesAreToldApartByTheirEnding) {
  const io::test::ScratchFolder scratch;
  const auto folder = scratch / "dovetail_solid_files";
  std::filesystem::create_directories(folder);
  const fem::SolidMesh mesh = testMesh(fem::ElementShape::tet10);
  for (const char* name : {"a.msh", "a.inp"}) {
    writeSolid(mesh, folder / name);
    writeSolid(mesh, folder / name);  // our own files are replaced
    expectSame(mesh, readSolid(folder / name).mesh, name);
  }
  EXPECT_THROW(writeSolid(mesh, folder / "a.stl"), InputError);
  EXPECT_THROW(readSolid(folder / "a.stl"), InputError);
  EXPECT_THROW(readSolid(folder / "none.msh"), InputError);
}

TEST(SolidFiles, WhatCannotBeWrittenIsRefused) {
  std::ostringstream out;
  fem::SolidMesh quote = testMesh(fem::ElementShape::hex8);
  quote.nodeSets["a\"b"] = {0};
  EXPECT_THROW(writeGmsh(quote, out), InputError);
  EXPECT_THROW(writeAbaqus(quote, out), InputError);
  fem::SolidMesh cases = testMesh(fem::ElementShape::hex8);
  cases.nodeSets["top"] = cases.nodeSets["Top"] = {0};
  EXPECT_NO_THROW(writeGmsh(cases, out));
  EXPECT_NE(messageOf([&] { writeAbaqus(cases, out); }).find("case"), std::string::npos);
  fem::SolidMesh strange = testMesh(fem::ElementShape::hex8);
  strange.faceSets["strange"] = {{fem::FaceShape::quad4, {0, 1, 2, 3, -1, -1, -1, -1, -1}}};
  EXPECT_NE(messageOf([&] { writeGmsh(strange, out); }).find("\"strange\""), std::string::npos);
  EXPECT_NE(messageOf([&] { writeAbaqus(strange, out); }).find("\"strange\""), std::string::npos);
}

}  // namespace
}  // namespace dovetail::solid_io
