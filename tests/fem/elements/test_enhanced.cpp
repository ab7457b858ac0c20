// The modes of the enhanced brick: a state of their own that lasts over steps.
#include <gtest/gtest.h>

#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

using MaterialPointer = std::shared_ptr<const PointMaterial>;

struct Law {
  std::string name;
  MaterialPointer material;
};
std::vector<Law> laws() {
  return {{"neo-Hookean", pointMaterial(neoHookean(1e6, 0.3, 1000.0))},
          {"hardly compressible", pointMaterial(neoHookean(1e6, 0.49, 1000.0))},
          {"plastic", pointMaterial(J2Plasticity{1e6, 0.3, 1000.0, linearYield(2e4, 1e5)})},
          {"soil", pointMaterial(DruckerPrager{1e6, 0.3, 1000.0, 1e5, 0.3, 0.1})}};
}

struct Brick {
  Model model;
  std::shared_ptr<Solid> solid;
  Nodes& nodes() { return model.nodes; }
  std::vector<Vec3> forces() { return forcesOf(*solid, model.nodes); }
  std::vector<double> tangent() {
    const linalg::BlockMatrix K = tangentOf(*solid, model.nodes);
    return {K.values().begin(), K.values().end()};
  }
};
Brick brick(const MaterialPointer& material) {
  const SolidMesh mesh = testSolidMesh(ElementShape::hex8, true);
  Brick b{makeModel(mesh), makeSolid(mesh, material, {.formulation = Formulation::enhanced})};
  b.model.add(b.solid);
  return b;
}

/// Bending and compression, and some noise.
void deform(Nodes& nodes, double amplitude, unsigned seed = 3) {
  setRandom(nodes.u, 0.05 * std::abs(amplitude), seed);
  for (std::size_t n = 0; n < nodes.X.size(); ++n) {
    const Vec3& X = nodes.X[n];
    nodes.u[n] += amplitude * Vec3{X.x * X.z, 0.3 * X.y, -0.5 * X.z - 0.5 * X.x * X.x};
  }
}

TEST(EnhancedBrick, ForcesAreTheSameWhateverWasAskedBetween) {
  for (const Law& law : laws()) {
    SCOPED_TRACE(law.name);
    Brick b = brick(law.material);
    deform(b.nodes(), 0.1);
    b.solid->commit(b.nodes(), {});
    deform(b.nodes(), 0.15);
    const std::vector<Vec3> here = b.nodes().u, f = b.forces();
    const std::vector<double> K = b.tangent();
    const double energy = b.solid->energy(b.nodes(), {});
    deform(b.nodes(), -0.2, 5);
    b.forces();
    b.tangent();
    b.solid->energy(b.nodes(), {});
    b.solid->revert();
    b.nodes().u = here;
    EXPECT_EQ(b.solid->energy(b.nodes(), {}), energy);
    EXPECT_EQ(b.forces(), f);
    EXPECT_EQ(b.forces(), f);
    EXPECT_EQ(b.tangent(), K);
  }
}

TEST(EnhancedBrick, CommitsTheModesOfTheAcceptedState) {
  for (const Law& law : laws()) {
    SCOPED_TRACE(law.name);
    Brick b = brick(law.material), other = brick(law.material);
    deform(b.nodes(), 0.1);
    b.forces();
    b.solid->commit(b.nodes(), {});
    deform(other.nodes(), -0.1, 7);
    other.forces();  // not accepted
    deform(other.nodes(), 0.1);
    other.solid->commit(other.nodes(), {});
    for (Brick* each : {&b, &other}) deform(each->nodes(), 0.12);
    EXPECT_EQ(b.forces(), other.forces());
  }
}

TEST(EnhancedBrick, GoesOnFromACheckpointWithTheSameDigits) {
  for (const Law& law : laws()) {
    SCOPED_TRACE(law.name);
    Brick b = brick(law.material), restored = brick(law.material);
    deform(b.nodes(), 0.2);
    b.solid->commit(b.nodes(), {});
    deform(b.nodes(), 0.1, 5);
    b.forces();  // not accepted
    ByteWriter archive;
    b.solid->save(archive);
    ByteReader reader(archive.bytes());
    restored.solid->load(reader);
    deform(b.nodes(), 0.22);
    restored.nodes().u = b.nodes().u;
    EXPECT_EQ(b.forces(), restored.forces());
  }
}

TEST(EnhancedBrick, FindsInOneStepTheModesOfManySmallOnes) {
  for (const double nu : {0.3, 0.49}) {
    const MaterialPointer material = pointMaterial(neoHookean(1e6, nu, 1000.0));
    Brick once = brick(material), slowly = brick(material);
    constexpr int steps = 50;
    for (int step = 1; step <= steps; ++step) {
      deform(slowly.nodes(), 0.4 * step / steps);
      slowly.solid->commit(slowly.nodes(), {});
    }
    deform(once.nodes(), 0.4);
    const std::vector<Vec3> f = once.forces(), expected = slowly.forces();
    double largest = 0.0, error = 0.0;
    for (std::size_t n = 0; n < f.size(); ++n) {
      largest = std::max(largest, norm(expected[n]));
      const double apart = norm(f[n] - expected[n]);
      if (!(apart <= error)) error = apart;
    }
    ASSERT_GT(largest, 0.0);
    EXPECT_LT(error, 1e-8 * largest) << nu;
  }
}

}  // namespace
}  // namespace dovetail::fem
