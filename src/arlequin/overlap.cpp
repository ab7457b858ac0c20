#include "dovetail/arlequin/overlap.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"

namespace dovetail::arlequin {

namespace {

std::vector<Vec3> currentPositions(const fem::Nodes& nodes) {
  std::vector<Vec3> x(nodes.X.size());
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = nodes.X[n] + nodes.u[n];
  return x;
}

double weightAt(const fem::CellPlace& place, std::span<const std::array<int, 8>> elements,
                std::span<const double> nodal) {
  const auto& element = elements[static_cast<std::size_t>(place.element)];
  const double first = nodal[static_cast<std::size_t>(element[0])];
  double weight = first;  // exact where the nodes agree
  for (std::size_t a = 1; a < 8; ++a) weight += place.shape[a] * (nodal[static_cast<std::size_t>(element[a])] - first);
  return std::clamp(weight, 0.0, 1.0);
}

/// Around the nodes of elements with a weight above 0.
geometry::Box boxOfWeights(std::span<const std::array<int, 8>> elements, const fem::Nodes& nodes,
                           std::span<const double> weight) {
  constexpr double far = std::numeric_limits<double>::max();
  geometry::Box box{{far, far, far}, {-far, -far, -far}};
  for (const auto& element : elements) {
    const bool weighted =
        std::any_of(element.begin(), element.end(), [&](int n) { return weight[static_cast<std::size_t>(n)] > 0.0; });
    for (const int n : element)
      for (int c = 0; weighted && c < 3; ++c) {
        const double x = (nodes.X[static_cast<std::size_t>(n)] + nodes.u[static_cast<std::size_t>(n)])[c];
        box.lower[c] = std::min(box.lower[c], x);
        box.upper[c] = std::max(box.upper[c], x);
      }
  }
  return box;
}

bool contains(const geometry::Box& box, const Vec3& x) {
  for (int c = 0; c < 3; ++c)
    if (x[c] < box.lower[c] || x[c] > box.upper[c]) return false;
  return true;
}

void requireOverlap(const Overlap& overlap, std::span<const std::array<int, 8>> elements) {
  bool anyElement = false;
  for (const auto& element : elements)
    for (const int n : element) anyElement = anyElement || overlap.nodalWeight[static_cast<std::size_t>(n)] > 0.0;
  if (!anyElement)
    throw InputError("the overlap has no elements: no node has a weight above 0", "overlap",
                     "let the mesh reach into the particles");
  if (overlap.elements.empty())
    throw InputError("the overlap has no particles", "overlap", "let the particles reach into the mesh");
}

}  // namespace

Overlap locateOverlap(const dem::Particles& particles, std::span<const std::array<int, 8>> elements,
                      const fem::Nodes& nodes, std::span<const double> nodalWeight, double reach) {
  if (nodalWeight.size() != nodes.X.size())
    throw InputError(
        "there are " + std::to_string(nodalWeight.size()) + " weights for " + std::to_string(nodes.X.size()) + " nodes",
        "overlap", "give one per node");
  requireFinite(particles.x, "particle", "position", "search for the overlap");
  const fem::CellLocator locator = locatorOf(elements, currentPositions(nodes));
  Overlap overlap;
  overlap.nodalWeight.assign(nodalWeight.begin(), nodalWeight.end());
  const geometry::Box box = boxOfWeights(elements, nodes, nodalWeight), reached = geometry::expanded(box, reach);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto place = locator.find(particles.x[i]);
    if (!place && contains(box, particles.x[i])) overlap.stray.push_back(static_cast<int>(i));
    if (!place && (reach == 0.0 || !contains(reached, particles.x[i]))) continue;
    if (!place) {
      overlap.particle.push_back(static_cast<int>(i));
      overlap.place.emplace_back();
      overlap.weight.push_back(1.0);
      continue;
    }
    overlap.particle.push_back(static_cast<int>(i));
    overlap.place.push_back(*place);
    overlap.weight.push_back(weightAt(*place, elements, nodalWeight));
    if (overlap.weight.back() > 0.0) overlap.elements.push_back(place->element);
  }
  std::sort(overlap.elements.begin(), overlap.elements.end());
  overlap.elements.erase(std::unique(overlap.elements.begin(), overlap.elements.end()), overlap.elements.end());
  requireOverlap(overlap, elements);
  return overlap;
}

std::vector<double> particleWeights(const Overlap& overlap, std::size_t particles) {
  std::vector<double> weight(particles, 1.0);
  for (std::size_t k = 0; k < overlap.size(); ++k)
    weight[static_cast<std::size_t>(overlap.particle[k])] = overlap.weight[k];
  return weight;
}

void weighMass(const Overlap& overlap, std::span<const double> fullMass, dem::Particles& particles) {
  const std::vector<double> weight = particleWeights(overlap, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!(weight[i] > 0.0))
      throw InputError("the weight of particle " + std::to_string(i) + " is 0, it would be without mass", "overlap",
                       "give a weight floor above 0, or remove particles beyond the overlap");
    particles.mass[i] = weight[i] * fullMass[i];
  }
}

void weighContacts(const dem::Particles& particles, std::span<const std::array<int, 8>> elements,
                   const fem::Nodes& nodes, const Overlap& overlap, dem::PairList& pairs) {
  const fem::CellLocator locator = locatorOf(elements, currentPositions(nodes));
  std::vector<bool> inside(particles.size(), false);
  for (const int i : overlap.particle) inside[static_cast<std::size_t>(i)] = true;
  const std::span<double> factors = pairs.writeFactors();
  std::fill(factors.begin(), factors.end(), 1.0);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto i = static_cast<std::size_t>(pairs.pairs()[p][0]), j = static_cast<std::size_t>(pairs.pairs()[p][1]);
    if (!inside[i] && !inside[j]) continue;
    const Vec3 middle = particles.x[i] + dem::pairContact(particles, i, j).armI;
    if (const auto place = locator.find(middle)) factors[p] = weightAt(*place, elements, overlap.nodalWeight);
  }
}

std::vector<double> solidWeights(std::span<const double> nodalWeight) {
  std::vector<double> solid(nodalWeight.size());
  for (std::size_t n = 0; n < solid.size(); ++n) solid[n] = 1.0 - nodalWeight[n];
  return solid;
}

cg::Projection interpolationAtParticles(const Overlap& overlap, std::span<const std::array<int, 8>> elements,
                                        std::size_t nodes) {
  std::vector<cg::ProjectionRow> rows(overlap.size());
  for (std::size_t k = 0; k < overlap.size(); ++k) {
    const fem::CellPlace& place = overlap.place[k];
    if (place.element < 0)
      throw InputError("particle " + std::to_string(overlap.particle[k]) + " is outside of the mesh",
                       "interpolationAtParticles", "locate the overlap without a reach");
    for (std::size_t a = 0; a < 8; ++a)
      rows[k].emplace_back(elements[static_cast<std::size_t>(place.element)][a], place.shape[a]);
  }
  return cg::fromRows(static_cast<int>(nodes), rows);
}

}  // namespace dovetail::arlequin
