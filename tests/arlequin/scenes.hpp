// Small overlaps of particles and bricks: a bar, an L, and a block of crooked bricks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "dovetail/arlequin/stepper.hpp"
#include "dovetail/arlequin/weights.hpp"

namespace dovetail::arlequin::test {

inline constexpr double modulus = 1e6, bulk = 1000.0, edge = 0.5;  // Pa, kg/m³, m (of an element)

inline Vec3 randomVector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> d(-size, size);
  return {d(random), d(random), d(random)};
}

/// Cubic lattice of spacing edge/n in the box, masses of the bulk density.
inline dem::Particles lattice(Vec3 lower, Vec3 upper, int n) {
  const double d = edge / n;
  dem::Particles particles;
  const auto count = [&](int c) { return static_cast<int>(std::lround((upper[c] - lower[c]) / d)); };
  for (int j = 0; j < count(1); ++j)
    for (int k = 0; k < count(2); ++k)
      for (int i = 0; i < count(0); ++i)
        dem::addParticle(particles, lower + d * Vec3{i + 0.5, j + 0.5, k + 0.5}, {}, 0.5 * d,
                         dem::Mass{bulk * d * d * d});
  return particles;
}

struct SceneOptions {
  int particlesPerEdge = 2, across = 2;
  int particleElements = 5, overlapElements = 4, solidElements = 6;  // along y
  WeightOptions weights{WeightProfile::halfCosine, 1e-3};
  CouplingOptions coupling;
  double massShare = 0.0;  // of the consistent mass
  bool holdEnd = true;
};

/// Bar along y: particles from 0 to particleElements · edge, the solid from there minus the overlap.
inline double solidStart(const SceneOptions& o) { return (o.particleElements - o.overlapElements) * edge; }
inline double particleEnd(const SceneOptions& o) { return o.particleElements * edge; }

inline std::vector<double> barWeights(const fem::Mesh& mesh, const SceneOptions& o) {
  std::vector<double> s;
  for (const Vec3& X : mesh.X) {
    const double place = (X.y - solidStart(o)) / (o.overlapElements * edge);
    s.push_back(place > 1.0 + 1e-9 ? beyondOverlap : std::clamp(place, 0.0, 1.0));
  }
  return nodalWeights(s, o.weights);
}

inline Solid makeSolid(fem::Mesh mesh, std::span<const double> weight, const SceneOptions& o) {
  fem::Nodes nodes = fem::makeNodes(mesh);
  if (o.holdEnd) fem::fix(nodes, fem::nodeSet(mesh, "y+"));
  fem::ElementBlock elements =
      fem::makeElements(mesh, fem::ElementType::hex8, fem::StVenantKirchhoff{modulus, 0.0, bulk}, solidWeights(weight));
  fem::addLumpedMass(elements, nodes);
  Solid solid{std::move(mesh), std::move(nodes), std::move(elements), std::nullopt, {}, {}, {}};
  if (o.massShare > 0.0) solid.mass.emplace(solid.elements, solid.nodes, o.massShare);
  return solid;
}

inline Model makeBar(const SceneOptions& o) {
  const double half = 0.5 * o.across * edge, d = edge / o.particlesPerEdge;
  Model model;
  model.discrete.particles = lattice({-half, 0.0, -half}, {half, particleEnd(o), half}, o.particlesPerEdge);
  model.discrete.pairs.setSkin(0.1 * d);
  dem::findPairs(model.discrete.particles, model.discrete.pairs);
  dem::ElasticLaw law;
  law.normal.stiffness = modulus * d;
  law.normal.bonded = true;
  model.discrete.laws = dem::makeContactLaws(law);
  model.discrete.sortEvery = 0;
  model.discrete.refusesUnstableSteps = false;  // criticalStep knows the whole
  fem::Mesh mesh = fem::boxMesh({o.across, o.solidElements, o.across}, {-half, solidStart(o), -half},
                                {half, solidStart(o) + o.solidElements * edge, half});
  const std::vector<double> weight = barWeights(mesh, o);
  model.solid.emplace(makeSolid(std::move(mesh), weight, o));
  CouplingOptions coupling = o.coupling;
  coupling.contactStiffness = modulus * d;
  model.coupling.emplace(makeCoupling(model.discrete.particles, model.discrete.pairs, *model.solid, weight, coupling));
  return model;
}

/// An overlap without contacts or motion: mesh, particles within it, weights.
struct Still {
  fem::Mesh mesh;
  fem::Nodes nodes;
  dem::Particles particles;
  std::vector<double> weight;
  Overlap overlap;
};

inline Still locate(fem::Mesh mesh, dem::Particles particles, std::vector<double> weight) {
  Still still{std::move(mesh), {}, std::move(particles), std::move(weight), {}};
  still.nodes = fem::makeNodes(still.mesh);
  still.overlap = locateOverlap(still.particles, still.mesh.elements, still.nodes, still.weight);
  return still;
}

/// 4 × 4 × 2 bricks without those of one quadrant; particles reach in from the two legs' inner half.
inline Still makeL(int n) {
  fem::Mesh mesh = fem::boxMesh({4, 4, 2}, {0.0, 0.0, 0.0}, {4 * edge, 4 * edge, 2 * edge});
  std::erase_if(mesh.elements, [&](const std::array<int, 8>& e) {
    const Vec3& corner = mesh.X[static_cast<std::size_t>(e[0])];
    return corner.x >= 2 * edge - 1e-9 && corner.y >= 2 * edge - 1e-9;
  });
  dem::Particles particles = lattice({0.0, 0.0, 0.0}, {4 * edge, 4 * edge, 2 * edge}, n);
  std::vector<double> weight;
  for (const Vec3& X : mesh.X) weight.push_back(0.1 + 0.8 * profile(WeightProfile::smooth, std::hypot(X.x, X.y) / 3.0));
  return locate(std::move(mesh), std::move(particles), std::move(weight));
}

/// Bricks whose inner nodes are moved at random, particles at random.
inline Still makeCrooked(unsigned seed) {
  std::mt19937 random(seed);
  fem::Mesh mesh = fem::boxMesh({3, 3, 3}, {0.0, 0.0, 0.0}, {3 * edge, 3 * edge, 3 * edge});
  std::vector<bool> outer(mesh.X.size(), false);
  for (const int n : fem::nodeSet(mesh, "skin")) outer[static_cast<std::size_t>(n)] = true;
  for (std::size_t n = 0; n < mesh.X.size(); ++n)
    if (!outer[n]) mesh.X[n] += randomVector(random, 0.15 * edge);
  dem::Particles particles;
  for (int i = 0; i < 400; ++i)
    dem::addParticle(particles, Vec3{0.75, 0.75, 0.75} + randomVector(random, 0.75), {}, 0.05 + 0.001 * (i % 50),
                     dem::Density{bulk});
  std::vector<double> weight;
  for (const Vec3& X : mesh.X) weight.push_back(1.0 - 0.3 * X.x);
  return locate(std::move(mesh), std::move(particles), std::move(weight));
}

}  // namespace dovetail::arlequin::test
