#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/blended_mass.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

const StVenantKirchhoff material{1e6, 0.0, 1000.0};

struct Scene {
  Mesh mesh;
  ElementBlock block;
  Nodes nodes;
};

Scene scene(bool held) {
  Mesh mesh = testMesh({2, 3, 2}, true);
  ElementBlock block = makeElements(mesh, ElementType::hex8, material);
  Nodes nodes = makeNodes(mesh);
  addLumpedMass(block, nodes);
  if (held) {
    fix(nodes, nodeSet(mesh, "y+"));
    fix(nodes, nodeSet(mesh, "x-"), componentX);
  }
  return {std::move(mesh), std::move(block), std::move(nodes)};
}

TEST(BlendedMass, SolvesWhatItMultiplies) {
  for (const bool held : {false, true})
    for (const double share : {0.0, 0.4, 1.0}) {
      const Scene s = scene(held);
      const BlendedMass mass(s.block, s.nodes, share);
      std::vector<Vec3> a(s.nodes.X.size());
      setRandom(a, 1.0, 7);
      for (std::size_t n = 0; n < a.size(); ++n)
        for (int c = 0; c < 3; ++c)
          if (s.nodes.fixed[n] >> c & 1) a[n][c] = 0.0;
      std::vector<Vec3> f = mass.multiply(a);
      const std::vector<Vec3> force = f;
      mass.solve(f);
      for (std::size_t n = 0; n < a.size(); ++n) EXPECT_LT(norm(f[n] - a[n]), 1e-12);
      // Supports: M a − f at held components, here with f = M a everywhere.
      EXPECT_LT(norm(mass.supportForce(a, force)), 1e-9);
    }
}

TEST(BlendedMass, RowSumsAreTheLumpedMasses) {
  const Scene s = scene(false);
  const BlendedMass mass(s.block, s.nodes, 0.7);
  const std::vector<Vec3> ones(s.nodes.X.size(), Vec3{1.0, 2.0, 3.0});
  const std::vector<Vec3> sums = mass.multiply(ones);
  for (std::size_t n = 0; n < sums.size(); ++n)
    EXPECT_LT(norm(sums[n] - s.nodes.mass[n] * ones[n]), 1e-11 * s.nodes.mass[n]);
  double total = 0.0;
  for (const double m : s.nodes.mass) total += m;
  EXPECT_NEAR(mass.kineticEnergy(ones), 0.5 * total * 14.0, 1e-9 * total);
}

TEST(BlendedMass, MomentumChangesByLoadAndSupportForce) {
  const Scene s = scene(true);
  const BlendedMass mass(s.block, s.nodes, 0.5);
  std::vector<Vec3> f(s.nodes.X.size());
  setRandom(f, 1.0, 9);
  std::vector<Vec3> a = f;
  mass.solve(a);
  Vec3 change, load;
  for (std::size_t n = 0; n < a.size(); ++n) {
    change += s.nodes.mass[n] * a[n];
    load += f[n];
  }
  EXPECT_LT(norm(change - load - mass.supportForce(a, f)), 1e-10);
}

/// ω/(ck) of a standing wave of a bar of n bricks per wave length with M = share · consistent + …
double phaseRatio(double share, int perWave) {
  const double h = 0.1;
  const Mesh mesh = boxMesh({1, perWave, 1}, {0, 0, 0}, {h, perWave * h, h});
  const ElementBlock block = makeElements(mesh, ElementType::hex8, material);
  Nodes nodes = makeNodes(mesh);
  addLumpedMass(block, nodes);
  const BlendedMass mass(block, nodes, share);
  const double k = 2.0 * std::numbers::pi / (perWave * h);
  for (std::size_t n = 0; n < nodes.u.size(); ++n) nodes.u[n].y = 1e-9 * std::cos(k * nodes.X[n].y);
  const double elastic = strainEnergy(block, nodes), inertia = mass.kineticEnergy(nodes.u);
  return std::sqrt(elastic / inertia) / (k * std::sqrt(material.youngsModulus / material.density));
}

TEST(BlendedMass, TheMatchedShareGivesTheDispersionOfAChain) {
  for (const int n : {1, 2, 3, 4})
    for (const int perWave : {12, 24}) {
      const double h = 0.1, d = h / n, k = 2.0 * std::numbers::pi / (perWave * h);
      const double chain = std::sin(0.5 * k * d) / (0.5 * k * d);
      const double error = std::abs(phaseRatio(matchedShare(d, h), perWave) - chain);
      EXPECT_LT(error, 0.2 * std::pow(k * h, 4)) << n;
      if (n > 1) {
        EXPECT_LT(error, 0.2 * std::abs(phaseRatio(0.0, perWave) - chain));
      }
    }
}

TEST(BlendedMass, ImpossibleInputIsRefused) {
  const Scene s = scene(false);
  EXPECT_THROW(BlendedMass(s.block, s.nodes, -0.1), InputError);
  EXPECT_THROW(BlendedMass(s.block, s.nodes, 1.1), InputError);
  Nodes massless = s.nodes;
  massless.mass[3] = 0.0;
  EXPECT_THROW(BlendedMass(s.block, massless, 0.5), InputError);
  EXPECT_THROW(matchedShare(2.0, 1.0), InputError);
  EXPECT_THROW(matchedShare(0.1, 0.0), InputError);
}

}  // namespace
}  // namespace dovetail::fem
