#include "dovetail/surface/skin.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "carried_points.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/shape.hpp"
#include "dovetail/geometry/surface_topology.hpp"
#include "face_cut.hpp"

namespace dovetail::surface {

namespace {

constexpr double roundOffArea = 1e-14;  // of the squared diagonals

std::span<const int> nodesOf(const fem::Face& face) {
  return {face.node.data(), static_cast<std::size_t>(fem::nodesOf(face.shape))};
}

/// Twice the area between the corners, roughly, against the squares of lengths.
bool hasArea(std::span<const Vec3> X, const fem::Face& face) {
  const auto [a, b, c, d] = std::array{face.node[0], face.node[1], face.node[2], face.node[3]};
  const bool triangle = fem::cornersOf(face.shape) == 3;
  const Vec3 first = X[c] - X[a], second = triangle ? X[b] - X[a] : X[d] - X[b];
  const double area = norm(cross(first, second)), size = squaredNorm(first) + squaredNorm(second);
  return area > roundOffArea * size &&
         std::ranges::all_of(nodesOf(face), [&](int node) { return isFinite(X[static_cast<std::size_t>(node)]); });
}

void checkFaces(std::span<const Vec3> X, std::span<const fem::Face> faces) {
  if (faces.empty())
    throw InputError("the coupling surface has no faces", "makeSkin", "name a face set of the mesh that is not empty");
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::string where = "face " + std::to_string(f);
    if (fem::cornersOf(faces[f].shape) < 3)
      throw InputError(std::string("it is a ") + fem::name(faces[f].shape) + " of a plane mesh", where,
                       "make strips of lines (makeStrips)");
    const std::span<const int> nodes = nodesOf(faces[f]);
    for (int node : nodes)
      if (node < 0 || node >= static_cast<int>(X.size()))
        throw InputError("node " + std::to_string(node) + " does not exist", where,
                         "use node numbers from 0 to " + std::to_string(X.size() - 1));
    std::vector<int> sorted(nodes.begin(), nodes.end());
    std::sort(sorted.begin(), sorted.end());
    const bool repeats = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
    if (repeats || !hasArea(X, faces[f]))
      throw InputError("the face has no area", where, "give different nodes, corners in order around the face");
  }
}

/// Vertices before patches are known: the faces' nodes, and behind those of the mesh one centre per face that needs it.
struct Triangles {
  std::vector<Vec3> X;
  std::vector<geometry::Facet> facets;
  std::vector<int> facetFace;
  std::vector<int> faceOfCentre;
};

Triangles triangulate(std::span<const Vec3> X, std::span<const fem::Face> faces, QuadSplit split) {
  Triangles cut{{X.begin(), X.end()}, {}, {}, {}};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    std::vector<int> vertex(nodesOf(faces[f]).begin(), nodesOf(faces[f]).end());
    vertex.push_back(static_cast<int>(cut.X.size()));
    bool centred = false;
    for (const std::array<int, 3>& triangle : trianglesOf(faces[f].shape, split)) {
      cut.facets.push_back({vertex[triangle[0]], vertex[triangle[1]], vertex[triangle[2]]});
      cut.facetFace.push_back(static_cast<int>(f));
      centred = centred || triangle[2] == fem::nodesOf(faces[f].shape);
    }
    if (!centred) continue;
    const std::vector<double> shape = fem::shapeRow(faces[f].shape, 0.0, 0.0);
    Vec3 centre;
    for (std::size_t a = 0; a < shape.size(); ++a) centre += shape[a] * X[faces[f].node[a]];
    cut.X.push_back(centre);
    cut.faceOfCentre.push_back(static_cast<int>(f));
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

cg::Projection interpolationMap(std::span<const int> origin, std::span<const fem::Face> faces,
                                std::span<const int> faceOfCentre, int nodeCount) {
  std::vector<cg::ProjectionRow> rows;
  for (int vertex : origin) {
    cg::ProjectionRow& row = rows.emplace_back();
    if (vertex < nodeCount) {
      row = {{vertex, 1.0}};
      continue;
    }
    const fem::Face& face = faces[faceOfCentre[vertex - nodeCount]];
    const std::vector<double> shape = fem::shapeRow(face.shape, 0.0, 0.0);
    for (std::size_t a = 0; a < shape.size(); ++a) row.emplace_back(face.node[a], shape[a]);
  }
  return cg::fromRows(nodeCount, rows);
}

bool isClosed(const geometry::SurfaceTopology& topology) {
  return std::all_of(topology.neighbours.begin(), topology.neighbours.end(), [](const auto& facet) {
    return std::all_of(facet.begin(), facet.end(), [](int neighbour) { return neighbour >= 0; });
  });
}

void resetWall(Skin& skin) {
  const bool closed = skin.wall.oneSided;
  skin.wall.x = skin.X;
  skin.wall.v.assign(skin.X.size(), Vec3{});
  skin.wall.f.assign(skin.X.size(), Vec3{});
  skin.wall.topology = geometry::makeTopology(skin.wall.facets, static_cast<int>(skin.X.size()));
  skin.wall.oneSided = closed || isClosed(skin.wall.topology);
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

std::vector<int> numbers(std::size_t count) {
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

template <class T>
std::vector<T> selected(const std::vector<T>& values, std::span<const int> which) {
  std::vector<T> some;
  for (int k : which) some.push_back(values[k]);
  return some;
}

}  // namespace

Skin makeSkin(std::span<const Vec3> X, std::span<const fem::Face> faces, QuadSplit split, double sharpAngle) {
  checkFaces(X, faces);
  if (!(sharpAngle > 0.0 && sharpAngle <= std::numbers::pi))
    throw InputError("the sharp angle is " + formatNumber(sharpAngle), "makeSkin", "give radians above 0, up to π");
  const Triangles cut = triangulate(X, faces, split);
  Skin skin;
  skin.facetFace = cut.facetFace;
  Renumbering<int> vertices;
  for (const fem::Face& face : faces) {
    fem::Face& own = skin.faces.emplace_back(face);
    own.node.fill(-1);
    for (std::size_t k = 0; k < nodesOf(face).size(); ++k) own.node[k] = vertices.number(face.node[k]);
  }
  for (const geometry::Facet& facet : cut.facets)
    skin.wall.facets.push_back({vertices.number(facet[0]), vertices.number(facet[1]), vertices.number(facet[2])});
  for (int vertex : vertices.origin) skin.X.push_back(cut.X[vertex]);
  skin.localMap = interpolationMap(vertices.origin, faces, cut.faceOfCentre, static_cast<int>(X.size()));
  skin.carrier = skin.localMap;
  resetWall(skin);
  skin.patchOfFacet = geometry::smoothPatches(skin.X, skin.wall.facets, skin.wall.topology, sharpAngle);
  return skin;
}

void splitAtSharpEdges(Skin& skin) {
  Renumbering<std::pair<int, int>> vertices;
  std::vector<int> patchOfFace(skin.faces.size());
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) patchOfFace[skin.facetFace[t]] = skin.patchOfFacet[t];
  for (std::size_t f = 0; f < skin.faces.size(); ++f)
    for (int k = 0; k < fem::nodesOf(skin.faces[f].shape); ++k)
      skin.faces[f].node[k] = vertices.number({skin.faces[f].node[k], patchOfFace[f]});
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t)
    for (int& vertex : skin.wall.facets[t]) vertex = vertices.number({vertex, skin.patchOfFacet[t]});
  std::vector<int> origin;
  for (const auto& [vertex, patch] : vertices.origin) origin.push_back(vertex);
  std::vector<Vec3> X;
  for (int vertex : origin) X.push_back(skin.X[vertex]);
  skin.wall.corner = selected(skin.wall.corner.empty() ? numbers(skin.X.size()) : skin.wall.corner, origin);
  skin.X = std::move(X);
  skin.localMap = selectRows(skin.localMap, origin);
  skin.carrier = selectRows(skin.carrier, origin);
  if (!skin.offsets.empty()) {
    skin.offsets.offset = selected(skin.offsets.offset, origin);
    skin.offsets.patch = selected(skin.offsets.patch, origin);
  }
  resetWall(skin);
}

Skin partOf(const Skin& skin, std::size_t first, std::size_t end) {
  Skin part;
  Renumbering<int> vertices;
  part.faces.assign(skin.faces.begin() + static_cast<std::ptrdiff_t>(first),
                    skin.faces.begin() + static_cast<std::ptrdiff_t>(end));
  for (fem::Face& face : part.faces)
    for (int k = 0; k < fem::nodesOf(face.shape); ++k) face.node[k] = vertices.number(face.node[k]);
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) {
    const auto face = static_cast<std::size_t>(skin.facetFace[t]);
    if (face < first || face >= end) continue;
    const auto& [a, b, c] = skin.wall.facets[t];
    part.wall.facets.push_back({vertices.number(a), vertices.number(b), vertices.number(c)});
    part.patchOfFacet.push_back(skin.patchOfFacet[t]);
    part.facetFace.push_back(static_cast<int>(face - first));
  }
  part.X = selected(skin.X, vertices.origin);
  part.wall.corner = skin.wall.corner.empty() ? std::vector<int>{} : selected(skin.wall.corner, vertices.origin);
  part.localMap = selectRows(skin.localMap, vertices.origin);
  part.carrier = selectRows(skin.carrier, vertices.origin);
  if (!skin.offsets.empty())
    part.offsets = {selected(skin.offsets.offset, vertices.origin), selected(skin.offsets.patch, vertices.origin),
                    skin.offsets.frames};
  resetWall(part);
  part.wall.material = skin.wall.material;
  return part;
}

bool meetsPeriod(const Skin& skin, const geometry::Periodicity& periodicity) {
  constexpr double roundOff = 1e-9;
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodicity.axes[static_cast<std::size_t>(axis)]) continue;
    const auto [least, largest] = std::ranges::minmax(skin.X, {}, [&](const Vec3& X) { return X[axis]; });
    if (largest[axis] - least[axis] > (1.0 - roundOff) * periodicity.length(axis)) return true;
  }
  return false;
}

bool hasKernel(const Skin& skin) {
  return skin.carrier.column != skin.localMap.column || skin.carrier.weight != skin.localMap.weight;
}

void place(Skin& skin, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> vertices) {
  placePoints(skin.carrier, skin.X, skin.offsets, u, v, vertices, skin.wall.x, skin.wall.v);
}

void place(Skin& skin, std::span<const Vec3> u, std::span<const Vec3> v) { place(skin, u, v, numbers(skin.X.size())); }

}  // namespace dovetail::surface
