// Solids that fill closed surfaces, by CGAL.
#include <gtest/gtest.h>

#include "../io/scratch_folder.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/fem_cgal/tetrahedra.hpp"
#include "scene_parts.hpp"
#include "surfaces.hpp"

namespace dovetail::scene::test {
namespace {

TEST(SceneTetrahedra, FillASurfaceThatIsHeldAndSags) {
  const io::test::ScratchFolder folder;
  writeBlock(folder / "b.stl");
  useVolumeMesher([](const geometry::TriangleMesh& surface, double size, double distance) {
    return fem::tetrahedraInside(surface, {.size = size, .surfaceDistance = distance});
  });
  Built built = started(sceneOf(R"("gravity": [0, 0, -9.81],)" + solidInside("b.stl", "0.04"), folder.path()));
  useVolumeMesher({});
  EXPECT_NEAR(fem::measureQuality(built.meshes[0]).shapes[0].volume, blockVolume, 1e-9);
  EXPECT_TRUE(built.meshes[0].faceSets.contains("skin"));
  built.run->advance(20);
  const fem::Nodes& nodes = built.run->solid(0).nodes();
  double lowest = 0.0;
  for (std::size_t n = 0; n < nodes.X.size(); ++n) {
    if (nodes.X[n].z == 0.0) {
      EXPECT_EQ(nodes.u[n], Vec3{});
    }
    lowest = std::min(lowest, nodes.u[n].z);
  }
  EXPECT_LT(lowest, 0.0);
}

}  // namespace
}  // namespace dovetail::scene::test
