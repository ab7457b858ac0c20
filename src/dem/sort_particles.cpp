// Near in number means near in space.
#include <algorithm>
#include <numeric>

#include "dovetail/dem/pairs.hpp"

namespace dovetail::dem {

namespace {

template <class T>
void permute(std::vector<T>& values, std::span<const int> order) {
  if (values.empty()) return;
  std::vector<T> sorted;
  sorted.reserve(values.size());
  for (const int old : order) sorted.push_back(values[static_cast<std::size_t>(old)]);
  values = std::move(sorted);
}

/// Bits of a 21-bit number spread to every third place.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

/// Numbers of the particles along a space-filling curve (Morton's) through cells of about the smallest diameter.
std::vector<int> curveOrder(const Particles& particles) {
  Vec3 lower = particles.x[0], upper = lower;
  for (const Vec3& x : particles.x) {
    lower = {std::min(lower.x, x.x), std::min(lower.y, x.y), std::min(lower.z, x.z)};
    upper = {std::max(upper.x, x.x), std::max(upper.y, x.y), std::max(upper.z, x.z)};
  }
  const double smallest = 2.0 * *std::min_element(particles.radius.begin(), particles.radius.end());
  const Vec3 extent = upper - lower;
  constexpr double cells = 1 << 21;
  const double edge = std::max(smallest, std::max({extent.x, extent.y, extent.z}) / (cells - 1.0));
  std::vector<std::uint64_t> key(particles.size());
  for (std::size_t i = 0; i < key.size(); ++i) {
    const Vec3 d = (particles.x[i] - lower) / edge;
    key[i] = spread(static_cast<std::uint64_t>(d.x)) | spread(static_cast<std::uint64_t>(d.y)) << 1 |
             spread(static_cast<std::uint64_t>(d.z)) << 2;
  }
  std::vector<int> order(particles.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return key[static_cast<std::size_t>(a)] < key[static_cast<std::size_t>(b)]; });
  return order;
}

}  // namespace

std::vector<int> sortParticles(Particles& particles, PairList& list) {
  if (particles.size() == 0) return {};
  if (particles.id.empty()) {
    particles.id.resize(particles.size());
    std::iota(particles.id.begin(), particles.id.end(), std::int64_t{0});
  }
  const std::vector<int> order = curveOrder(particles);
  permute(particles.x, order);
  permute(particles.v, order);
  permute(particles.f, order);
  permute(particles.radius, order);
  permute(particles.mass, order);
  permute(particles.omega, order);
  permute(particles.torque, order);
  permute(particles.material, order);
  permute(particles.id, order);
  std::vector<int> newNumber(order.size());
  for (std::size_t n = 0; n < order.size(); ++n) newNumber[static_cast<std::size_t>(order[n])] = static_cast<int>(n);
  if (list.builds > 0 && list.positionAtBuild.size() == particles.size()) {
    renumber(list, newNumber);
    findPairs(particles, list.skin, list);
  }
  return newNumber;
}

}  // namespace dovetail::dem
