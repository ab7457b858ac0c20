#include "band_scatter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "soft_sand.hpp"

namespace dovetail::benchmark {

namespace {

constexpr int across = 8, scattered = 28;

/// Distance of an element's middle from the line up to the right at 45° through the middle of the body.
std::vector<double> fromDiagonal() {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::quad8, {across, 2 * across, 1}, {}, {1.0, 2.0, 1.0});
  const std::vector<int>& node = mesh.groups.front().node;
  std::vector<double> distance(mesh.elementCount());
  for (std::size_t e = 0; e < distance.size(); ++e) {
    double sum = 0.0;
    for (std::size_t a = 0; a < 8; ++a) {
      const Vec3& X = mesh.X[static_cast<std::size_t>(node[8 * e + a])];
      sum += X.y - X.x - 0.5;
    }
    distance[e] = std::abs(sum) / 8.0;
  }
  return distance;
}

}  // namespace

BiaxialCourse pressScattered(double scatter, double modulus, std::uint64_t seed) {
  const std::vector<double> distance = fromDiagonal();
  std::vector<int> element(distance.size());
  std::iota(element.begin(), element.end(), 0);
  std::ranges::stable_sort(element, {}, [&](int e) { return distance[static_cast<std::size_t>(e)]; });
  std::mt19937_64 random(seed);
  for (std::size_t k = scattered - 1; k > 0; --k) std::swap(element[k], element[random() % (k + 1)]);
  const auto part = [&](double friction, int first, int last) {
    std::vector<int> own(element.begin() + first, element.begin() + last);
    std::ranges::sort(own);
    return BandPart{softSand({.friction = friction, .weakSpot = {}}), own};
  };
  const double friction = SoftSand().friction;
  return pressTogether(
      {.across = across, .modulus = modulus, .end = 0.025},
      {part(friction, scattered, static_cast<int>(element.size())), part((1.0 - scatter) * friction, 0, scattered / 2),
       part((1.0 + scatter) * friction, scattered / 2, scattered)});
}

}  // namespace dovetail::benchmark
