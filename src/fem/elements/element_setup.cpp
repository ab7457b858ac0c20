#include <algorithm>
#include <cmath>

#include "brick.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/elements/elements.hpp"
#include "hybrid_matrix.hpp"
#include "lane.hpp"

namespace dovetail::fem {

namespace detail {
namespace {

// Local node of a binary corner.
constexpr std::array<std::size_t, 8> localNode = {0, 1, 3, 2, 4, 5, 7, 6};

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

bool isUniform(const CornerValues& share) {
  return std::all_of(share.begin(), share.end(), [&](double value) { return value == share[0]; });
}

BoxGeometry boxGeometry(const std::array<BrickCorners, laneCount>& corners,
                        const std::array<CornerValues, laneCount>& share, int count) {
  BoxGeometry geometry{};
  for (int lane = 0; lane < laneCount; ++lane) {
    const Matrix3 J = jacobian(corners[static_cast<std::size_t>(lane)], {0.0, 0.0, 0.0});
    for (std::size_t axis = 0; axis < 3; ++axis) geometry.gradientScale[axis][lane] = 0.125 / J[4 * axis];
    geometry.weight[lane] = lane < count ? share[static_cast<std::size_t>(lane)][0] * determinant(J) : 0.0;
  }
  return geometry;
}

void setGeneralLane(const BrickCorners& corners, const CornerValues& share, int lane, bool used, bool hybrid,
                    GeneralGeometry& geometry) {
  const Matrix3 J0 = jacobian(corners, {0.0, 0.0, 0.0});
  for (int p = 0; p < 8; ++p) {
    const auto point = static_cast<std::size_t>(p);
    const Matrix3 J = jacobian(corners, gaussPoint(p));
    const Matrix3 map = hybrid ? product(inverse(J), J0) : inverse(J);
    for (std::size_t i = 0; i < 9; ++i) geometry.map[point][i][lane] = map[i];
    geometry.weight[point][lane] = used ? interpolated(share, gaussPoint(p)) * determinant(J) : 0.0;
  }
}

void setHybridLane(const BrickCorners& corners, const CornerValues& share, int lane, const Material& material,
                   HybridGeometry& geometry) {
  const Matrix3 J0 = jacobian(corners, {0.0, 0.0, 0.0});
  for (std::size_t i = 0; i < 9; ++i) geometry.centreJacobian[i][lane] = J0[i];
  const std::array<double, 324> stiffness = hybridStiffness(corners, share, material);
  std::size_t place = 0;
  for (std::size_t i = 0; i < 18; ++i)
    for (std::size_t j = i; j < 18; ++j) geometry.stiffness[place++][lane] = stiffness[18 * i + j];
}

void addBatch(ElementCache& cache, const Material& material, std::size_t first) {
  Batch batch{};
  batch.count = static_cast<std::int32_t>(std::min<std::size_t>(laneCount, cache.elements.size() - first));
  std::array<BrickCorners, laneCount> corners;
  std::array<CornerValues, laneCount> share;
  batch.box = true;
  for (int lane = 0; lane < laneCount; ++lane) {
    const auto& element = cache.elements[first + static_cast<std::size_t>(std::min(lane, batch.count - 1))];
    for (std::size_t b = 0; b < 8; ++b) batch.node[b][static_cast<std::size_t>(lane)] = element[localNode[b]];
    corners[static_cast<std::size_t>(lane)] = cornersOf(element, cache.X);
    share[static_cast<std::size_t>(lane)] = cornerValues(element, cache.nodalWeight);
    batch.box =
        batch.box && isBox(corners[static_cast<std::size_t>(lane)]) && isUniform(share[static_cast<std::size_t>(lane)]);
  }
  if (batch.box) {
    batch.geometry = static_cast<std::int32_t>(cache.boxes.size());
    cache.boxes.push_back(boxGeometry(corners, share, batch.count));
    cache.boxElements += static_cast<std::size_t>(batch.count);
  } else {
    batch.geometry = static_cast<std::int32_t>(cache.general.size());
    GeneralGeometry geometry{};
    geometry.hybrid = static_cast<std::int32_t>(cache.hybrid.size());
    const bool hybrid = cache.law == Law::hybrid;
    for (int lane = 0; lane < laneCount; ++lane)
      setGeneralLane(corners[static_cast<std::size_t>(lane)], share[static_cast<std::size_t>(lane)], lane,
                     lane < batch.count, hybrid, geometry);
    cache.general.push_back(geometry);
    if (hybrid) {
      HybridGeometry modes{};
      for (int lane = 0; lane < laneCount; ++lane)
        setHybridLane(corners[static_cast<std::size_t>(lane)], share[static_cast<std::size_t>(lane)], lane, material,
                      modes);
      cache.hybrid.push_back(modes);
    }
  }
  cache.batches.push_back(batch);
}

/// Lists for every node its entries in the batches' forces, by ascending element.
void listEntries(ElementCache& cache) {
  cache.nodeOffsets.assign(cache.X.size() + 1, 0);
  for (const auto& element : cache.elements)
    for (const int node : element) ++cache.nodeOffsets[static_cast<std::size_t>(node) + 1];
  for (std::size_t n = 0; n < cache.X.size(); ++n) cache.nodeOffsets[n + 1] += cache.nodeOffsets[n];
  std::vector<std::uint32_t> next(cache.nodeOffsets.begin(), cache.nodeOffsets.end() - 1);
  cache.nodeEntries.resize(8 * cache.elements.size());
  for (std::size_t e = 0; e < cache.elements.size(); ++e)
    for (std::size_t b = 0; b < 8; ++b) {
      const auto node = static_cast<std::size_t>(cache.elements[e][localNode[b]]);
      cache.nodeEntries[next[node]++] =
          static_cast<std::uint32_t>(32 * (e / laneCount) + laneCount * b + e % laneCount);
    }
}

void requireWeights(std::span<const double> nodalWeight, std::size_t nodes) {
  if (nodalWeight.empty()) return;
  if (nodalWeight.size() != nodes)
    throw InputError(
        "there are " + std::to_string(nodalWeight.size()) + " weights for " + std::to_string(nodes) + " nodes",
        "nodalWeight", "give one per node, or none");
  for (std::size_t n = 0; n < nodes; ++n)
    if (!(nodalWeight[n] >= 0.0 && nodalWeight[n] <= 1.0))
      throw InputError("the weight of node " + std::to_string(n) + " is " + formatNumber(nodalWeight[n]), "nodalWeight",
                       "give numbers from 0 to 1");
}

Law lawOf(ElementType type, const Material& material) {
  const bool kirchhoff = std::holds_alternative<StVenantKirchhoff>(material);
  if (type == ElementType::hex8 && std::holds_alternative<AxialSprings>(material)) return Law::axialSprings;
  if (type == ElementType::hex8) return kirchhoff ? Law::stVenantKirchhoff : Law::deformedMetric;
  if (!kirchhoff)
    throw InputError("hybrid8 assumes the stress of StVenantKirchhoff", "material", "use that law, or hex8");
  return Law::hybrid;
}

}  // namespace
}  // namespace detail

ElementBlock makeElements(const Mesh& mesh, ElementType type, const Material& material,
                          std::span<const double> nodalWeight) {
  validate(mesh);
  validate(material);
  detail::requireWeights(nodalWeight, mesh.X.size());
  auto cache = std::make_shared<detail::ElementCache>();
  cache->law = detail::lawOf(type, material);
  const double young = youngsModulus(material), nu = poissonRatio(material);
  const LameConstants lame = lameConstants(young, nu);
  cache->constants = {0.5 * lame.lambda, lame.mu, 0.5 * young, 0.5 * young / (1.0 - nu * nu), nu};
  cache->elements = mesh.elements;
  cache->X = mesh.X;
  cache->nodalWeight.assign(nodalWeight.begin(), nodalWeight.end());
  for (std::size_t first = 0; first < mesh.elements.size(); first += detail::laneCount)
    detail::addBatch(*cache, material, first);
  detail::listEntries(*cache);
  return {type, material, std::move(cache)};
}

std::size_t ElementBlock::size() const { return cache_->elements.size(); }
std::size_t ElementBlock::nodeCount() const { return cache_->X.size(); }
std::span<const std::array<int, 8>> ElementBlock::elements() const { return cache_->elements; }
std::span<const Vec3> ElementBlock::X() const { return cache_->X; }
std::span<const double> ElementBlock::nodalWeight() const { return cache_->nodalWeight; }
std::size_t ElementBlock::boxes() const { return cache_->boxElements; }

}  // namespace dovetail::fem
