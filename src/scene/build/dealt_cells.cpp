#include "dealt_cells.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/rve/equilibrium.hpp"

namespace dovetail::scene {

namespace {

constexpr double tolerance = 1e-4;  // of pressures, relative: a load on top is held as well
constexpr double sameDepth = 1e-9;  // of the height of the solid
constexpr int passes = 2;           // cells under more pressure are denser, and weigh more

/// Depths of points below the highest corner, m.
class Depths {
public:
  Depths(const std::vector<Vec3>& corners, const Vec3& gravity) : down_(gravity / norm(gravity)) {
    const auto along = [&](const Vec3& X) { return dot(down_, X); };
    const auto [top, bottom] = std::ranges::minmax(corners, {}, along);
    top_ = along(top);
    same_ = sameDepth * (along(bottom) - top_);
  }
  double of(const Vec3& X) const { return dot(down_, X) - top_; }

  void add(const std::vector<Vec3>& points) {
    for (const Vec3& X : points) levels_.push_back(of(X));
    std::ranges::sort(levels_);
    const auto isSame = [&](double a, double b) { return b - a <= same_; };
    levels_.erase(std::unique(levels_.begin(), levels_.end(), isSame), levels_.end());
  }
  const std::vector<double>& levels() const { return levels_; }
  /// Of levels(), the nearest.
  std::size_t levelOf(const Vec3& X) const {
    const double depth = of(X);
    const auto nearer = [&](double a, double b) { return std::abs(a - depth) < std::abs(b - depth); };
    return static_cast<std::size_t>(std::ranges::min_element(levels_, nearer) - levels_.begin());
  }

private:
  Vec3 down_;
  double top_, same_;
  std::vector<double> levels_;
};

}  // namespace

DealtCells pressedByDepth(const std::vector<rve::Rve>& cells, const CellPlaces& places) {
  const double weight = norm(places.gravity);
  if (!(weight > 0.0))
    throw InputError("cells are dealt by depth, and no gravity acts on the solid", "deal",
                     "give the scene a gravity, or leave \"deal\" out");
  Depths depths(places.corners, places.gravity);
  depths.add(places.points());
  const std::size_t levels = depths.levels().size(), n = cells.size();
  requireMemory(static_cast<double>(levels * n * cells.front().size()), "grains of cells", bytesOfGrain,
                "take fewer cells, or points in layers");
  std::vector<rve::Rve> pressed(levels * n);
  for (std::size_t k = 0; k < pressed.size(); ++k) pressed[k] = cells[k % n];
  for (int pass = 0; pass < passes; ++pass) {
    const double density = hierarchical::meanDensity(pressed);
    parallelTasks(pressed.size(), [&](std::size_t k) {
      const rve::Rve& begun = cells[k % n];
      const double p = rve::stress(begun).pressure + density * weight * depths.levels()[k / n];
      rve::compress(pressed[k], {.pressure = {p, p, p},
                                 .friction = begun.springs.friction,
                                 .tolerance = tolerance,
                                 .rest = {.tolerance = restOfCells}});
    });
  }
  auto deal = [depths, n](const fem::PointPlace& place) {
    return depths.levelOf(place.X) * n + hierarchical::inTurn(place) % n;
  };
  return {std::move(pressed), std::move(deal)};
}

}  // namespace dovetail::scene
