// FCL against the hierarchical grid, and on solid and open meshes.
#include <gtest/gtest.h>

#include "clouds.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/geometry_fcl/overlap_audit.hpp"

namespace dovetail::geometry {
namespace {

TriangleMesh box(const Vec3& lower, const Vec3& upper, bool open = false) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c)
    mesh.x.push_back({(c & 1 ? upper : lower).x, (c & 2 ? upper : lower).y, (c & 4 ? upper : lower).z});
  mesh.facets = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  if (open) mesh.facets.resize(10);
  return mesh;
}

TEST(OverlapAudit, FindsThePairsOfTheHierarchicalGrid) {
  for (const double ratio : {1.0, 20.0}) {
    const Cloud cloud = randomCloud(1500, ratio, 0.02, -0.5, 0.5, 17);
    HierarchicalGrid grid;
    grid.build(cloud.x, cloud.radius);
    const auto found = grid.pairs();
    const std::vector<std::array<int, 2>> wanted(found.begin(), found.end());
    EXPECT_GT(wanted.size(), 50u);
    EXPECT_EQ(auditOverlaps({cloud.x, cloud.radius, {}}), wanted) << ratio;
  }
}

TEST(OverlapAudit, FindsSpheresThatCutAMeshAndThoseWithinASolidOne) {
  const Cloud cloud = randomCloud(800, 3.0, 0.02, -1.0, 1.0, 23);
  const Vec3 lower{-0.5, -0.4, -0.3}, upper{0.2, 0.5, 0.6};
  for (const bool open : {false, true}) {
    const std::vector<TriangleMesh> mesh{box(lower, upper, open)};
    std::vector<std::array<int, 2>> wanted;
    for (int i = 0; i < 800; ++i) {
      Vec3 nearest = cloud.x[i];
      double depth = 1.0;
      for (int k = 0; k < 3; ++k) {
        nearest[k] = std::clamp(nearest[k], lower[k], upper[k]);
        depth = std::min(depth, cloud.x[i][k] - lower[k]);
        if (k != 0 || !open) depth = std::min(depth, upper[k] - cloud.x[i][k]);
      }
      // Without its face at upper x the box is five sheets.
      double gap = norm(cloud.x[i] - nearest);
      if (open && depth > 0.0 && cloud.x[i].x <= upper.x) gap = depth;
      if (open && cloud.x[i].x > upper.x) {
        const double y = cloud.x[i].y, z = cloud.x[i].z, dx = cloud.x[i].x - upper.x;
        const double rim =
            std::min({std::abs(y - lower.y), std::abs(y - upper.y), std::abs(z - lower.z), std::abs(z - upper.z)});
        if (y > lower.y && y < upper.y && z > lower.z && z < upper.z) gap = std::hypot(dx, rim);
      }
      if (gap < cloud.radius[i]) wanted.push_back({i, 800});
    }
    EXPECT_GT(wanted.size(), 20u);
    const AuditBodies bodies{cloud.x, cloud.radius, mesh};
    std::vector<std::array<int, 2>> found = auditOverlaps(bodies);
    std::erase_if(found, [](const auto& pair) { return pair[1] < 800; });
    EXPECT_EQ(found, wanted) << open;
  }
}

TEST(OverlapAudit, FindsMeshesThatCrossAndThoseThatLieInsideSolidOnes) {
  const std::vector<TriangleMesh> mesh{box({0, 0, 0}, {1, 1, 1}), box({0.9, 0.9, 0.9}, {2, 2, 2}),
                                       box({0.3, 0.3, 0.3}, {0.4, 0.4, 0.4}), box({3, 0, 0}, {4, 1, 1}, true),
                                       box({3.3, 0.3, 0.3}, {3.4, 0.4, 0.4})};
  EXPECT_EQ(auditOverlaps({{}, {}, mesh}), (std::vector<std::array<int, 2>>{{0, 1}, {0, 2}}));
}

TEST(OverlapAudit, BadBodiesAreRefused) {
  const std::vector<Vec3> x{{0, 0, 0}};
  const std::vector<double> none, bad{-1.0};
  const std::vector<TriangleMesh> empty(1);
  EXPECT_THROW(auditOverlaps({x, none, {}}), InputError);
  EXPECT_THROW(auditOverlaps({x, bad, {}}), InputError);
  EXPECT_THROW(auditOverlaps({{}, {}, empty}), InputError);
}

}  // namespace
}  // namespace dovetail::geometry
