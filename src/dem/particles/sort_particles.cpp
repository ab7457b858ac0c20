// Near in number means near in space.
#include <algorithm>
#include <array>
#include <numeric>

#include "dovetail/dem/pairs/pairs.hpp"

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

/// Numbers of the particles in the order of cells about as large as a mean particle, row by row, layer by layer. Layers
/// lie across the longest axis, so that as few particles as possible lie between neighbours.
std::vector<int> layerOrder(const Particles& particles) {
  Vec3 lower = particles.x[0], upper = lower;
  double sum = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const Vec3& x = particles.x[i];
    lower = {std::min(lower.x, x.x), std::min(lower.y, x.y), std::min(lower.z, x.z)};
    upper = {std::max(upper.x, x.x), std::max(upper.y, x.y), std::max(upper.z, x.z)};
    sum += particles.radius[i];
  }
  const Vec3 extent = upper - lower;
  std::array<int, 3> axis{0, 1, 2};
  std::stable_sort(axis.begin(), axis.end(), [&](int a, int b) { return extent[a] < extent[b]; });
  constexpr double mostCells = 1 << 20;
  const double edge = std::max(2.0 * sum / static_cast<double>(particles.size()), extent[axis[2]] / mostCells);
  std::vector<std::uint64_t> key(particles.size(), 0);
  for (std::size_t i = 0; i < key.size(); ++i)
    for (int k = 2; k >= 0; --k) {
      const int a = axis[static_cast<std::size_t>(k)];
      key[i] = key[i] << 21 | static_cast<std::uint64_t>((particles.x[i][a] - lower[a]) / edge);
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
  const std::vector<int> order = layerOrder(particles);
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
