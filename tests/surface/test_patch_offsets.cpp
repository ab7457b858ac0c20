// Skins that kernels carry, on bodies that turn.
#include <gtest/gtest.h>

#include <algorithm>

#include "carried_points.hpp"
#include "scenes.hpp"

namespace dovetail::surface {
namespace {

const Quaternion quarter = fromRotationVector({0.5 * std::numbers::pi, 0, 0});
const Quaternion half = fromRotationVector(std::numbers::pi / std::sqrt(3.0) * Vec3{1, 1, 1});
const Quaternion skew = fromRotationVector({0.3, -1.1, 2.0});

/// 8 × 2 × 1, whose long faces are slender.
fem::SolidMesh bar() { return fem::boxOf(fem::ElementShape::hex8, {8, 2, 1}, {0, 0, -1}, {8, 2, 0}); }

/// u of the nodes when the deformed body is turned and moved.
std::vector<Vec3> turned(const fem::SolidMesh& mesh, std::span<const Vec3> u, const Quaternion& turn,
                         const Vec3& shift) {
  std::vector<Vec3> all;
  for (std::size_t i = 0; i < u.size(); ++i) all.push_back(rotate(turn, mesh.X[i] + u[i]) + shift - mesh.X[i]);
  return all;
}

class PatchOffsetsOf : public ::testing::TestWithParam<Variant> {};

TEST_P(PatchOffsetsOf, ATurnedBodyHasTheTurnedSkin) {
  for (const fem::SolidMesh& mesh : {unitBlock(), bar()}) {
    Random random(3);
    const std::vector<Vec3> u = random.field(mesh.X.size(), 0.1), rest(u.size());
    Skin skin = carriedSkin(mesh, GetParam());
    SmoothSurface smooth = makeSmoothSurface(skin);
    std::vector<int> all(smooth.X.size());
    for (std::size_t c = 0; c < all.size(); ++c) all[c] = static_cast<int>(c);
    place(skin, u, rest);
    place(smooth, u, rest, all);
    const std::vector<Vec3> before = skin.wall.x, smoothBefore = smooth.x;
    for (const Quaternion& turn : {quarter, half, skew})
      for (double far : {0.0, 1e3}) {
        const Vec3 shift = far * Vec3{1.0, -0.7, 0.4};
        const std::vector<Vec3> moved = turned(mesh, u, turn, shift);
        place(skin, moved, rest);
        place(smooth, moved, rest, all);
        double worst = 0.0;
        for (std::size_t v = 0; v < before.size(); ++v)
          worst = std::max(worst, norm(skin.wall.x[v] - rotate(turn, before[v]) - shift));
        for (std::size_t c = 0; c < smoothBefore.size(); ++c)
          worst = std::max(worst, norm(smooth.x[c] - rotate(turn, smoothBefore[c]) - shift));
        EXPECT_LT(worst, 1e-13 * (100.0 + 10.0 * far)) << far;
      }
  }
}

TEST_P(PatchOffsetsOf, VelocitiesAreTheDerivativeAndLoadsItsTranspose) {
  const fem::SolidMesh mesh = bar();
  Random random(4);
  const std::vector<Vec3> u = turned(mesh, random.field(mesh.X.size(), 0.1), skew, {}),
                          v = random.field(mesh.X.size(), 1.0);
  Skin skin = carriedSkin(mesh, GetParam());
  const double h = 1e-5;
  const auto placedAt = [&](double t) {
    std::vector<Vec3> moved = u;
    for (std::size_t i = 0; i < u.size(); ++i) moved[i] += t * v[i];
    place(skin, moved, v);
    return skin.wall.x;
  };
  const std::vector<Vec3> ahead = placedAt(h), behind = placedAt(-h);
  placedAt(0.0);
  coupling::NodalLoad onPoints(skin.X.size()), load(mesh.X.size());
  double atPoints = 0.0, atNodes = 0.0, size = 0.0;
  Vec3 force, moment;
  for (std::size_t p = 0; p < skin.X.size(); ++p) {
    EXPECT_LT(norm((ahead[p] - behind[p]) / (2.0 * h) - skin.wall.v[p]), 1e-8);
    onPoints.add(static_cast<int>(p), random.vector(1.0));
    atPoints += dot(onPoints.force[p], skin.wall.v[p]);
    force += onPoints.force[p];
    moment += cross(skin.wall.x[p], onPoints.force[p]);
    size += norm(onPoints.force[p]) * norm(skin.wall.x[p]);
  }
  addLoadOfPoints(skin.carrier, skin.offsets, onPoints, load);
  for (std::size_t i = 0; i < mesh.X.size(); ++i) {
    atNodes += dot(load.force[i], v[i]);
    force -= load.force[i];
    moment -= cross(mesh.X[i] + u[i], load.force[i]);
  }
  EXPECT_NEAR(atPoints, atNodes, 1e-12 * size);
  EXPECT_LT(norm(force), 1e-12 * size);
  EXPECT_LT(norm(moment), 1e-11 * size);
}

INSTANTIATE_TEST_SUITE_P(Variants, PatchOffsetsOf, ::testing::ValuesIn(flatVariants()), VariantName{});

/// Along a bar the kernel keeps places by itself, and an even load still arrives evenly across.
TEST(SlenderPatches, KeepPlacesLengthwiseAndEvenLoadsEvenAcross) {
  const fem::SolidMesh mesh = bar();
  for (double width : {1.5, 4.0, 12.0}) {
    const Skin skin = carriedSkin(mesh, {"", width, cg::KernelShape::lucy, cg::KernelCorrection::symmetric});
    ASSERT_FALSE(skin.offsets.empty());
    double lengthwise = 0.0, across = 0.0;
    coupling::NodalLoad even(skin.X.size()), load(mesh.X.size());
    for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) {
      const auto& [a, b, c] = skin.wall.facets[t];
      const Vec3 area = cross(skin.X[b] - skin.X[a], skin.X[c] - skin.X[a]);
      if (!(area.z > 1e-9)) continue;  // the top
      for (int v : {a, b, c}) {
        even.add(v, {0, 0, -area.z / 6.0});
        lengthwise = std::max(lengthwise, std::abs(skin.offsets.offset[v].x));
        across = std::max(across, std::abs(skin.offsets.offset[v].y));
      }
    }
    EXPECT_LT(lengthwise, 1e-12) << width;
    EXPECT_GT(across, 0.1) << width;
    addLoadOfPoints(skin.carrier, skin.offsets, even, load);
    for (std::size_t i = 0; i < mesh.X.size(); ++i)
      if (mesh.X[i].z == 0.0 && mesh.X[i].y == 1.0) {
        double row = 0.0, edges = 0.0;
        for (std::size_t j = 0; j < mesh.X.size(); ++j)
          if (mesh.X[j].z == 0.0 && mesh.X[j].x == mesh.X[i].x) (mesh.X[j].y == 1.0 ? row : edges) += load.force[j].z;
        EXPECT_NEAR(edges, row, 2e-3 * std::abs(row)) << width << " at " << mesh.X[i].x;
      }
  }
}

double volumeIn(const Skin& skin) {
  double volume = 0.0;
  for (const auto& [a, b, c] : skin.wall.facets)
    volume += dot(skin.wall.x[a], cross(skin.wall.x[b], skin.wall.x[c])) / 6.0;
  return volume;
}

TEST(PatchOffsets, ACubeUnderAHomogeneousGradientHasItsSkinThere) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {6, 6, 6}, {0, 0, 0}, {1, 1, 1});
  const std::array<std::array<Vec3, 3>, 4> gradients{
      {{Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 0.9}},
       {Vec3{1, 0, 0}, {0.2, 1, 0}, {0, 0, 1}},
       {rotate(skew, {1, 0, 0}), rotate(skew, {0, 1, 0}), rotate(skew, {0, 0, 1})},
       {Vec3{0.8, 0.1, -0.3}, {0.2, 1.1, 0.1}, {0.0, -0.2, 0.9}}}};
  const std::vector<Vec3> rest(mesh.X.size());
  for (const auto correction : {cg::KernelCorrection::none, cg::KernelCorrection::symmetric}) {
    cg::SurfaceKernel kernel = advisedKernel(mesh);
    kernel.correction = correction;
    Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
    coarseGrain(skin, kernel);
    ASSERT_FALSE(skin.offsets.empty());
    for (const auto& F : gradients) {
      const auto moved = [&](const Vec3& X) { return X.x * F[0] + X.y * F[1] + X.z * F[2]; };
      std::vector<Vec3> u;
      for (const Vec3& X : mesh.X) u.push_back(moved(X) - X);
      place(skin, u, rest);
      double worst = 0.0;
      for (std::size_t v = 0; v < skin.X.size(); ++v) worst = std::max(worst, norm(skin.wall.x[v] - moved(skin.X[v])));
      EXPECT_LT(worst, 5e-13);
      EXPECT_NEAR(volumeIn(skin), dot(F[0], cross(F[1], F[2])), 1e-12);
    }
  }
}

/// Where a patch is not flat, but nearly so, nodes move its vertices by no more. Heights below 1e-7 of it are nothing.
TEST(PatchOffsets, ADomeOfAnyHeightFollowsAHomogeneousGradient) {
  for (const double height : {1e-1, 1e-4, 1e-7, 1e-10, 0.0}) {
    fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {6, 6, 1}, {-1, -1, -1}, {1, 1, 0});
    for (Vec3& X : mesh.X)
      if (X.z == 0.0) X.z = height * (1.0 - X.x * X.x) * (1.0 - X.y * X.y);
    Skin skin = makeSkin(mesh.X, mesh.faceSets.at("z+"));
    coarseGrain(skin, {{.width = 0.8}, cg::KernelCorrection::symmetric});
    std::vector<Vec3> u, rest(mesh.X.size());
    for (const Vec3& X : mesh.X) u.push_back(Vec3{0.1 * X.z, -0.1 * X.y, 0.2 * X.x - 0.1 * X.z});
    place(skin, u, rest);
    double worst = 0.0;
    for (std::size_t v = 0; v < skin.X.size(); ++v) {
      const Vec3& X = skin.X[v];
      worst = std::max(worst, norm(skin.wall.x[v] - X - Vec3{0.1 * X.z, -0.1 * X.y, 0.2 * X.x - 0.1 * X.z}));
    }
    EXPECT_LT(worst, height > 1e-6 ? 1e-12 : 1e-8) << height;
    std::vector<double> inverseMass(mesh.X.size(), 1.0);
    EXPECT_LT(SurfaceCoupler(skin).largestMobility(inverseMass), 2.0) << height;
  }
}

/// A grain whose centre has sunk into a coarse-grained box comes out where it went in.
TEST(SplitSkins, StayClosed) {
  const fem::SolidMesh mesh = unitBlock();
  const std::vector<Vec3> rest(mesh.X.size());
  for (const Variant& variant : allVariants()) {
    SurfaceCoupler seam = makeSeam(mesh, variant);
    dem::Particles particles;
    dem::addParticle(particles, {1.6, 2.3, -0.02}, {}, 0.3, dem::Mass{1.0});
    const Response response = respond(seam, particles, rest, rest, *elasticLaws(1e4));
    EXPECT_NEAR(response.onParticles[0].z, 1e4 * 0.32, 1e-3 * 1e4) << variant.name;
    EXPECT_LT(std::hypot(response.onParticles[0].x, response.onParticles[0].y), 1.0) << variant.name;
  }
}

}  // namespace
}  // namespace dovetail::surface
