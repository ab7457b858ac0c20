#include <gtest/gtest.h>

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "scenes.hpp"

namespace dovetail::surface {
namespace {

class CoarseGrain : public ::testing::TestWithParam<Variant> {};

TEST_P(CoarseGrain, RowsSumToOne) {
  const fem::SolidMesh mesh = unitBlock();
  const Skin skin = carriedSkin(mesh, GetParam());
  EXPECT_EQ(skin.carrier.rows(), static_cast<int>(skin.X.size()));
  cg::requireValid(skin.carrier);
  EXPECT_LE(cg::rowSumError(skin.carrier), 1e-14);
}

TEST_P(CoarseGrain, NoKernelCrossesASharpEdge) {
  const fem::SolidMesh mesh = unitBlock();
  const Skin skin = carriedSkin(mesh, GetParam());
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) {
    const auto& corner = skin.wall.facets[t];
    const Vec3 normal = normalized(cross(skin.X[corner[1]] - skin.X[corner[0]], skin.X[corner[2]] - skin.X[corner[0]]));
    for (int vertex : corner)
      for (int node : skin.carrier.rowColumns(vertex))
        EXPECT_LE(std::abs(dot(normal, mesh.X[node] - skin.X[vertex])), 1e-14) << "node " << node << " off the face";
  }
}

INSTANTIATE_TEST_SUITE_P(Variants, CoarseGrain, ::testing::ValuesIn(flatVariants()), VariantName{});

TEST(CoarseGrainLimits, WidthZeroIsTheLocalMapBitForBit) {
  const fem::SolidMesh mesh = unitBlock();
  const Skin local = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  for (auto correction : {cg::KernelCorrection::none, cg::KernelCorrection::linear, cg::KernelCorrection::symmetric}) {
    const Skin skin = carriedSkin(mesh, {"zero", 0.0, cg::KernelShape::lucy, correction});
    EXPECT_EQ(skin.carrier.offsets, local.localMap.offsets);
    EXPECT_EQ(skin.carrier.column, local.localMap.column);
    EXPECT_EQ(skin.carrier.weight, local.localMap.weight);
    EXPECT_TRUE(skin.wall.oneSided);
  }
}

double distanceFromLocalMap(const Skin& skin) {
  std::vector<double> local(skin.localMap.columns);
  double largest = 0.0;
  for (int row = 0; row < skin.carrier.rows(); ++row) {
    std::fill(local.begin(), local.end(), 0.0);
    for (std::size_t k = 0; k < skin.localMap.rowColumns(row).size(); ++k)
      local[skin.localMap.rowColumns(row)[k]] -= skin.localMap.rowWeights(row)[k];
    for (std::size_t k = 0; k < skin.carrier.rowColumns(row).size(); ++k)
      local[skin.carrier.rowColumns(row)[k]] += skin.carrier.rowWeights(row)[k];
    for (double difference : local) largest = std::max(largest, std::abs(difference));
  }
  return largest;
}

TEST(CoarseGrainLimits, SmallWidthsTendToTheLocalMap) {
  const fem::SolidMesh mesh = unitBlock();
  const double coarse = distanceFromLocalMap(carriedSkin(mesh, {"", 1e-2}));
  const double fine = distanceFromLocalMap(carriedSkin(mesh, {"", 1e-4}));
  EXPECT_LT(coarse, 1e-2);
  EXPECT_GT(coarse, 1e-4);
  EXPECT_NEAR(fine / coarse, 1e-2, 1e-4);
}

/// The block with its top bent to a hump of slopes up to one half: one curved patch.
fem::SolidMesh humpedBlock() {
  fem::SolidMesh mesh = unitBlock();
  for (Vec3& X : mesh.X) X.z += 0.4 * std::sin(0.9 * X.x) * std::cos(0.7 * X.y) * (X.z + 2.0) / 2.0;
  return mesh;
}

double positionError(const fem::SolidMesh& mesh, const Skin& skin) {
  std::vector<Vec3> mapped(skin.X.size());
  cg::apply(skin.carrier, mesh.X, mapped);
  double largest = 0.0;
  for (std::size_t v = 0; v < mapped.size(); ++v) largest = std::max(largest, norm(mapped[v] - skin.X[v]));
  return largest;
}

TEST(CoarseGrainCorrection, LinearRestoresPositions) {
  for (const fem::SolidMesh& mesh : {unitBlock(), humpedBlock()})
    for (auto shape : {cg::KernelShape::lucy, cg::KernelShape::gauss})
      for (double width : {0.3, 1.3, 6.0}) {
        const Skin linear = carriedSkin(mesh, {"", width, shape, cg::KernelCorrection::linear});
        EXPECT_LE(positionError(mesh, linear), 1e-10) << "width " << width;
        EXPECT_LE(cg::rowSumError(linear.carrier), 1e-13);
        const Skin plain = carriedSkin(mesh, {"", width, shape});
        EXPECT_GT(positionError(mesh, plain), 0.1 * std::min(width, 1.0)) << "width " << width;
      }
}

TEST(CoarseGrainCorrection, RefusesABadWidthAndLeavesTheSkin) {
  const fem::SolidMesh mesh = unitBlock();
  Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  const auto vertices = skin.X.size();
  EXPECT_THROW(coarseGrain(skin, {{cg::KernelShape::lucy, 2, -1.0}, {}}), InputError);
  EXPECT_THROW(coarseGrain(skin, {{cg::KernelShape::lucy, 2, std::nan("")}, {}}), InputError);
  EXPECT_THROW(coarseGrain(skin, {{cg::KernelShape::lucy, 2, std::numeric_limits<double>::infinity()}, {}}),
               InputError);
  EXPECT_EQ(skin.X.size(), vertices);
}

}  // namespace
}  // namespace dovetail::surface
