// Small overlaps of particles and bricks: a bar, an L, and a block of crooked bricks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "dovetail/arlequin/coupling_options.hpp"
#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/model/model.hpp"

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
  double massFraction = 0.0;  // of the consistent mass
  bool holdEnd = true;
};

/// Bar along y: particles from 0 to particleElements · edge, the solid from there minus the overlap.
inline double solidStart(const SceneOptions& o) { return (o.particleElements - o.overlapElements) * edge; }
inline double particleEnd(const SceneOptions& o) { return o.particleElements * edge; }

inline fem::SolidMesh barMesh(const SceneOptions& o) {
  const double half = 0.5 * o.across * edge;
  return fem::boxOf(fem::ElementShape::hex8, {o.across, o.solidElements, o.across}, {-half, solidStart(o), -half},
                    {half, solidStart(o) + o.solidElements * edge, half});
}

inline std::vector<double> barWeights(const fem::SolidMesh& mesh, const SceneOptions& o) {
  std::vector<double> s;
  for (const Vec3& X : mesh.X) {
    const double place = (X.y - solidStart(o)) / (o.overlapElements * edge);
    s.push_back(place > 1.0 + 1e-9 ? beyondOverlap : std::clamp(place, 0.0, 1.0));
  }
  return nodalWeights(s, o.weights);
}

/// An overlap without contacts or motion: mesh, particles within it, weights.
struct Still {
  fem::SolidMesh mesh;
  fem::Nodes nodes;
  dem::Particles particles;
  std::vector<double> weight;
  Overlap overlap;
};

/// Nodes at rest at the given places.
inline fem::Nodes nodesAt(const std::vector<Vec3>& X) {
  fem::SolidMesh points;
  points.X = X;
  return std::move(fem::makeModel(points).nodes);
}

inline Still locate(fem::SolidMesh mesh, dem::Particles particles, std::vector<double> weight) {
  Still still{std::move(mesh), {}, std::move(particles), std::move(weight), {}};
  still.nodes = nodesAt(still.mesh.X);
  still.overlap = locateOverlap(still.particles, still.mesh, still.nodes, still.weight);
  return still;
}

/// 4 × 4 × 2 bricks without those of one quadrant; particles reach in from the two legs' inner half.
inline Still makeL(int n) {
  fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {4, 4, 2}, {0.0, 0.0, 0.0}, {4 * edge, 4 * edge, 2 * edge});
  std::vector<int> kept;
  for (int e = 0; e < static_cast<int>(mesh.elementCount()); ++e) {
    const std::span<const int> node = cellOf(mesh, e).node;
    const Vec3& corner = mesh.X[static_cast<std::size_t>(node[0])];
    if (corner.x < 2 * edge - 1e-9 || corner.y < 2 * edge - 1e-9) kept.insert(kept.end(), node.begin(), node.end());
  }
  mesh.groups[0].node = std::move(kept);
  dem::Particles particles = lattice({0.0, 0.0, 0.0}, {4 * edge, 4 * edge, 2 * edge}, n);
  std::vector<double> weight;
  for (const Vec3& X : mesh.X) weight.push_back(0.1 + 0.8 * profile(WeightProfile::smooth, std::hypot(X.x, X.y) / 3.0));
  return locate(std::move(mesh), std::move(particles), std::move(weight));
}

/// Bricks whose inner nodes are moved at random, particles at random.
inline Still makeCrooked(unsigned seed) {
  std::mt19937 random(seed);
  const fem::SolidMesh box =
      fem::boxOf(fem::ElementShape::hex8, {3, 3, 3}, {0.0, 0.0, 0.0}, {3 * edge, 3 * edge, 3 * edge});
  fem::SolidMesh mesh = box;
  std::vector<bool> outer(mesh.X.size(), false);
  for (const int n : fem::nodeSet(box, "skin")) outer[static_cast<std::size_t>(n)] = true;
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
