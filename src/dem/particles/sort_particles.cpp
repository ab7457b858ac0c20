// Near in number means near in space.
#include "sort_particles.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "dovetail/core/distribute.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::dem::detail {

namespace {

constexpr std::size_t chunkSize = 8192;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Extent {
  Vec3 lower{infinity, infinity, infinity}, upper{-infinity, -infinity, -infinity};
  double diameters = 0.0;
  Extent& operator+=(const Extent& b) {
    lower = {std::min(lower.x, b.lower.x), std::min(lower.y, b.lower.y), std::min(lower.z, b.lower.z)};
    upper = {std::max(upper.x, b.upper.x), std::max(upper.y, b.upper.y), std::max(upper.z, b.upper.z)};
    diameters += b.diameters;
    return *this;
  }
};

Extent extentOf(const Particles& particles) {
  return parallelSum(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    Extent part;
    for (std::size_t i = begin; i < end; ++i) part += Extent{particles.x[i], particles.x[i], 2.0 * particles.radius[i]};
    return part;
  });
}

/// Place on Hilbert's curve through a cube of 2^bits cells along each edge (Skilling, AIP Conf. Proc. 707, 2004).
std::uint64_t placeOnCurve(std::array<std::uint32_t, 3> cell, int bits) {
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
    for (std::size_t k = 0; k < 3; ++k) {
      if (cell[k] & q) {
        cell[0] ^= q - 1;
      } else {
        const std::uint32_t swap = (cell[0] ^ cell[k]) & (q - 1);
        cell[0] ^= swap;
        cell[k] ^= swap;
      }
    }
  cell[1] ^= cell[0];
  cell[2] ^= cell[1];
  std::uint32_t flip = 0;
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
    if (cell[2] & q) flip ^= q - 1;
  std::uint64_t place = 0;
  for (int b = bits - 1; b >= 0; --b)
    for (std::size_t k = 0; k < 3; ++k) place = place << 1 | ((cell[k] ^ flip) >> b & 1u);
  return place;
}

/// Bricks of some particles in which the order of the grid is kept.
struct Bricks {
  Vec3 lower;
  double perEdge = 0.0;
  int bits = 1;

  explicit Bricks(const Particles& particles) {
    constexpr double edgeInDiameters = 4.0;
    constexpr int mostBits = 20;
    const Extent extent = extentOf(particles);
    const Vec3 size = extent.upper - extent.lower;
    const double longest = std::max({size.x, size.y, size.z});
    double edge = edgeInDiameters * extent.diameters / static_cast<double>(particles.size());
    while (bits < mostBits && !(longest < edge * (1 << bits))) ++bits;
    edge = std::max(edge, longest / ((1 << bits) - 1));
    lower = extent.lower;
    perEdge = 1.0 / edge;
  }
  std::uint64_t placeOf(const Vec3& x) const {
    std::array<std::uint32_t, 3> cell{};
    for (int k = 0; k < 3; ++k)
      cell[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>((x[k] - lower[k]) * perEdge);
    return placeOnCurve(cell, bits);
  }
};

struct Placed {
  std::uint64_t place;
  int number;
};

}  // namespace

std::vector<int> numbersAlongCurve(const Particles& particles, std::span<const int> order) {
  const Bricks bricks(particles);
  const std::size_t n = particles.size(), tasks = (n + chunkSize - 1) / chunkSize;
  const int rangeBits = std::min(9, 3 * bricks.bits), shift = 3 * bricks.bits - rangeBits;
  RawVector<std::uint64_t> places(n);  // in the given order
  const auto eachOf = [&](std::size_t task, auto&& act) {
    for (std::size_t s = task * chunkSize; s < std::min(n, (task + 1) * chunkSize); ++s) act(s);
  };
  const auto findPlaces = [&](std::size_t task, auto&& sink) {
    eachOf(task, [&](std::size_t s) {
      places[s] = bricks.placeOf(particles.x[static_cast<std::size_t>(order[s])]);
      sink(static_cast<std::size_t>(places[s] >> shift));
    });
  };
  auto sorted = distribute<Placed>(tasks, std::size_t{1} << rangeBits, findPlaces, [&](std::size_t task, auto&& sink) {
    eachOf(task, [&](std::size_t s) {
      sink(static_cast<std::size_t>(places[s] >> shift), Placed{places[s], order[s]});
    });
  });
  std::vector<int> newNumber(n);
  parallelFor(sorted.count(), 1, [&](std::size_t range, std::size_t) {
    const auto placed = sorted[range];
    std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.place < b.place; });
    for (std::size_t k = 0; k < placed.size(); ++k)
      newNumber[static_cast<std::size_t>(placed[k].number)] = static_cast<int>(sorted.begin[range] + k);
  });
  return newNumber;
}

}  // namespace dovetail::dem::detail
