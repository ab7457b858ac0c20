// Skins that kernels carry.
#include <algorithm>
#include <cmath>
#include <utility>

#include "dovetail/cg/symmetric_kernel.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/surface/skin.hpp"

namespace dovetail::surface {

namespace {

/// A third of the area around each vertex, m².
std::vector<double> vertexAreas(const Skin& skin) {
  std::vector<double> area(skin.X.size(), 0.0);
  for (const auto& [a, b, c] : skin.wall.facets) {
    const double third = norm(cross(skin.X[b] - skin.X[a], skin.X[c] - skin.X[a])) / 6.0;
    for (int vertex : {a, b, c}) area[vertex] += third;
  }
  return area;
}

/// The node that a vertex is, −1 for the middle of a face.
int nodeAt(const Skin& skin, int vertex) {
  const auto nodes = skin.localMap.rowColumns(vertex);
  return nodes.size() == 1 ? nodes[0] : -1;
}

std::vector<Vec3> nodePositions(const Skin& skin) {
  std::vector<Vec3> X(static_cast<std::size_t>(skin.localMap.columns));
  for (int v = 0; v < static_cast<int>(skin.X.size()); ++v)
    if (const int node = nodeAt(skin, v); node >= 0) X[node] = skin.X[v];
  return X;
}

std::vector<int> patchOfVertex(const Skin& skin) {
  std::vector<int> patch(skin.X.size());
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t)
    for (int vertex : skin.wall.facets[t]) patch[vertex] = skin.patchOfFacet[t];
  return patch;
}

std::vector<PatchFrame> makeFrames(const Skin& skin, std::span<const int> patchOf) {
  struct Members {
    std::vector<int> node;
    std::vector<double> area;
    std::vector<Vec3> X;
  };
  std::vector<Members> patches(static_cast<std::size_t>(1 + *std::ranges::max_element(patchOf)));
  const std::vector<double> area = vertexAreas(skin);
  for (int v = 0; v < static_cast<int>(skin.X.size()); ++v)
    if (const int node = nodeAt(skin, v); node >= 0) {
      Members& patch = patches[patchOf[v]];
      patch.node.push_back(node);
      patch.area.push_back(area[v]);
      patch.X.push_back(skin.X[v]);
    }
  std::vector<PatchFrame> frames;
  for (Members& patch : patches) frames.push_back(makeFrame(std::move(patch.node), patch.area, patch.X));
  return frames;
}

/// On slender patches restores the rows' first moments lengthwise, by a factor that does not change across.
void straighten(Skin& skin, std::span<const Vec3> nodeX, const PatchOffsets& offsets) {
  for (int v = 0; v < static_cast<int>(skin.X.size()); ++v) {
    const PatchFrame& frame = offsets.frames[offsets.patch[v]];
    if (!frame.slender) continue;
    const auto node = skin.carrier.rowColumns(v);
    double* const weight = skin.carrier.weight.data() + skin.carrier.offsets[v];
    const auto along = [&](std::size_t k) { return dot(nodeX[node[k]] - skin.X[v], frame.longest); };
    double mean = 0.0, square = 0.0;
    for (std::size_t k = 0; k < node.size(); ++k) mean += weight[k] * along(k);
    for (std::size_t k = 0; k < node.size(); ++k) square += weight[k] * (along(k) - mean) * (along(k) - mean);
    if (!(square > 0.0)) continue;
    for (std::size_t k = 0; k < node.size(); ++k) weight[k] *= 1.0 - mean * (along(k) - mean) / square;
  }
}

/// Where kernels leave vertices off their places: the offsets, and the patches that turn them.
void keepPlaces(Skin& skin, double width) {
  constexpr double roundOff = 1e-8;  // of the width
  const std::vector<Vec3> nodeX = nodePositions(skin);
  PatchOffsets offsets{{}, patchOfVertex(skin), {}};
  offsets.frames = makeFrames(skin, offsets.patch);
  straighten(skin, nodeX, offsets);
  bool needed = false;
  for (int v = 0; v < static_cast<int>(skin.X.size()); ++v) {
    Vec3 offset;
    for (std::size_t k = 0; k < skin.carrier.rowColumns(v).size(); ++k)
      offset += skin.carrier.rowWeights(v)[k] * (skin.X[v] - nodeX[skin.carrier.rowColumns(v)[k]]);
    needed = needed || norm(offset) > roundOff * width;
    offsets.offset.push_back(offsets.frames[offsets.patch[v]].scaled(offset));
  }
  skin.offsets = needed ? std::move(offsets) : PatchOffsets{};
}

cg::Projection kernelMap(const Skin& skin, const cg::SurfaceKernel& kernel) {
  if (kernel.correction == cg::KernelCorrection::symmetric)
    return cg::symmetricKernelMap(kernel.kernel, skin.X, skin.wall.facets, skin.patchOfFacet, skin.localMap);
  cg::Projection carrier;
  carrier.columns = skin.localMap.columns;
  carrier.offsets.push_back(0);
  cg::SurfaceKernelRows rows(kernel, skin.X, skin.wall.facets, skin.patchOfFacet, skin.localMap);
  for (int v = 0; v < static_cast<int>(skin.X.size()); ++v) {
    const int facet = skin.wall.topology.vertexFacets[skin.wall.topology.vertexFacetOffsets[v]];
    std::array<double, 3> corner{};
    for (int k = 0; k < 3; ++k) corner[k] = skin.wall.facets[facet][k] == v ? 1.0 : 0.0;
    rows.row(facet, corner, carrier.column, carrier.weight);
    carrier.offsets.push_back(static_cast<int>(carrier.column.size()));
  }
  return carrier;
}

}  // namespace

void coarseGrain(Skin& skin, const cg::SurfaceKernel& kernel) {
  cg::requireValid(kernel.kernel, true);
  if (kernel.kernel.width == 0.0) {
    skin.carrier = skin.localMap;
    skin.offsets = {};
    return;
  }
  splitAtSharpEdges(skin);
  skin.carrier = kernelMap(skin, kernel);
  keepPlaces(skin, kernel.kernel.width);
}

cg::SurfaceKernel advisedKernel(const fem::SolidMesh& mesh) {
  const Skin skin = makeSkin(mesh.X, fem::boundaryFaces(mesh), QuadSplit::two);
  double volume = 0.0, area = 0.0;
  for (const auto& [a, b, c] : skin.wall.facets) {
    const Vec3 normal = 0.5 * cross(skin.X[b] - skin.X[a], skin.X[c] - skin.X[a]);
    volume += dot(normal, skin.X[a] - skin.X[0]) / 3.0;
    area += norm(normal);
  }
  requirePositive(volume, "volume within the boundary of the mesh, m³");
  return {{.width = 2.0 * volume / area}, cg::KernelCorrection::symmetric};
}

}  // namespace dovetail::surface
