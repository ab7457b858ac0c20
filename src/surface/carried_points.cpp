#include "carried_points.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/parallel.hpp"
#include "dovetail/surface/skin.hpp"

namespace dovetail::surface {

void placePoints(const cg::Projection& carrier, std::span<const Vec3> X, PatchTurns& turns, std::span<const Vec3> u,
                 std::span<const Vec3> v, std::span<const int> points, std::span<Vec3> x, std::span<Vec3> velocity) {
  if (!turns.empty()) placeFrames(turns, u, v, points);
  parallelFor(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const int point = points[k];
      const auto p = static_cast<std::size_t>(point);
      const auto node = carrier.rowColumns(point);
      const auto share = carrier.rowWeights(point);
      Vec3 moved, speed;
      for (std::size_t n = 0; n < node.size(); ++n) {
        moved += share[n] * u[static_cast<std::size_t>(node[n])];
        speed += share[n] * v[static_cast<std::size_t>(node[n])];
      }
      x[p] = X[p] + moved;
      velocity[p] = speed;
      if (!turns.empty()) turns.carry(p, x[p], velocity[p]);
    }
  });
}

void addLoadOfPoints(const cg::Projection& carrier, const PatchTurns& turns, const coupling::NodalLoad& onPoints,
                     coupling::NodalLoad& load) {
  for (int point : onPoints.touched) {
    const auto node = carrier.rowColumns(point);
    const auto share = carrier.rowWeights(point);
    const Vec3& force = onPoints.force[static_cast<std::size_t>(point)];
    for (const int n : node) load.touch(n);
    for (std::size_t k = 0; k < node.size(); ++k) load.force[static_cast<std::size_t>(node[k])] += share[k] * force;
  }
  addTurningLoad(turns, onPoints, load);
}

double carrierGain(const cg::Projection& carrier, const PatchTurns& turns) {
  double gain = 0.0;
  for (int row = 0; row < carrier.rows(); ++row) {
    double sum = 0.0;
    for (double weight : carrier.rowWeights(row)) sum += std::abs(weight);
    gain = std::max(gain, sum);
  }
  return gain + turningGain(turns);
}

}  // namespace dovetail::surface
