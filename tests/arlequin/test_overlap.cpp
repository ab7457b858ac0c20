#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

/// A lattice of particles off the faces of the elements, and bricks of 0.5 m.
Overlap overlapAt(const Vec3& origin) {
  const fem::SolidMesh box = fem::boxOf(fem::ElementShape::hex8, {2, 6, 2}, {}, {1, 3, 1});
  fem::SolidMesh mesh = box;
  std::mt19937 random(3);
  for (Vec3& X : mesh.X) X += origin + randomVector(random, 0.05);
  dem::Particles particles;
  for (int i = 0; i < 2000; ++i)
    dem::addParticle(particles, origin + Vec3{0.5, 1.5, 0.5} + randomVector(random, 1.3), {}, 0.05, dem::Mass{1.0});
  std::vector<double> weight;
  for (const Vec3& X : mesh.X) weight.push_back(0.3 + 0.1 * (X.y - origin.y));
  return locateOverlap(particles, mesh, nodesAt(mesh.X), weight, 0.2);
}

TEST(Overlap, IsTheSameFarFromTheOrigin) {
  const Overlap near = overlapAt({});
  for (const double sizes : {3e2, 1e3, 1e4, 1e6}) {
    const Overlap far = overlapAt(edge * sizes * Vec3{0.3, 1.0, -0.7});
    ASSERT_EQ(far.particle, near.particle) << sizes;
    EXPECT_EQ(far.elements, near.elements) << sizes;
    EXPECT_EQ(far.stray, near.stray) << sizes;
    for (std::size_t k = 0; k < near.size(); ++k) {
      EXPECT_EQ(far.place[k].element, near.place[k].element) << sizes;
      EXPECT_NEAR(far.weight[k], near.weight[k], 1e-15 * (10.0 + sizes));
    }
  }
}

TEST(Overlap, OfALongBarDoesNotDependOnWhereItsOriginIs) {
  SceneOptions options;
  options.particlesPerEdge = 3;
  options.particleElements = 304, options.solidElements = 8;
  const Bar far = makeBar(options);
  options.particleElements = 5;
  const Bar near = makeBar(options);
  const Overlap &a = far.overlap, &b = near.overlap;
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.elements, b.elements);
  const int shift = a.particle[0] - b.particle[0];
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a.particle[k] - shift, b.particle[k]);
    EXPECT_EQ(a.place[k].element, b.place[k].element);
    EXPECT_NEAR(a.weight[k], b.weight[k], 1e-12);
  }
}

/// Particles in the quadrant that an L leaves out lie in the box of the overlap and in no element.
TEST(Overlap, NamesParticlesInItsBoxThatNoElementHolds) {
  const Still s = makeL(2);
  std::vector<int> expected;
  for (std::size_t i = 0; i < s.particles.size(); ++i)
    if (s.particles.x[i].x > 2 * edge && s.particles.x[i].y > 2 * edge) expected.push_back(static_cast<int>(i));
  ASSERT_EQ(expected.size(), 64u);
  EXPECT_EQ(s.overlap.stray, expected);
  for (const int i : s.overlap.particle) EXPECT_FALSE(std::ranges::binary_search(expected, i));
}

TEST(Overlap, WithoutParticlesElementsOrWidthItIsRefused) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {1, 4, 1}, {0, 0, 0}, {0.5, 2, 0.5});
  const fem::Nodes nodes = nodesAt(mesh.X);
  const std::vector<double> some(mesh.X.size(), 0.5), none(mesh.X.size(), 0.0), few(3, 0.5);
  const dem::Particles far = lattice({10, 10, 10}, {11, 11, 11}, 1), near = lattice({0, 0, 0}, {0.5, 1, 0.5}, 1);
  EXPECT_THROW(locateOverlap(far, mesh, nodes, some), InputError);
  EXPECT_THROW(locateOverlap(near, mesh, nodes, none), InputError);
  EXPECT_THROW(locateOverlap(near, mesh, nodes, few), InputError);
  EXPECT_NO_THROW(locateOverlap(near, mesh, nodes, some));
  SceneOptions narrow;
  narrow.overlapElements = 1;
  for (const double floor : {0.0, 1e-3, 0.1}) {
    narrow.weights.floor = floor;
    EXPECT_THROW(makeBar(narrow), InputError) << floor;
  }
}

}  // namespace
}  // namespace dovetail::arlequin
