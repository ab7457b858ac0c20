// Solids that fill closed surfaces, with a mesher of the test's own.
#include <gtest/gtest.h>

#include "../io/scratch_folder.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/mesh_io/surface_files.hpp"
#include "scene_parts.hpp"
#include "surfaces.hpp"

namespace dovetail::scene::test {
namespace {

using io::test::ScratchFolder;

/// Puts a mesher in use as long as it lives.
struct InUse {
  explicit InUse(VolumeMesher mesher) { useVolumeMesher(std::move(mesher)); }
  ~InUse() { useVolumeMesher({}); }
};

std::string refusalOf(const std::string& solid, const std::filesystem::path& folder) {
  try {
    build(sceneOf(solid, folder));
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(SceneTetrahedra, ProgramsWithoutAMesherSayWhatToDo) {
  const ScratchFolder folder;
  writeBlock(folder / "b.stl");
  expectParts(refusalOf(solidInside("b.stl", "0.1"), folder.path()),
              {"cannot fill surfaces", "b.stl", "DOVETAIL_PROGRAM_CGAL", "Gmsh", "solids.0"});
}

TEST(SceneTetrahedra, WhatIsDroppedOrTurnedOfTheSurfaceIsNoted) {
  const ScratchFolder folder;
  geometry::TriangleMesh surface = surfaceOf(block(fem::ElementShape::hex8));
  std::swap(surface.facets[0][0], surface.facets[0][1]);
  surface.facets.push_back(surface.facets[3]);
  mesh_io::writeStl(folder / "b.stl", surface.x, surface.facets);
  const InUse mesher([](const geometry::TriangleMesh&, double, double) { return block(fem::ElementShape::tet4); });
  const Built built = build(sceneOf(solidInside("b.stl", "0.1"), folder.path()));
  const auto has = [&](const std::string& note) {
    return std::find(built.notes.begin(), built.notes.end(), note) != built.notes.end();
  };
  EXPECT_TRUE(has("b.stl: 1 duplicate facet was removed."));
  EXPECT_TRUE(has("b.stl: 1 facet was reversed: neighbours must be oriented alike, and closed parts outwards."));
}

TEST(SceneTetrahedra, TheMesherGetsTheSurfaceWeldedAndInMetres) {
  const ScratchFolder folder;
  writeBlock(folder / "b.stl", 1000.0);
  double size = 0.0, distance = 0.0, volume = 0.0;
  std::size_t vertices = 0;
  const InUse mesher([&](const geometry::TriangleMesh& surface, double wanted, double off) {
    size = wanted, distance = off, vertices = surface.x.size();
    volume = geometry::signedVolume(surface.x, surface.facets);
    return block(fem::ElementShape::tet4);
  });
  const auto inside = [&](const std::string& more) {
    return build(sceneOf(solidInside("b.stl", "\"50 mm\", \"scale\": 1e-3" + more), folder.path()));
  };
  const Built built = inside("");
  EXPECT_EQ(built.run->solid(0).nodes().X.size(), block(fem::ElementShape::tet4).X.size());
  EXPECT_EQ(vertices, 8U);
  EXPECT_NEAR(volume, blockVolume, 1e-9);
  EXPECT_EQ(size, 0.05);
  EXPECT_EQ(distance, 0.0025);
  inside(R"(, "surface_distance": "1 mm")");
  EXPECT_EQ(distance, 1e-3);
}

TEST(SceneTetrahedra, SurfacesThatCannotBeFilledAreRefused) {
  const ScratchFolder folder;
  const InUse mesher([](const geometry::TriangleMesh&, double, double) -> fem::SolidMesh {
    throw NumericalError("nothing came out", "mesher", "give a smaller size");
  });
  writeBlock(folder / "b.stl");
  expectParts(refusalOf(solidInside("b.stl", "0.1"), folder.path()), {"nothing came out", "b.stl", "solids.0"});
  expectParts(refusalOf(solidInside("b.stl", "1e-6"), folder.path()), {"more than 1e8 tetrahedra", "larger size"});
  geometry::TriangleMesh open = surfaceOf(block(fem::ElementShape::hex8));
  open.facets.pop_back();
  mesh_io::writeStl(folder / "open.stl", open.x, open.facets);
  const std::string message = refusalOf(solidInside("open.stl", "0.1"), folder.path());
  expectParts(message, {"bounds no volume", "open.stl", "close its holes"});
  EXPECT_EQ(message.find('\n'), std::string::npos);
  expectParts(refusalOf(solidInside("b.stl", "0"), folder.path()), {"\"size\""});
}

}  // namespace
}  // namespace dovetail::scene::test
