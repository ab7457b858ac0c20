#include "pair_shares.hpp"

#include <algorithm>
#include <array>
#include <tuple>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

namespace {

constexpr std::size_t grain = 256;

auto order(const PairShare& pair) { return std::tuple(pair.i, pair.j); }

/// ∇w at a member, 1/m, of the mesh as it is now.
Vec3 weightGradient(const fem::SolidMesh& mesh, const Overlap& overlap, std::size_t member,
                    std::span<const Vec3> position) {
  const fem::CellPlace& place = overlap.place[member];
  const Cell cell = cellOf(mesh, place.element);
  const Vec3 xi = fem::nearestInParent(cell.shape, place.xi);
  std::vector<double> value(cell.node.size());
  std::vector<Vec3> gradient(cell.node.size());
  fem::shapeFunctions(cell.shape, xi, value, gradient);
  std::array<Vec3, 3> J{};  // column j = ∂x/∂ξ_j
  for (std::size_t a = 0; a < cell.node.size(); ++a)
    for (std::size_t j = 0; j < 3; ++j)
      J[j] += gradient[a][static_cast<int>(j)] * position[static_cast<std::size_t>(cell.node[a])];
  const fem::CellShape first = cell.corner().size() == 8 ? fem::CellShape::hex8 : fem::CellShape::tet4;
  fem::shapeFunctions(first, xi, value, gradient);
  Vec3 byParent;
  for (std::size_t a = 0; a < cell.corner().size(); ++a)
    byParent += overlap.nodalWeight[static_cast<std::size_t>(cell.corner()[a])] * gradient[a];
  const Vec3 dual = byParent.x * cross(J[1], J[2]) + byParent.y * cross(J[2], J[0]) + byParent.z * cross(J[0], J[1]);
  return dual / dot(J[0], cross(J[1], J[2]));
}

/// w where two particles touch, from what each of them knows of w about itself.
double shareAt(const dem::Particles& particles, const dem::PairList& list, std::size_t pair, const fem::SolidMesh& mesh,
               const Overlap& overlap, std::span<const Vec3> position, std::span<const int> memberOf) {
  const auto i = static_cast<std::size_t>(list.pairs()[pair][0]), j = static_cast<std::size_t>(list.pairs()[pair][1]);
  const dem::PairContact contact = dem::pairContact(particles, i, j, list.shift(pair));
  double sum = 0.0, sides = 0.0, least = 1.0;
  for (const auto& [particle, arm] : {std::pair(i, contact.armI), std::pair(j, contact.armJ)}) {
    const int member = memberOf[particle];
    if (member < 0 || overlap.place[static_cast<std::size_t>(member)].element < 0) continue;
    const auto k = static_cast<std::size_t>(member);
    sum += overlap.weight[k] + dot(weightGradient(mesh, overlap, k, position), arm);
    least = std::min(least, overlap.weight[k]);
    sides += 1.0;
  }
  return sides == 0.0 ? 1.0 : std::clamp(sum / sides, 0.5 * least, 1.0);
}

}  // namespace

void PairShares::update(const dem::Particles& particles, dem::PairList& list, const fem::SolidMesh& mesh,
                        const Overlap& overlap, std::span<const Vec3> position, std::span<const int> memberOf) {
  std::vector<std::size_t> place;
  for (std::size_t p = 0; p < list.size(); ++p)
    if (const auto& [i, j] = list.pairs()[p];
        memberOf[static_cast<std::size_t>(i)] >= 0 || memberOf[static_cast<std::size_t>(j)] >= 0)
      place.push_back(p);
  std::vector<PairShare> now(place.size());
  const std::span<double> factors = list.writeFactors();
  parallelFor(place.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t p = place[k];
      PairShare& pair = now[k] = {list.pairs()[p][0], list.pairs()[p][1], 0.0};
      const auto known = std::ranges::lower_bound(pairs, order(pair), {}, order);
      const bool listed = known != pairs.end() && order(*known) == order(pair);
      pair.share = listed ? known->share : shareAt(particles, list, p, mesh, overlap, position, memberOf);
      if (factors[p] != 0.0) factors[p] = pair.share;
    }
  });
  pairs = std::move(now);
}

void PairShares::forget(std::span<const char> isMoved) {
  std::erase_if(pairs, [&](const PairShare& pair) {
    return isMoved[static_cast<std::size_t>(pair.i)] || isMoved[static_cast<std::size_t>(pair.j)];
  });
}

void PairShares::renumber(std::span<const int> newNumber) {
  for (PairShare& pair : pairs) {
    const int i = newNumber[static_cast<std::size_t>(pair.i)], j = newNumber[static_cast<std::size_t>(pair.j)];
    pair.i = std::min(i, j), pair.j = std::max(i, j);
  }
  std::erase_if(pairs, [](const PairShare& pair) { return pair.i < 0; });
  std::ranges::sort(pairs, {}, order);
}

}  // namespace dovetail::arlequin
