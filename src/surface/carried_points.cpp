#include "carried_points.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/parallel.hpp"
#include "dovetail/surface/skin.hpp"
#include "packed.hpp"

namespace dovetail::surface {

namespace {

[[gnu::always_inline]] inline void placePoint(const cg::Projection& carrier, std::span<const Vec3> u,
                                              std::span<const Vec3> v, int point, Vec3& x, Vec3& velocity) {
  const auto node = carrier.rowColumns(point);
  const auto fraction = carrier.rowWeights(point);
  Packed moved{}, speed{};
  for (std::size_t n = 0; n < node.size(); ++n) {
    moved += fraction[n] * packed(u[static_cast<std::size_t>(node[n])]);
    speed += fraction[n] * packed(v[static_cast<std::size_t>(node[n])]);
  }
  x += unpacked(moved);
  velocity = unpacked(speed);
}

[[gnu::always_inline]] inline void addLoadOfPoint(const cg::Projection& carrier, int point, const Vec3& force,
                                                  std::span<Vec3> onNodes) {
  const auto node = carrier.rowColumns(point);
  const auto fraction = carrier.rowWeights(point);
  const Packed f = packed(force);
  for (std::size_t k = 0; k < node.size(); ++k) {
    Vec3& sum = onNodes[static_cast<std::size_t>(node[k])];
    sum = unpacked(packed(sum) + fraction[k] * f);
  }
}

}  // namespace

void placePoints(const cg::Projection& carrier, std::span<const Vec3> X, PatchOffsets& offsets, std::span<const Vec3> u,
                 std::span<const Vec3> v, std::span<const int> points, std::span<Vec3> x, std::span<Vec3> velocity) {
  if (!offsets.empty()) placeFrames(offsets, u, v, points);
  parallelFor(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    withVectors([&] {
      for (const int point : points.subspan(begin, end - begin)) {
        const auto p = static_cast<std::size_t>(point);
        x[p] = X[p];
        placePoint(carrier, u, v, point, x[p], velocity[p]);
        if (!offsets.empty()) offsets.carry(p, x[p], velocity[p]);
      }
    });
  });
}

void addLoadOfPoints(const cg::Projection& carrier, const PatchOffsets& offsets, const coupling::NodalLoad& onPoints,
                     coupling::NodalLoad& load) {
  for (const int point : onPoints.touched)
    if (bears(onPoints, point))
      for (const int node : carrier.rowColumns(point)) load.touch(node);
  withVectors([&] {
    for (const int point : onPoints.touched)
      if (bears(onPoints, point))
        addLoadOfPoint(carrier, point, onPoints.force[static_cast<std::size_t>(point)], load.force);
  });
  addOffsetLoad(offsets, onPoints, load);
}

double carrierGain(const cg::Projection& carrier, const PatchOffsets& offsets) {
  double gain = 0.0;
  for (int row = 0; row < carrier.rows(); ++row) {
    double sum = 0.0;
    for (double weight : carrier.rowWeights(row)) sum += std::abs(weight);
    gain = std::max(gain, sum);
  }
  return gain + offsetGain(offsets);
}

}  // namespace dovetail::surface
