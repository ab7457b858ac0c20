#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

struct Solid {
  Mesh mesh;
  ElementBlock block;
  Nodes nodes;
};

Solid makeSolid(Mesh mesh, ElementType type, double nu) {
  Solid solid{mesh, makeElements(mesh, type, StVenantKirchhoff{1.0e8, nu, 1309.0}), makeNodes(mesh)};
  addLumpedMass(solid.block, solid.nodes);
  return solid;
}

/// Largest speed over the first after many explicit steps from small random velocities.
double growth(Solid& solid, double dt) {
  setRandom(solid.nodes.v, 1e-9, 5);
  for (std::size_t n = 0; n < solid.nodes.v.size(); ++n)
    if (solid.nodes.fixed[n]) solid.nodes.v[n] = {};
  const double first = std::sqrt(kineticEnergy(solid.nodes));
  double largest = 0.0;
  for (int step = 0; step < 400; ++step) {
    drift(solid.nodes, dt);
    clearForces(solid.nodes);
    addInternalForces(solid.block, solid.nodes);
    kick(solid.nodes, dt);
    largest = std::max(largest, std::sqrt(kineticEnergy(solid.nodes)));
  }
  return largest / first;
}

TEST(StableStep, IsElementSizeOverWaveSpeedForCubesWithoutPoissonEffect) {
  const Solid beam = makeSolid(boxMesh({2, 30, 2}, {-0.4, 0.0, -0.4}, {0.4, 12.0, 0.4}), ElementType::hex8, 0.0);
  const double expected = 0.4 / std::sqrt(1.0e8 / 1309.0);
  EXPECT_NEAR(expected, 1.447e-3, 5e-7);
  EXPECT_NEAR(stableStep(beam.block).dt, expected, 1e-9 * expected);
}

TEST(StableStep, OneElementIsStableBelowAndUnstableAbove) {
  for (const ElementType type : bothTypes)
    for (const bool distorted : {false, true}) {
      Solid solid = makeSolid(testMesh({1, 1, 1}, distorted), type, 0.3);
      const double dt = stableStep(solid.block).dt;
      EXPECT_LT(growth(solid, 0.99 * dt), 100.0);
      solid.nodes = makeNodes(solid.mesh);
      addLumpedMass(solid.block, solid.nodes);
      EXPECT_GT(growth(solid, 1.01 * dt), 1e6);
    }
}

TEST(StableStep, NamesTheSmallestElement) {
  Mesh mesh = boxMesh({5, 1, 1}, {}, {5.0, 1.0, 1.0});
  for (Vec3& X : mesh.X)
    if (X.x == 3.0) X.x = 2.6;
  EXPECT_EQ(stableStep(makeSolid(mesh, ElementType::hex8, 0.2).block).element, 2);
}

TEST(StableStep, AssembledLimitIsNotBelowTheElementsAndIsTheRealOne) {
  for (const ElementType type : bothTypes) {
    Solid solid = makeSolid(testMesh({3, 3, 2}, true), type, 0.3);
    fix(solid.nodes, nodeSet(solid.mesh, "z-"));
    const double assembled = assembledStableStep(solid.block, solid.nodes, 1e-6);
    EXPECT_GT(assembled, stableStep(solid.block).dt);
    const Nodes rest = solid.nodes;
    EXPECT_LT(growth(solid, 0.99 * assembled), 100.0);
    solid.nodes = rest;
    EXPECT_GT(growth(solid, 1.01 * assembled), 1e6);
  }
}

TEST(StableStep, MissingMassIsRefused) {
  Solid solid = makeSolid(testMesh({1, 1, 1}, false), ElementType::hex8, 0.3);
  solid.nodes.mass[3] = 0.0;
  EXPECT_THROW(assembledStableStep(solid.block, solid.nodes), InputError);
}

}  // namespace
}  // namespace dovetail::fem
