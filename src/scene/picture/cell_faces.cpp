#include "cell_faces.hpp"

#include <algorithm>
#include <array>

namespace dovetail::scene {

namespace {

using picture::Triangle;

/// Corners of a cell's faces in the order of VTK; -1 where a face has three.
struct Shape {
  int corners;
  std::vector<std::array<int, 4>> faces;
  std::vector<std::array<int, 2>> edges;  ///< with a node in the middle from `corners` on, where cells are quadratic
  std::vector<std::array<int, 4>> tetrahedra;  ///< that fill it
};

const Shape hexahedron{8,
                       {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}},
                       {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}},
                       {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};
const Shape tetrahedron{4,
                        {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}},
                        {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}},
                        {{0, 1, 2, 3}}};
const Shape quadrilateral{4, {{0, 1, 2, 3}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {}};
const Shape triangle{3, {{0, 1, 2, -1}}, {{0, 1}, {1, 2}, {2, 0}}, {}};

const Shape* shapeOf(int vtkType) {
  switch (vtkType) {
    case 12:
    case 25:
    case 29:
      return &hexahedron;
    case 10:
    case 24:
      return &tetrahedron;
    case 9:
    case 23:
    case 28:
      return &quadrilateral;
    case 5:
    case 22:
      return &triangle;
    default:
      return nullptr;
  }
}

struct Cell {
  const Shape* shape;
  const std::size_t* point;
  std::size_t points;

  /// Number of the edge between two corners, or none.
  std::optional<std::size_t> edge(int a, int b) const {
    for (std::size_t e = 0; e < shape->edges.size(); ++e)
      if (const auto [p, q] = shape->edges[e]; (p == a && q == b) || (p == b && q == a)) return e;
    return std::nullopt;
  }
  /// The node in the middle of an edge, or none.
  std::optional<std::size_t> middle(int a, int b) const {
    const auto e = edge(a, b);
    const std::size_t k = static_cast<std::size_t>(shape->corners) + e.value_or(points);
    return k < points ? std::optional(point[k]) : std::nullopt;
  }
};

std::vector<Cell> cellsOf(const io::FrameContent& frame) {
  std::vector<Cell> cells;
  std::size_t begin = 0;
  for (std::size_t c = 0; c < frame.cellType.size(); ++c) {
    if (const Shape* const shape = shapeOf(frame.cellType[c]))
      cells.push_back({shape, frame.cellPoint.data() + begin, frame.cellEnd[c] - begin});
    begin = frame.cellEnd[c];
  }
  return cells;
}

struct Corner {
  Vec3 at;
  float value;
};

Corner middleOf(const Corner& a, const Corner& b, double fraction) {
  return {a.at + fraction * (b.at - a.at), a.value + static_cast<float>(fraction) * (b.value - a.value)};
}

class Surface {
public:
  Surface(const std::vector<Vec3>& place, const std::vector<float>& value, std::uint8_t paint)
      : place_(place), value_(value), paint_(paint) {}

  Corner corner(std::size_t point) const { return {place_[point], value_.empty() ? 0.0F : value_[point]}; }

  void add(const Corner& a, const Corner& b, const Corner& c, std::uint8_t edges) {
    triangles.push_back({{a.at, b.at, c.at}, {a.value, b.value, c.value}, paint_, edges});
  }

  /// A face as a fan around its middle, with lines along its edges.
  void addFace(const Cell& cell, const std::array<int, 4>& face) {
    std::vector<Corner> rim;
    const std::size_t sides = face[3] < 0 ? 3 : 4;
    for (std::size_t k = 0; k < sides; ++k) {
      const int a = face[k], b = face[(k + 1) % sides];
      rim.push_back(corner(cell.point[a]));
      if (const auto m = cell.middle(a, b)) rim.push_back(corner(*m));
    }
    if (rim.size() == 3) return add(rim[0], rim[1], rim[2], 7);
    Corner centre{{}, 0.0F};
    for (const Corner& c : rim) {
      centre.at += c.at / static_cast<double>(rim.size());
      centre.value += c.value / static_cast<float>(rim.size());
    }
    for (std::size_t k = 0; k < rim.size(); ++k) add(rim[k], rim[(k + 1) % rim.size()], centre, 1);
  }

  /// The section of the tetrahedra of a cell. Lines are drawn where it meets a face of the cell.
  void addSection(const Cell& cell, const Cut& cut) {
    for (const auto& tet : cell.shape->tetrahedra) {
      std::array<Corner, 4> c;
      std::array<double, 4> height;
      std::vector<int> before, after;
      bool reachesBehind = false;
      for (std::size_t k = 0; k < 4; ++k) {
        c[k] = corner(cell.point[tet[k]]);
        height[k] = cut.height(c[k].at);
        (height[k] > 0.0 ? before : after).push_back(static_cast<int>(k));
        reachesBehind = reachesBehind || height[k] < 0.0;
      }
      // Of those that only touch the plane, one with a whole face in it has a section.
      if (before.empty() || (!reachesBehind && after.size() != 3)) continue;
      // Edges of the tetrahedron that are cut, in turn around the section.
      std::vector<std::array<int, 2>> ring;
      for (const int b : before)
        for (const int a : after) ring.push_back({b, a});
      if (ring.size() == 4) std::swap(ring[2], ring[3]);
      std::vector<Corner> rim;
      for (const auto [b, a] : ring) {
        const auto i = static_cast<std::size_t>(b), j = static_cast<std::size_t>(a);
        rim.push_back(middleOf(c[i], c[j], height[i] / (height[i] - height[j])));
      }
      const auto line = [&](std::size_t k) {
        const std::array<int, 2> one = ring[k], next = ring[(k + 1) % ring.size()];
        if (reachesBehind) return onFace(cell, tet, one, next);
        return cell.edge(tet[static_cast<std::size_t>(one[1])], tet[static_cast<std::size_t>(next[1])]) ? 1 : 0;
      };
      if (rim.size() == 3) {
        add(rim[0], rim[1], rim[2], static_cast<std::uint8_t>(line(0) | line(1) << 1 | line(2) << 2));
      } else {
        add(rim[0], rim[1], rim[2], static_cast<std::uint8_t>(line(0) | line(1) << 1));
        add(rim[2], rim[3], rim[0], static_cast<std::uint8_t>(line(2) | line(3) << 1));
      }
    }
  }

  std::vector<Triangle> triangles;

private:
  /// Whether the face of a tetrahedron with both of its edges lies on a face of the cell.
  static int onFace(const Cell& cell, const std::array<int, 4>& tet, std::array<int, 2> one, std::array<int, 2> other) {
    for (const auto& face : cell.shape->faces) {
      const auto isIn = [&](int k) {
        return std::find(face.begin(), face.end(), tet[static_cast<std::size_t>(k)]) != face.end();
      };
      if (isIn(one[0]) && isIn(one[1]) && isIn(other[0]) && isIn(other[1])) return 1;
    }
    return 0;
  }

  const std::vector<Vec3>& place_;
  const std::vector<float>& value_;
  std::uint8_t paint_;
};

struct Face {
  std::array<std::size_t, 4> corners;  ///< sorted
  std::size_t cell, number;
};

/// Faces with the same corners cancel.
std::vector<Face> outerFaces(const std::vector<Cell>& cells) {
  std::vector<Face> all, outer;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t f = 0; f < cells[c].shape->faces.size(); ++f) {
      Face face{{0, 0, 0, 0}, c, f};
      for (std::size_t k = 0; k < 4; ++k)
        if (const int corner = cells[c].shape->faces[f][k]; corner >= 0) face.corners[k] = cells[c].point[corner] + 1;
      std::sort(face.corners.begin(), face.corners.end());
      all.push_back(face);
    }
  std::stable_sort(all.begin(), all.end(), [](const Face& a, const Face& b) { return a.corners < b.corners; });
  for (std::size_t k = 0; k < all.size(); ++k)
    if ((k == 0 || all[k - 1].corners != all[k].corners) &&
        (k + 1 == all.size() || all[k + 1].corners != all[k].corners))
      outer.push_back(all[k]);
  return outer;
}

}  // namespace

std::vector<double> atPoints(const io::FrameContent& frame, const std::vector<double>& ofCells) {
  std::vector<double> sum(frame.position.size()), count(frame.position.size());
  std::size_t k = 0;
  for (std::size_t c = 0; c < frame.cellEnd.size() && c < ofCells.size(); ++c)
    for (; k < frame.cellEnd[c]; ++k) {
      sum[frame.cellPoint[k]] += ofCells[c];
      count[frame.cellPoint[k]] += 1.0;
    }
  for (std::size_t p = 0; p < sum.size(); ++p) sum[p] /= std::max(1.0, count[p]);
  return sum;
}

std::vector<Triangle> surfaceOf(const io::FrameContent& frame, const std::vector<Vec3>& place,
                                const std::vector<float>& value, std::uint8_t paint, const std::optional<Cut>& cut) {
  const std::vector<Cell> cells = cellsOf(frame);
  Surface surface(place, value, paint);
  for (const Face& face : outerFaces(cells))
    surface.addFace(cells[face.cell], cells[face.cell].shape->faces[face.number]);
  surface.triangles = behind(surface.triangles, cut);
  if (cut)
    for (const Cell& cell : cells) surface.addSection(cell, *cut);
  return std::move(surface.triangles);
}

std::vector<Triangle> behind(const std::vector<Triangle>& triangles, const std::optional<Cut>& cut) {
  if (!cut) return triangles;
  std::vector<Triangle> kept;
  for (const Triangle& t : triangles) {
    // The polygon that is left, with a mark for each side that had a line.
    std::vector<std::pair<Corner, int>> rim;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const Corner a{t.corner[k], t.value[k]}, b{t.corner[next], t.value[next]};
      const double from = cut->height(a.at), to = cut->height(b.at);
      const int line = t.edges >> k & 1;
      if (from <= 0.0) rim.emplace_back(a, line);
      if ((from > 0.0) == (to > 0.0)) continue;
      rim.emplace_back(middleOf(a, b, from / (from - to)), from > 0.0 ? line : 0);
    }
    for (std::size_t k = 2; k < rim.size(); ++k) {
      const auto& [a, lineA] = rim[0];
      const auto& [b, lineB] = rim[k - 1];
      const auto& [c, lineC] = rim[k];
      const int edges = (k == 2 ? lineA : 0) | lineB << 1 | (k + 1 == rim.size() ? lineC << 2 : 0);
      kept.push_back({{a.at, b.at, c.at}, {a.value, b.value, c.value}, t.paint, static_cast<std::uint8_t>(edges)});
    }
  }
  return kept;
}

}  // namespace dovetail::scene
