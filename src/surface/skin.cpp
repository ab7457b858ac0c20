#include "dovetail/surface/skin.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "dovetail/cg/symmetric_kernel.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/geometry/surface_topology.hpp"

namespace dovetail::surface {

namespace {

constexpr double roundOffArea = 1e-14;  // of the squared diagonals

void checkFaces(std::span<const Vec3> X, std::span<const Quad> faces) {
  if (faces.empty())
    throw InputError("the coupling surface has no faces", "makeSkin", "name a face set of the mesh that is not empty");
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::string where = "face " + std::to_string(f);
    for (int node : faces[f])
      if (node < 0 || node >= static_cast<int>(X.size()))
        throw InputError("node " + std::to_string(node) + " does not exist", where,
                         "use node numbers from 0 to " + std::to_string(X.size() - 1));
    const Vec3 first = X[faces[f][2]] - X[faces[f][0]], second = X[faces[f][3]] - X[faces[f][1]];
    Quad sorted = faces[f];
    std::sort(sorted.begin(), sorted.end());
    const bool repeats = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
    if (repeats || !(norm(cross(first, second)) > roundOffArea * (squaredNorm(first) + squaredNorm(second))))
      throw InputError("the face has no area", where, "give four different corners in order around the face");
  }
}

/// Vertices before patches are known: the faces' corners (by node) and, for four triangles, one centre per face.
struct Triangles {
  std::vector<Vec3> X;
  std::vector<geometry::Facet> facets;
  std::vector<int> facetQuad;
};

Triangles triangulate(std::span<const Vec3> X, std::span<const Quad> faces, QuadSplit split) {
  Triangles cut{{X.begin(), X.end()}, {}, {}};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto [a, b, c, d] = faces[f];
    const auto add = [&](int i, int j, int k) {
      cut.facets.push_back({i, j, k});
      cut.facetQuad.push_back(static_cast<int>(f));
    };
    if (split == QuadSplit::two) {
      add(a, b, c);
      add(a, c, d);
      continue;
    }
    const int centre = static_cast<int>(cut.X.size());
    cut.X.push_back(0.25 * (X[a] + X[b] + X[c] + X[d]));
    add(a, b, centre);
    add(b, c, centre);
    add(c, d, centre);
    add(d, a, centre);
  }
  return cut;
}

/// Numbers things anew in the order in which they are met; origin[new] = old.
template <class Key>
class Renumbering {
public:
  int number(const Key& key) {
    const auto [place, isNew] = numbers_.try_emplace(key, static_cast<int>(origin.size()));
    if (isNew) origin.push_back(key);
    return place->second;
  }
  std::vector<Key> origin;

private:
  std::map<Key, int> numbers_;
};

cg::Projection interpolationMap(std::span<const int> origin, std::span<const Quad> faces, int nodeCount) {
  cg::Projection map;
  map.columns = nodeCount;
  map.offsets.push_back(0);
  for (int vertex : origin) {
    if (vertex < nodeCount) {
      map.column.push_back(vertex);
      map.weight.push_back(1.0);
    } else {
      Quad corners = faces[vertex - nodeCount];
      std::sort(corners.begin(), corners.end());
      for (int node : corners) {
        map.column.push_back(node);
        map.weight.push_back(0.25);
      }
    }
    map.offsets.push_back(static_cast<int>(map.column.size()));
  }
  return map;
}

bool isClosed(const geometry::SurfaceTopology& topology) {
  return std::all_of(topology.neighbours.begin(), topology.neighbours.end(), [](const auto& facet) {
    return std::all_of(facet.begin(), facet.end(), [](int neighbour) { return neighbour >= 0; });
  });
}

void resetWall(Skin& skin) {
  skin.wall.x = skin.X;
  skin.wall.v.assign(skin.X.size(), Vec3{});
  skin.wall.f.assign(skin.X.size(), Vec3{});
  skin.wall.topology = geometry::makeTopology(skin.wall.facets, static_cast<int>(skin.X.size()));
  skin.wall.oneSided = isClosed(skin.wall.topology);
}

cg::Projection selectRows(const cg::Projection& map, std::span<const int> rows) {
  cg::Projection selected{map.columns, {0}, {}, {}};
  for (int row : rows) {
    selected.column.insert(selected.column.end(), map.rowColumns(row).begin(), map.rowColumns(row).end());
    selected.weight.insert(selected.weight.end(), map.rowWeights(row).begin(), map.rowWeights(row).end());
    selected.offsets.push_back(static_cast<int>(selected.column.size()));
  }
  return selected;
}

}  // namespace

Skin makeSkin(std::span<const Vec3> X, std::span<const Quad> faces, QuadSplit split, double sharpAngle) {
  checkFaces(X, faces);
  const Triangles cut = triangulate(X, faces, split);
  Skin skin;
  skin.facetQuad = cut.facetQuad;
  skin.quads.resize(faces.size());
  Renumbering<int> vertices;
  for (std::size_t q = 0; q < faces.size(); ++q)
    for (int k = 0; k < 4; ++k) skin.quads[q][k] = vertices.number(faces[q][k]);
  for (const geometry::Facet& facet : cut.facets)
    skin.wall.facets.push_back({vertices.number(facet[0]), vertices.number(facet[1]), vertices.number(facet[2])});
  for (int vertex : vertices.origin) skin.X.push_back(cut.X[vertex]);
  skin.localMap = interpolationMap(vertices.origin, faces, static_cast<int>(X.size()));
  skin.carrier = skin.localMap;
  resetWall(skin);
  skin.patchOfFacet = geometry::smoothPatches(skin.X, skin.wall.facets, skin.wall.topology, sharpAngle);
  return skin;
}

void splitAtSharpEdges(Skin& skin) {
  Renumbering<std::pair<int, int>> vertices;
  std::vector<int> patchOfQuad(skin.quads.size());
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) patchOfQuad[skin.facetQuad[t]] = skin.patchOfFacet[t];
  for (std::size_t q = 0; q < skin.quads.size(); ++q)
    for (int& vertex : skin.quads[q]) vertex = vertices.number({vertex, patchOfQuad[q]});
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t)
    for (int& vertex : skin.wall.facets[t]) vertex = vertices.number({vertex, skin.patchOfFacet[t]});
  std::vector<int> origin;
  for (const auto& [vertex, patch] : vertices.origin) origin.push_back(vertex);
  std::vector<Vec3> X;
  for (int vertex : origin) X.push_back(skin.X[vertex]);
  skin.X = std::move(X);
  skin.localMap = selectRows(skin.localMap, origin);
  skin.carrier = selectRows(skin.carrier, origin);
  resetWall(skin);
}

void coarseGrain(Skin& skin, const cg::SurfaceKernel& kernel) {
  cg::requireValid(kernel.kernel, true);
  if (kernel.kernel.width == 0.0) {
    skin.carrier = skin.localMap;
    return;
  }
  splitAtSharpEdges(skin);
  if (kernel.correction == cg::KernelCorrection::symmetric) {
    skin.carrier = cg::symmetricKernelMap(kernel.kernel, skin.X, skin.wall.facets, skin.patchOfFacet, skin.localMap);
    return;
  }
  const int vertexCount = static_cast<int>(skin.X.size());
  cg::Projection carrier;
  carrier.columns = skin.localMap.columns;
  carrier.offsets.push_back(0);
  cg::SurfaceKernelRows rows(kernel, skin.X, skin.wall.facets, skin.patchOfFacet, skin.localMap);
  for (int v = 0; v < vertexCount; ++v) {
    const int facet = skin.wall.topology.vertexFacets[skin.wall.topology.vertexFacetOffsets[v]];
    std::array<double, 3> corner{};
    for (int k = 0; k < 3; ++k) corner[k] = skin.wall.facets[facet][k] == v ? 1.0 : 0.0;
    rows.row(facet, corner, carrier.column, carrier.weight);
    carrier.offsets.push_back(static_cast<int>(carrier.column.size()));
  }
  skin.carrier = std::move(carrier);
}

void place(Skin& skin, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> vertices) {
  const cg::Projection& map = skin.carrier;
  for (int vertex : vertices) {
    skin.wall.x[vertex] = skin.X[vertex] + cg::applyRow(map, vertex, u);
    skin.wall.v[vertex] = cg::applyRow(map, vertex, v);
  }
}

void place(Skin& skin, std::span<const Vec3> u, std::span<const Vec3> v) {
  cg::apply(skin.carrier, u, skin.wall.x);
  for (std::size_t i = 0; i < skin.X.size(); ++i) skin.wall.x[i] += skin.X[i];
  cg::apply(skin.carrier, v, skin.wall.v);
}

double carrierGain(const Skin& skin) {
  double gain = 0.0;
  for (std::size_t row = 0; row + 1 < skin.carrier.offsets.size(); ++row) {
    double sum = 0.0;
    for (int k = skin.carrier.offsets[row]; k < skin.carrier.offsets[row + 1]; ++k)
      sum += std::abs(skin.carrier.weight[k]);
    gain = std::max(gain, sum);
  }
  return gain;
}

}  // namespace dovetail::surface
