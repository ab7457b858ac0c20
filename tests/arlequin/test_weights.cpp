#include <gtest/gtest.h>

#include <cmath>

#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;
constexpr std::array profiles = {WeightProfile::halfCosine, WeightProfile::linear, WeightProfile::smooth};

TEST(Weights, ProfilesFallFromOneToZeroWithTheStatedSlope) {
  for (const WeightProfile shape : profiles) {
    EXPECT_EQ(profile(shape, -0.1), 1.0);
    EXPECT_EQ(profile(shape, 1.1), 0.0);
    EXPECT_NEAR(profile(shape, 0.5), 0.5, 1e-15);
    for (double s = 0.05; s < 1.0; s += 0.09) {
      EXPECT_NEAR(profile(shape, s) + profile(shape, 1.0 - s), 1.0, 1e-14);
      EXPECT_NEAR(profileSlope(shape, s), (profile(shape, s + 1e-6) - profile(shape, s - 1e-6)) / 2e-6, 1e-8);
    }
  }
}

TEST(Weights, TheFloorHoldsWithinTheOverlapOnly) {
  const std::vector<double> s{0.0, 0.5, 1.0, beyondOverlap};
  const std::vector<double> w = nodalWeights(s, {WeightProfile::halfCosine, 0.1});
  EXPECT_DOUBLE_EQ(w[0], 0.9);
  EXPECT_DOUBLE_EQ(w[1], 0.5);
  EXPECT_DOUBLE_EQ(w[2], 0.1);
  EXPECT_EQ(w[3], 0.0);
}

TEST(Weights, BadFloorsAndPlacesAreRefused) {
  const std::vector<double> s{0.5}, nan{std::nan("")};
  for (const double floor : {-0.1, 0.5, std::nan("")})
    EXPECT_THROW(nodalWeights(s, {WeightProfile::linear, floor}), InputError);
  EXPECT_THROW(nodalWeights(nan, {}), InputError);
}

/// Places of a bar between y = 0 and 3 by both ways.
TEST(Weights, OnABarDistanceAndLaplaceAgreeWithTheStraightLine) {
  const fem::SolidMesh box = fem::boxOf(fem::ElementShape::hex8, {2, 6, 2}, {0, 0, 0}, {1, 3, 1});
  const fem::SolidMesh& mesh = box;
  const auto solid = triangles(box.X, fem::faceSet(box, "y-")), particles = triangles(box.X, fem::faceSet(box, "y+"));
  const std::vector<double> byDistance = distanceCoordinate(mesh.X, solid, particles);
  std::vector<int> all(mesh.elementCount());
  for (std::size_t e = 0; e < all.size(); ++e) all[e] = static_cast<int>(e);
  const std::vector<double> byLaplace = laplaceCoordinate(mesh, all, fem::nodeSet(box, "y-"), fem::nodeSet(box, "y+"));
  for (std::size_t n = 0; n < mesh.X.size(); ++n) {
    EXPECT_NEAR(byDistance[n], mesh.X[n].y / 3.0, 1e-14);
    EXPECT_NEAR(byLaplace[n], mesh.X[n].y / 3.0, 1e-12);
  }
}

TEST(Weights, LaplaceOnPartOfAMeshMarksTheRestAsBeyond) {
  const fem::SolidMesh box = fem::boxOf(fem::ElementShape::hex8, {1, 4, 1}, {0, 0, 0}, {1, 4, 1});
  const fem::SolidMesh& mesh = box;
  std::vector<int> middle;
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (mesh.X[n].y == 2.0) middle.push_back(static_cast<int>(n));
  const std::vector<double> s = laplaceCoordinate(mesh, std::vector<int>{0, 1}, fem::nodeSet(box, "y-"), middle);
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    EXPECT_NEAR(s[n], mesh.X[n].y > 2.0 ? beyondOverlap : mesh.X[n].y / 2.0, 1e-12);
}

TEST(Weights, BordersThatAreMissingOrMeetAreRefused) {
  const fem::SolidMesh box = fem::boxOf(fem::ElementShape::hex8, {1, 1, 1}, {0, 0, 0}, {1, 1, 1});
  const fem::SolidMesh& mesh = box;
  const auto face = triangles(box.X, fem::faceSet(box, "y-")), side = triangles(box.X, fem::faceSet(box, "x-"));
  EXPECT_THROW(distanceCoordinate(mesh.X, face, {}), InputError);
  EXPECT_THROW(distanceCoordinate(mesh.X, face, side), InputError);
  EXPECT_THROW(laplaceCoordinate(mesh, std::vector<int>{0}, fem::nodeSet(box, "y-"), fem::nodeSet(box, "x-")),
               InputError);
}

const geometry::Box inner{{0, 0, 0}, {2, 2, 2}};

TEST(Weights, BetweenBoxesTheyGoStraightAcrossEverySide) {
  const geometry::Box outer{{-1, -2, -4}, {4, 3, 2.5}};
  const std::vector<Vec3> points{{-0.5, 1, 1}, {1, -0.5, 1}, {1, 1, -1},    {3, 1, 1}, {1, 2.75, 1},
                                 {1, 1, 2.25}, {-1, 1, 1},   {-0.5, -2, 1}, {0, 0, 0}, {1, 1, 5}};
  const std::vector<double> s = boxCoordinate(points, inner, outer);
  const std::vector<double> expected{0.5, 0.25, 0.25, 0.5, 0.75, 0.5, 1.0, 1.0, 0.0, 6.0};
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_NEAR(s[k], expected[k], 1e-15) << k;
  EXPECT_LT(boxCoordinate(std::vector<Vec3>{{1, 1, 1}}, inner, outer)[0], 0.0);
}

TEST(Weights, BoxesOpenOnAllSidesButOneAreTwoPlanes) {
  const geometry::Box around{{0, 0, -1}, {2, 2, 2}};
  for (double z = -1.5; z < 2.0; z += 0.25)
    EXPECT_NEAR(boxCoordinate(std::vector<Vec3>{{0.3, 2.0, z}}, inner, around)[0], -z, 1e-15);
}

TEST(Weights, BoxesThatDoNotContainEachOtherAreRefused) {
  const std::vector<Vec3> point{{1, 1, 1}}, outside{{1, 1, 2.1}};
  EXPECT_THROW(boxCoordinate(point, inner, inner), InputError);
  EXPECT_THROW(boxCoordinate(point, inner, {{-1, -1, 0.5}, {3, 3, 3}}), InputError);
  EXPECT_THROW(boxCoordinate(point, inner, {{-1, -1, std::nan("")}, {3, 3, 3}}), InputError);
  EXPECT_THROW(boxCoordinate(outside, inner, {{-1, -1, -1}, {3, 3, 2}}), InputError);  // beyond an open side
  EXPECT_NO_THROW(boxCoordinate(outside, inner, {{-1, -1, -1}, {3, 3, 3}}));
}

TEST(Weights, ModelsShareEveryPointExactly) {
  const Still s = makeL(2);
  const std::vector<double> solid = solidWeights(s.weight);
  for (std::size_t k = 0; k < s.overlap.size(); ++k) {
    double there = 0.0;
    for (std::size_t a = 0; a < 8; ++a)
      there += s.overlap.place[k].shape[a] *
               solid[static_cast<std::size_t>(cellOf(s.mesh, s.overlap.place[k].element).node[a])];
    EXPECT_NEAR(s.overlap.weight[k] + there, 1.0, 1e-14);
  }
}

TEST(Weights, MassIsShared) {
  SceneOptions o;
  const Bar model = makeBar(o);
  double mass = 0.0;
  for (const double m : model.particles.mass) mass += m;
  for (const double m : model.nodes().mass) mass += m;
  const double length = (o.particleElements - o.overlapElements + o.solidElements) * edge;
  EXPECT_NEAR(mass, bulk * length * edge * edge * o.across * o.across, 1e-3 * mass);
}

}  // namespace
}  // namespace dovetail::arlequin
