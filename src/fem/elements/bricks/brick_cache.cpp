#include "brick_cache.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "hybrid_matrix.hpp"

namespace dovetail::fem::detail {

namespace {

/// Boxes along the axes, up to the rounding of their coordinates.
bool isBox(const BrickCorners& corners) {
  const Matrix3 centre = jacobian(corners, {0.0, 0.0, 0.0});
  const double size = std::max({std::abs(centre[0]), std::abs(centre[4]), std::abs(centre[8])});
  for (int p = 0; p < 8; ++p) {
    Matrix3 J = jacobian(corners, gaussPoint(p));
    for (std::size_t axis = 0; axis < 3; ++axis) J[4 * axis] -= centre[4 * axis];
    for (const double entry : J)
      if (std::abs(entry) > 1e-12 * size) return false;
  }
  return centre[0] > 0.0 && centre[4] > 0.0 && centre[8] > 0.0;
}

bool isUniform(const CornerValues& fraction) {
  return std::all_of(fraction.begin(), fraction.end(), [&](double value) { return value == fraction[0]; });
}

BoxGeometry boxGeometry(const std::array<BrickCorners, laneCount>& corners,
                        const std::array<CornerValues, laneCount>& fraction, int count) {
  BoxGeometry geometry{};
  for (int lane = 0; lane < laneCount; ++lane) {
    const Matrix3 J = jacobian(corners[static_cast<std::size_t>(lane)], {0.0, 0.0, 0.0});
    for (std::size_t axis = 0; axis < 3; ++axis) geometry.gradientScale[axis][lane] = 0.125 / J[4 * axis];
    geometry.weight[lane] = lane < count ? fraction[static_cast<std::size_t>(lane)][0] * determinant(J) : 0.0;
  }
  return geometry;
}

void setGeneralLane(const BrickCorners& corners, const CornerValues& fraction, int lane, bool used, bool hybrid,
                    GeneralGeometry& geometry) {
  const Matrix3 J0 = jacobian(corners, {0.0, 0.0, 0.0});
  for (int p = 0; p < 8; ++p) {
    const auto point = static_cast<std::size_t>(p);
    const Matrix3 J = jacobian(corners, gaussPoint(p));
    const Matrix3 map = hybrid ? product(inverse(J), J0) : inverse(J);
    for (std::size_t i = 0; i < 9; ++i) geometry.map[point][i][lane] = map[i];
    geometry.weight[point][lane] = used ? interpolated(fraction, gaussPoint(p)) * determinant(J) : 0.0;
  }
}

void setHybridLane(const BrickCorners& corners, const CornerValues& fraction, int lane, const Material& material,
                   HybridGeometry& geometry) {
  const Matrix3 J0 = jacobian(corners, {0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < 9; ++i) geometry.centreJacobian[i][lane] = J0[i];
  const std::array<double, 324> stiffness = hybridStiffness(corners, fraction, material);
  std::size_t place = 0;
  for (std::size_t i = 0; i < 18; ++i)
    for (std::size_t j = i; j < 18; ++j) geometry.stiffness[place++][lane] = stiffness[18 * i + j];
}

void addBatch(const SolidCells& cells, const Material& material, std::size_t b, BrickCache& cache) {
  Batch batch{};
  batch.count = static_cast<std::int32_t>(cells.inUse(b));
  std::array<BrickCorners, laneCount> corners;
  std::array<CornerValues, laneCount> fraction;
  batch.box = true;
  for (std::size_t lane = 0; lane < laneCount; ++lane) {
    const std::size_t e = laneCount * b + std::min(lane, cells.inUse(b) - 1);
    const std::array<int, 8> element = brickNodes(cells, e);
    for (std::size_t corner = 0; corner < 8; ++corner) batch.node[corner][lane] = element[brickNode[corner]];
    corners[lane] = cornersOf(element, cells.X);
    fraction[lane] = cornerValues(element, cells.fraction);
    batch.box = batch.box && isBox(corners[lane]) && isUniform(fraction[lane]);
  }
  if (batch.box) {
    batch.geometry = static_cast<std::int32_t>(cache.boxes.size());
    cache.boxes.push_back(boxGeometry(corners, fraction, batch.count));
  } else {
    batch.geometry = static_cast<std::int32_t>(cache.general.size());
    GeneralGeometry geometry{};
    geometry.hybrid = static_cast<std::int32_t>(cache.hybrid.size());
    const bool hybrid = cache.law == Law::hybrid;
    for (int lane = 0; lane < laneCount; ++lane)
      setGeneralLane(corners[static_cast<std::size_t>(lane)], fraction[static_cast<std::size_t>(lane)], lane,
                     lane < batch.count, hybrid, geometry);
    cache.general.push_back(geometry);
    if (hybrid) {
      HybridGeometry modes{};
      for (int lane = 0; lane < laneCount; ++lane)
        setHybridLane(corners[static_cast<std::size_t>(lane)], fraction[static_cast<std::size_t>(lane)], lane, material,
                      modes);
      cache.hybrid.push_back(modes);
    }
  }
  cache.batches.push_back(batch);
}

Law lawOf(const Material& material, bool assumedStress) {
  if (assumedStress) return Law::hybrid;
  if (std::holds_alternative<AxialSprings>(material)) return Law::axialSprings;
  return std::holds_alternative<StVenantKirchhoff>(material) ? Law::stVenantKirchhoff : Law::deformedMetric;
}

}  // namespace

std::array<int, 8> brickNodes(const SolidCells& cells, std::size_t e) {
  std::array<int, 8> nodes;
  for (std::size_t a = 0; a < 8; ++a) nodes[a] = cells.nodeOf(e, a);
  return nodes;
}

BrickCache makeBrickCache(const SolidCells& cells, const Material& material, bool assumedStress) {
  BrickCache cache{};
  cache.law = lawOf(material, assumedStress);
  const double young = youngsModulus(material), nu = poissonRatio(material);
  const LameConstants lame = lameConstants(young, nu);
  cache.constants = {0.5 * lame.lambda, lame.mu, 0.5 * young, 0.5 * young / (1.0 - nu * nu), nu};
  cache.batches.reserve(cells.batches());
  for (std::size_t b = 0; b < cells.batches(); ++b) addBatch(cells, material, b, cache);
  return cache;
}

std::size_t BrickCache::memory() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(batches) + bytes(boxes) + bytes(general) + bytes(hybrid);
}

}  // namespace dovetail::fem::detail
