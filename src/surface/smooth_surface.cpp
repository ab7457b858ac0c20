#include "dovetail/surface/smooth_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "carried_points.hpp"
#include "dovetail/core/error.hpp"
#include "face_cut.hpp"

namespace dovetail::surface {

namespace {

using Row = std::map<int, double>;  ///< a control point as a combination of skin vertices

struct Crossing {
  int face = -1, edge = -1;
};

/// For every face and edge (corner e to corner e + 1): the face that has the same edge the other way round.
std::vector<std::array<Crossing, 4>> makeCrossings(std::span<const std::array<int, 4>> quads) {
  std::map<std::pair<int, int>, Crossing> byEdge;
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int e = 0; e < 4; ++e)
      if (!byEdge.try_emplace({quads[q][e], quads[q][(e + 1) % 4]}, Crossing{static_cast<int>(q), e}).second)
        throw InputError("another face has the same edge the same way round", "face " + std::to_string(q),
                         "give each face of the surface once, counter-clockwise seen from outside");
  std::vector<std::array<Crossing, 4>> crossings(quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q)
    for (int e = 0; e < 4; ++e)
      if (const auto found = byEdge.find({quads[q][(e + 1) % 4], quads[q][e]}); found != byEdge.end())
        crossings[q][e] = found->second;
  return crossings;
}

/// The 4 × 4 net around one face, in the face's own axes.
class ControlNet {
public:
  Row& at(int i, int j) { return rows_[static_cast<std::size_t>((i + 1) + 4 * (j + 1))]; }
  const std::array<Row, 16>& rows() const { return rows_; }

private:
  std::array<Row, 16> rows_;
};

Row continued(const Row& last, const Row& before) {
  Row row;
  for (const auto& [vertex, weight] : last) row[vertex] += 2.0 * weight;
  for (const auto& [vertex, weight] : before) row[vertex] -= weight;
  return row;
}

/// Index pair of the net: corner e of the face, and the outward step across edge e.
constexpr std::array<std::array<int, 2>, 4> cornerIndex{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
constexpr std::array<std::array<int, 2>, 4> outward{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};

class NetBuilder {
public:
  NetBuilder(std::span<const std::array<int, 4>> quads, const std::vector<std::array<Crossing, 4>>& crossings)
      : quads_(quads), crossings_(crossings) {}

  ControlNet build(int face) const {
    ControlNet net;
    for (int e = 0; e < 4; ++e) cornerRow(net, e, {0, 0}) = Row{{quads_[face][e], 1.0}};
    for (int e = 0; e < 4; ++e) addSide(net, face, e);
    for (int e = 0; e < 4; ++e) addDiagonal(net, face, e);
    return net;
  }

private:
  static Row& cornerRow(ControlNet& net, int corner, std::array<int, 2> step) {
    return net.at(cornerIndex[corner][0] + step[0], cornerIndex[corner][1] + step[1]);
  }

  /// The two control points beyond edge e.
  void addSide(ControlNet& net, int face, int e) const {
    const int next = (e + 1) % 4;
    const auto [neighbour, edge] = crossings_[face][e];
    if (neighbour >= 0) {
      cornerRow(net, e, outward[e]) = Row{{quads_[neighbour][(edge + 2) % 4], 1.0}};
      cornerRow(net, next, outward[e]) = Row{{quads_[neighbour][(edge + 3) % 4], 1.0}};
      return;
    }
    const std::array<int, 2> inward{-outward[e][0], -outward[e][1]};
    cornerRow(net, e, outward[e]) = continued(cornerRow(net, e, {0, 0}), cornerRow(net, e, inward));
    cornerRow(net, next, outward[e]) = continued(cornerRow(net, next, {0, 0}), cornerRow(net, next, inward));
  }

  /// The control point diagonally beyond corner e, between edge e and the edge before it.
  void addDiagonal(ControlNet& net, int face, int e) const {
    const int before = (e + 3) % 4;
    const std::array<int, 2> across{outward[e][0], outward[e][1]}, side{outward[before][0], outward[before][1]};
    const std::array<int, 2> diagonal{across[0] + side[0], across[1] + side[1]};
    Row& target = cornerRow(net, e, diagonal);
    if (crossings_[face][e].face < 0) {
      const std::array<int, 2> inner{side[0] - across[0], side[1] - across[1]};
      target = continued(cornerRow(net, e, side), cornerRow(net, e, inner));
    } else if (crossings_[face][before].face < 0) {
      const std::array<int, 2> inner{across[0] - side[0], across[1] - side[1]};
      target = continued(cornerRow(net, e, across), cornerRow(net, e, inner));
    } else {
      target = Row{{vertexAcross(face, e), 1.0}};
    }
  }

  int vertexAcross(int face, int e) const {
    const auto [first, firstEdge] = crossings_[face][e];
    const auto [second, secondEdge] = crossings_[first][(firstEdge + 1) % 4];
    const auto [beside, besideEdge] = crossings_[face][(e + 3) % 4];
    const int expected = quads_[beside][(besideEdge + 3) % 4];
    if (second < 0 || quads_[second][(secondEdge + 2) % 4] != expected)
      throw InputError("a vertex of face " + std::to_string(face) + " has other than four faces inside a smooth patch",
                       "smooth surface", "use the flat surface for this mesh, or a regular surface mesh");
    return quads_[second][(secondEdge + 3) % 4];
  }

  std::span<const std::array<int, 4>> quads_;
  const std::vector<std::array<Crossing, 4>>& crossings_;
};

/// Numbers equal rows once, so that neighbouring faces share their control points.
class RowNumbers {
public:
  int number(const Row& row) {
    const auto [place, isNew] = numbers_.try_emplace(row, static_cast<int>(numbers_.size()));
    if (isNew) rows.push_back(row);
    return place->second;
  }
  std::vector<Row> rows;

private:
  std::map<Row, int> numbers_;
};

}  // namespace

SmoothSurface makeSmoothSurface(const Skin& whole) {
  Skin skin = whole;
  splitAtSharpEdges(skin);  // changes nothing if it has been done
  const std::vector<std::array<int, 4>> quads = quadsOf(skin.faces, "the smooth surface");
  const auto crossings = makeCrossings(quads);
  const NetBuilder builder(quads, crossings);
  SmoothSurface surface;
  RowNumbers controls;
  for (std::size_t face = 0; face < quads.size(); ++face) {
    const ControlNet net = builder.build(static_cast<int>(face));
    std::array<int, 16> control{};
    for (std::size_t k = 0; k < 16; ++k) control[k] = controls.number(net.rows()[k]);
    surface.control.push_back(control);
    std::array<int, 4> across{};
    for (int e = 0; e < 4; ++e) across[e] = crossings[face][e].face;
    surface.across.push_back(across);
  }
  surface.carrier.columns = skin.carrier.columns;
  surface.carrier.offsets.push_back(0);
  for (const Row& row : controls.rows) {
    Row nodes;
    Vec3 X, offset;
    for (const auto& [vertex, weight] : row) {
      X += weight * skin.X[vertex];
      if (!skin.offsets.empty()) offset += weight * skin.offsets.offset[vertex];
      for (int k = skin.carrier.offsets[vertex]; k < skin.carrier.offsets[vertex + 1]; ++k)
        nodes[skin.carrier.column[k]] += weight * skin.carrier.weight[k];
    }
    for (const auto& [node, weight] : nodes) {
      surface.carrier.column.push_back(node);
      surface.carrier.weight.push_back(weight);
    }
    surface.carrier.offsets.push_back(static_cast<int>(surface.carrier.column.size()));
    surface.X.push_back(X);
    if (skin.offsets.empty()) continue;
    surface.offsets.offset.push_back(offset);
    surface.offsets.patch.push_back(skin.offsets.patch[row.begin()->first]);
  }
  surface.offsets.frames = skin.offsets.frames;
  surface.oneSided = skin.wall.oneSided;
  surface.material = skin.wall.material;
  surface.x = surface.X;
  surface.v.resize(surface.X.size());
  return surface;
}

void place(SmoothSurface& surface, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const int> controls) {
  placePoints(surface.carrier, surface.X, surface.offsets, u, v, controls, surface.x, surface.v);
}

}  // namespace dovetail::surface
