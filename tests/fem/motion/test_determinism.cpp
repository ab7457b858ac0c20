// Hand-written kernels give the same digits on any number of threads. (test_solid.cpp: all other formulations.)
#include <gtest/gtest.h>

#include "dovetail/fem/motion/implicit_motion.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

/// 2340 bricks: above the threshold for threads.
constexpr std::array counts{12, 13, 15};
const StVenantKirchhoff material{1.0e6, 0.3, 1000.0};

auto evaluate(const SolidMesh& mesh, Formulation formulation, const std::vector<double>& fraction) {
  SolidScene scene =
      sceneOf(mesh, pointMaterial(Material(material)), {.formulation = formulation, .fraction = fraction});
  Nodes& nodes = scene.model.nodes;
  setRandom(nodes.u, 0.01, 3);
  setRandom(nodes.f, 1.0, 4);
  const double together = scene.solid->addForcesAndEnergy(nodes, {}, nodes.f);
  return std::tuple(nodes.f, together, scene.solid->energy(nodes, {}), scene.solid->elementEnergies(nodes, {}));
}

TEST(Determinism, ForcesAreBitwiseEqualForAnyNumberOfThreads) {
  for (const Formulation formulation : brickFormulations)
    for (const bool distorted : {false, true}) {
      const SolidMesh mesh = testMesh(counts, distorted);
      std::vector<double> fraction;
      if (distorted)
        for (const Vec3& X : mesh.X) fraction.push_back(0.5 + 0.4 * X.x);
      const auto compute = [&] { return evaluate(mesh, formulation, fraction); };
      const auto one = onThreads(1, compute);
      EXPECT_EQ(std::get<1>(one), std::get<2>(one));
      EXPECT_TRUE(one == onThreads(2, compute));
      EXPECT_TRUE(one == onThreads(3, compute));
    }
}

/// A clamped body under constant forces, by explicit and implicit steps.
std::vector<Vec3> moved(bool implicit) {
  const SolidMesh mesh = testMesh(counts, false);
  Model model = sceneOf(mesh, Formulation::standard, material).model;
  addMass(model);
  fix(model.nodes, nodeSet(mesh, "z-"));
  std::vector<Vec3> load(mesh.X.size());
  setRandom(load, 5.0, 6);
  if (implicit) {
    ImplicitMotion motion(model, {.scheme = newmark(), .massFraction = 0.4});
    for (int i = 0; i < 2; ++i) {
      motion.kick(load, 2.5e-3);
      motion.step(5e-3);
      motion.kick(load, 2.5e-3);
    }
    return model.nodes.u;
  }
  Motion motion(model, 0.4);
  for (int i = 0; i < 5; ++i) {
    motion.forces(1e-4);
    for (std::size_t n = 0; n < load.size(); ++n) model.nodes.f[n] += load[n];
    motion.kick(1e-4);
    motion.drift(1e-4);
  }
  return model.nodes.u;
}

TEST(Determinism, StepsAreBitwiseEqualForAnyNumberOfThreads) {
  for (const bool implicit : {false, true}) {
    const std::vector<Vec3> one = onThreads(1, [&] { return moved(implicit); });
    EXPECT_GT(flat(one).norm(), 0.0);
    EXPECT_TRUE(one == onThreads(2, [&] { return moved(implicit); }));
  }
}

}  // namespace
}  // namespace dovetail::fem
