#include "pair_weights.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t chunkSize = 256;
constexpr std::size_t largestCell = 27;  // nodes

auto order(const PairWeight& pair) { return std::tuple(pair.i, pair.j); }

/// ∇w at a member, 1/m, of the mesh as it is now.
Vec3 weightGradient(const fem::SolidMesh& mesh, const Overlap& overlap, std::size_t member,
                    std::span<const Vec3> position) {
  const fem::CellPlace& place = overlap.place[member];
  const Cell cell = cellOf(mesh, place.element);
  const Vec3 xi = fem::nearestInParent(cell.shape, place.xi);
  std::array<double, largestCell> value;
  std::array<Vec3, largestCell> gradient;
  fem::shapeFunctions(cell.shape, xi, std::span(value).first(cell.node.size()),
                      std::span(gradient).first(cell.node.size()));
  std::array<Vec3, 3> J{};  // column j = ∂x/∂ξ_j
  for (std::size_t a = 0; a < cell.node.size(); ++a)
    for (std::size_t j = 0; j < 3; ++j)
      J[j] += gradient[a][static_cast<int>(j)] * position[static_cast<std::size_t>(cell.node[a])];
  const std::span<const int> corner = cell.corner();
  const fem::ElementShape first = corner.size() == 8 ? fem::ElementShape::hex8 : fem::ElementShape::tet4;
  fem::shapeFunctions(first, xi, std::span(value).first(corner.size()), std::span(gradient).first(corner.size()));
  Vec3 byParent;
  for (std::size_t a = 0; a < corner.size(); ++a)
    byParent += overlap.nodalWeight[static_cast<std::size_t>(corner[a])] * gradient[a];
  const Vec3 dual = byParent.x * cross(J[1], J[2]) + byParent.y * cross(J[2], J[0]) + byParent.z * cross(J[0], J[1]);
  return dual / dot(J[0], cross(J[1], J[2]));
}

/// Of a pair with a particle of another overlap: the mean of both weights as they are now. Both overlaps write it, and
/// agree whoever is the last; neither remembers it.
bool isBetweenOverlaps(const dem::Particles& particles, const PairWeight& pair, std::span<const int> memberOf) {
  const auto isOthers = [&](int i) {
    return memberOf[static_cast<std::size_t>(i)] < 0 && particles.weightOf(static_cast<std::size_t>(i)) != 1.0;
  };
  return isOthers(pair.i) || isOthers(pair.j);
}
double meanFraction(const dem::Particles& particles, const PairWeight& pair) {
  return 0.5 *
         (particles.weightOf(static_cast<std::size_t>(pair.i)) + particles.weightOf(static_cast<std::size_t>(pair.j)));
}

/// w where two particles touch, from what each of them knows of w about itself.
double weightAt(const dem::Particles& particles, const dem::PairList& list, std::size_t pair, const Overlap& overlap,
                std::span<const Vec3> gradient, std::span<const int> memberOf) {
  const auto i = static_cast<std::size_t>(list.pairs()[pair][0]), j = static_cast<std::size_t>(list.pairs()[pair][1]);
  const dem::PairContact contact = dem::pairContact(particles, i, j, list.shift(pair));
  double sum = 0.0, sides = 0.0, least = 1.0;
  for (const auto& [particle, arm] : {std::pair(i, contact.armI), std::pair(j, contact.armJ)}) {
    const int member = memberOf[particle];
    if (member < 0 || overlap.place[static_cast<std::size_t>(member)].element < 0) continue;
    const auto k = static_cast<std::size_t>(member);
    sum += overlap.weight[k] + dot(gradient[k], arm);
    least = std::min(least, overlap.weight[k]);
    sides += 1.0;
  }
  return sides == 0.0 ? 1.0 : std::clamp(sum / sides, 0.5 * least, 1.0);
}

}  // namespace

void PairWeights::update(const dem::Particles& particles, dem::PairList& list, const fem::SolidMesh& mesh,
                         const Overlap& overlap, std::span<const Vec3> position, std::span<const int> memberOf) {
  std::vector<std::size_t> place;
  for (std::size_t p = 0; p < list.size(); ++p)
    if (const auto& [i, j] = list.pairs()[p];
        memberOf[static_cast<std::size_t>(i)] >= 0 || memberOf[static_cast<std::size_t>(j)] >= 0)
      place.push_back(p);
  std::vector<PairWeight> now(place.size());
  std::vector<char> isNew(place.size(), 0), isAsked(overlap.size(), 0);
  parallelFor(place.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      PairWeight& pair = now[k] = {list.pairs()[place[k]][0], list.pairs()[place[k]][1], 0.0};
      const auto known = std::ranges::lower_bound(pairs, order(pair), {}, order);
      isNew[k] = known == pairs.end() || order(*known) != order(pair);
      if (!isNew[k]) pair.weight = known->weight;
      if (!isBetweenOverlaps(particles, pair, memberOf)) continue;
      isNew[k] = 0;
      pair.weight = meanFraction(particles, pair);
    }
  });
  for (std::size_t k = 0; k < now.size(); ++k)
    for (const int i : {now[k].i, now[k].j})
      if (const int member = memberOf[static_cast<std::size_t>(i)]; isNew[k] && member >= 0)
        isAsked[static_cast<std::size_t>(member)] = overlap.place[static_cast<std::size_t>(member)].element >= 0;
  std::vector<Vec3> gradient(overlap.size());
  parallelFor(gradient.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (isAsked[k]) gradient[k] = weightGradient(mesh, overlap, k, position);
  });
  const std::span<double> factors = list.writeFactors();
  parallelFor(place.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (isNew[k]) now[k].weight = weightAt(particles, list, place[k], overlap, gradient, memberOf);
      if (double& factor = factors[place[k]]; factor != 0.0) factor = now[k].weight;
    }
  });
  pairs = std::move(now);
}

void PairWeights::forget(std::span<const char> isMoved) {
  std::erase_if(pairs, [&](const PairWeight& pair) {
    return isMoved[static_cast<std::size_t>(pair.i)] || isMoved[static_cast<std::size_t>(pair.j)];
  });
}

void PairWeights::renumber(std::span<const int> newNumber) {
  for (PairWeight& pair : pairs) {
    const int i = newNumber[static_cast<std::size_t>(pair.i)], j = newNumber[static_cast<std::size_t>(pair.j)];
    pair.i = std::min(i, j), pair.j = std::max(i, j);
  }
  std::erase_if(pairs, [](const PairWeight& pair) { return pair.i < 0; });
  if (!std::ranges::is_sorted(pairs, {}, order)) std::ranges::sort(pairs, {}, order);
}

}  // namespace dovetail::arlequin
