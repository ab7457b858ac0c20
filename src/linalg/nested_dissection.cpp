#include "dovetail/linalg/nested_dissection.hpp"

#include <algorithm>
#include <numeric>
#include <string>

namespace dovetail::linalg {

namespace {

constexpr std::size_t smallest = 200;  // sets that are not halved

/// Those that each unknown meets, itself too.
struct Neighbours {
  std::vector<int> offsets, unknown;

  explicit Neighbours(const SparseMatrix& A) : offsets(static_cast<std::size_t>(A.size) + 1, 0) {
    const auto eachEntry = [&](const auto& visit) {
      for (int c = 0; c < A.size; ++c)
        for (int k = A.offsets[c]; k < A.offsets[c + 1]; ++k) {
          visit(c, A.row[k]);
          if (A.row[k] != c) visit(A.row[k], c);
        }
    };
    eachEntry([&](int a, int) { ++offsets[a + 1]; });
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    unknown.resize(static_cast<std::size_t>(offsets.back()));
    std::vector<int> next = offsets;
    eachEntry([&](int a, int b) { unknown[next[a]++] = b; });
  }
  std::span<const int> of(int a) const { return std::span(unknown).subspan(offsets[a], offsets[a + 1] - offsets[a]); }
};

int longestSide(std::span<const int> set, std::span<const Vec3> point) {
  Vec3 lower = point[static_cast<std::size_t>(set[0])], upper = lower;
  for (const int a : set)
    for (int c = 0; c < 3; ++c) {
      lower[c] = std::min(lower[c], point[static_cast<std::size_t>(a)][c]);
      upper[c] = std::max(upper[c], point[static_cast<std::size_t>(a)][c]);
    }
  const Vec3 side = upper - lower;
  return side.x >= std::max(side.y, side.z) ? 0 : side.y >= side.z ? 1 : 2;
}

/// Puts a set into its order of elimination. @param isLower  a mark per unknown, all clear
void dissect(std::span<int> set, const Neighbours& neighbours, std::span<const Vec3> point,
             std::vector<char>& isLower) {
  if (set.size() <= smallest) return;
  const int axis = longestSide(set, point);
  const auto before = [&](int a, int b) {
    const double xa = point[static_cast<std::size_t>(a)][axis], xb = point[static_cast<std::size_t>(b)][axis];
    return xa < xb || (xa == xb && a < b);
  };
  const auto middle = set.begin() + static_cast<std::ptrdiff_t>(set.size() / 2);
  std::nth_element(set.begin(), middle, set.end(), before);
  const double cut = point[static_cast<std::size_t>(*middle)][axis];
  const auto upper = std::stable_partition(set.begin(), set.end(),
                                           [&](int a) { return point[static_cast<std::size_t>(a)][axis] < cut; });
  for (auto a = set.begin(); a != upper; ++a) isLower[*a] = 1;
  const auto separator = std::stable_partition(upper, set.end(), [&](int a) {
    return std::ranges::none_of(neighbours.of(a), [&](int b) { return isLower[b] != 0; });
  });
  for (auto a = set.begin(); a != upper; ++a) isLower[*a] = 0;
  if (upper == set.begin()) return;  // more than half of them in one plane
  dissect({set.begin(), upper}, neighbours, point, isLower);
  dissect({upper, separator}, neighbours, point, isLower);
}

}  // namespace

std::vector<int> nestedDissection(const SparseMatrix& A, std::span<const Vec3> point) {
  if (point.size() != static_cast<std::size_t>(A.size))
    throw InputError(
        "there are " + std::to_string(point.size()) + " points for " + std::to_string(A.size) + " unknowns",
        "nestedDissection", "give one point per unknown");
  std::vector<int> order(point.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<char> isLower(point.size(), 0);
  dissect(order, Neighbours(A), point, isLower);
  return order;
}

}  // namespace dovetail::linalg
