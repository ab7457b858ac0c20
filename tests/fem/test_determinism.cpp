#include <gtest/gtest.h>

#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/motion/newmark.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

struct Result {
  std::vector<Vec3> f;
  double energy;
  std::vector<double> energies;
  friend bool operator==(const Result&, const Result&) = default;
};

Result evaluate(const Mesh& mesh, ElementType type, int threadCount) {
  setThreads(threadCount);
  const ElementBlock block = makeElements(mesh, type, StVenantKirchhoff{1.0e6, 0.3, 1.0});
  Nodes nodes = makeNodes(mesh);
  setRandom(nodes.u, 0.01, 3);
  setRandom(nodes.f, 1.0, 4);
  Result result;
  result.energy = addInternalForces(block, nodes, true);
  result.f = nodes.f;
  result.energies = elementEnergies(block, nodes);
  setThreads(1);
  return result;
}

TEST(Determinism, ForcesAreBitwiseEqualForAnyNumberOfThreads) {
  for (const ElementType type : bothTypes)
    for (const bool distorted : {false, true}) {
      const Mesh mesh = testMesh({12, 13, 15}, distorted);  // 2340 elements: above the threshold for threads
      const Result one = evaluate(mesh, type, 1);
      EXPECT_TRUE(one == evaluate(mesh, type, 2));
      EXPECT_TRUE(one == evaluate(mesh, type, 3));
    }
}

TEST(Determinism, ImplicitStepsAreBitwiseEqualForAnyNumberOfThreads) {
  const auto run = [](int threadCount) {
    setThreads(threadCount);
    const Mesh mesh = testMesh({12, 13, 15}, false);
    const ElementBlock block = makeElements(mesh, ElementType::hex8, StVenantKirchhoff{1.0e6, 0.3, 1000.0});
    Nodes nodes = makeNodes(mesh);
    addLumpedMass(block, nodes);
    fix(nodes, nodeSet(mesh, "z-"));
    std::vector<Vec3> load(nodes.X.size());
    setRandom(load, 5.0, 6);
    NewmarkSolver solver(block, nodes, 5e-3);
    solver.step(nodes, load);
    solver.step(nodes, load);
    setThreads(1);
    return nodes.u;
  };
  const std::vector<Vec3> one = run(1);
  EXPECT_GT(flat(one).norm(), 0.0);
  EXPECT_TRUE(one == run(2));
}

}  // namespace
}  // namespace dovetail::fem
