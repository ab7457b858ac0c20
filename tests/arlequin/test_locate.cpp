#include <gtest/gtest.h>

#include "dovetail/arlequin/locate.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/shape.hpp"
#include "scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

TEST(Locate, FindsRandomPointsOfCrookedBricks) {
  const Still s = makeCrooked(11);
  const ElementLocator locator(s.mesh.elements, s.mesh.X);
  std::mt19937 random(2);
  for (int trial = 0; trial < 500; ++trial) {
    const Vec3 xi = randomVector(random, 1.0);
    const auto e = static_cast<std::size_t>(trial) % s.mesh.elements.size();
    const auto psi = fem::shapeValues(xi);
    Vec3 x;
    for (std::size_t a = 0; a < 8; ++a) x += psi[a] * s.mesh.X[static_cast<std::size_t>(s.mesh.elements[e][a])];
    const auto place = locator.find(x);
    ASSERT_TRUE(place);
    Vec3 back;
    for (std::size_t a = 0; a < 8; ++a)
      back += place->shape[a] *
              s.mesh.X[static_cast<std::size_t>(s.mesh.elements[static_cast<std::size_t>(place->element)][a])];
    EXPECT_LT(norm(back - x), 1e-12);
  }
}

TEST(Locate, APointOnAFaceHasOneOwnerTheLowest) {
  const Bricks mesh = bricksOf(fem::boxOf(fem::CellShape::hex8, {2, 2, 2}, {0, 0, 0}, {2, 2, 2}));
  const ElementLocator locator(mesh.elements, mesh.X);
  EXPECT_EQ(locator.find({1, 1, 1})->element, 0);
  EXPECT_EQ(locator.find({1, 0.5, 0.5})->element, 0);
  EXPECT_EQ(locator.find({1.5, 1, 0.5})->element, 1);
  EXPECT_EQ(locator.find({2, 2, 2})->element, 7);
}

TEST(Locate, OutsideThereIsNothing) {
  const Bricks mesh = bricksOf(fem::boxOf(fem::CellShape::hex8, {2, 2, 2}, {0, 0, 0}, {2, 2, 2}));
  const ElementLocator locator(mesh.elements, mesh.X);
  EXPECT_FALSE(locator.find({2.0001, 1, 1}));
  EXPECT_FALSE(locator.find({1, -1e-6, 1}));
  EXPECT_FALSE(locator.find({1e9, 0, 0}));
}

TEST(Locate, MissingElementsAndNodesAreRefused) {
  const Bricks mesh = bricksOf(fem::boxOf(fem::CellShape::hex8, {1, 1, 1}, {0, 0, 0}, {1, 1, 1}));
  EXPECT_THROW(ElementLocator({}, mesh.X), InputError);
  EXPECT_THROW(ElementLocator(mesh.elements, std::span(mesh.X).first(4)), InputError);
}

TEST(Overlap, WithoutParticlesElementsOrWidthItIsRefused) {
  const Bricks mesh = bricksOf(fem::boxOf(fem::CellShape::hex8, {1, 4, 1}, {0, 0, 0}, {0.5, 2, 0.5}));
  const fem::Nodes nodes = nodesAt(mesh.X);
  const std::vector<double> some(mesh.X.size(), 0.5), none(mesh.X.size(), 0.0), few(3, 0.5);
  const dem::Particles far = lattice({10, 10, 10}, {11, 11, 11}, 1), near = lattice({0, 0, 0}, {0.5, 1, 0.5}, 1);
  EXPECT_THROW(locateOverlap(far, mesh.elements, nodes, some), InputError);
  EXPECT_THROW(locateOverlap(near, mesh.elements, nodes, none), InputError);
  EXPECT_THROW(locateOverlap(near, mesh.elements, nodes, few), InputError);
  EXPECT_NO_THROW(locateOverlap(near, mesh.elements, nodes, some));
  SceneOptions narrow;
  narrow.overlapElements = 1;
  narrow.weights.floor = 0.0;
  EXPECT_THROW(makeBar(narrow), InputError);
}

TEST(Overlap, AParticleWithoutWeightIsNamed) {
  dem::Particles particles = lattice({0, 0, 0}, {0.5, 2, 0.5}, 1);
  const Bricks mesh = bricksOf(fem::boxOf(fem::CellShape::hex8, {1, 4, 1}, {0, 0, 0}, {0.5, 2, 0.5}));
  std::vector<double> weight(mesh.X.size(), 0.0);
  for (std::size_t n = 0; n < 4; ++n) weight[n] = 1.0;
  const std::vector<double> full = particles.mass;
  const Overlap overlap = locateOverlap(particles, mesh.elements, nodesAt(mesh.X), weight);
  try {
    weighMass(overlap, full, particles);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("particle 2"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace dovetail::arlequin
