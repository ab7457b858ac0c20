#include "grid_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"

namespace dovetail::mpm::detail {

namespace {

using Number = std::int64_t;
constexpr Number mostAlong = 1 << 20;

/// Nodes of a box, numbered along x, y, z.
struct Box {
  Index low{};
  std::array<Number, 3> stride{1, 1, 1};

  Number numberOf(const Index& node) const {
    Number number = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) number += stride[axis] * (node[axis] - low[axis]);
    return number;
  }
  Index indexOf(Number number) const {
    Index node = low;
    for (std::size_t axis = 3; axis-- > 0; number %= stride[axis])
      node[axis] += static_cast<int>(number / stride[axis]);
    return node;
  }
};

/// Around all that the points reach and its mirror images.
Box boxAround(const std::vector<Index>& first, int reach, const std::string& name) {
  Box box;
  Number stride = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::ranges::minmax_element(first, {}, [axis](const Index& node) { return node[axis]; });
    const Number along = Number{(*high)[axis]} - (*low)[axis] + 3 * reach;
    if (along > mostAlong)
      throw NumericalError("points " + std::to_string(low - first.begin()) + " and " +
                               std::to_string(high - first.begin()) + " are " + std::to_string(along - 3 * reach) +
                               " cells apart",
                           name, "take a smaller step or load, or a coarser grid");
    box.low[axis] = (*low)[axis] - reach;
    box.stride[axis] = stride;
    stride *= along;
  }
  return box;
}

/// Sorts points into cells. @return lowest nodes of the cells, ascending
std::vector<Number> sortIntoCells(const Box& box, const std::vector<Index>& first, GridRows& rows) {
  std::vector<std::pair<Number, int>> order(first.size());
  for (std::size_t p = 0; p < first.size(); ++p) order[p] = {box.numberOf(first[p]), static_cast<int>(p)};
  std::ranges::sort(order);
  rows.cell.resize(first.size());
  rows.pointOfCell.reserve(first.size());
  std::vector<Number> cells;
  for (const auto& [number, p] : order) {
    if (cells.empty() || cells.back() != number) {
      cells.push_back(number);
      rows.firstOfCell.push_back(static_cast<int>(rows.pointOfCell.size()));
    }
    rows.pointOfCell.push_back(p);
    rows.cell[static_cast<std::size_t>(p)] = static_cast<int>(cells.size()) - 1;
  }
  rows.firstOfCell.push_back(static_cast<int>(rows.pointOfCell.size()));
  return cells;
}

/// Every number and those 1 … reach − 1 strides above.
std::vector<Number> spread(const std::vector<Number>& numbers, Number stride, int reach) {
  std::vector<Number> all = numbers, shifted = numbers, merged;
  for (int k = 1; k < reach; ++k) {
    for (Number& number : shifted) number += stride;
    merged.clear();
    std::ranges::set_union(all, shifted, std::back_inserter(merged));
    all.swap(merged);
  }
  return all;
}

/// Puts a node beyond a border in the place of its mirror image. @return components with the other sign
std::uint8_t fold(const GridOptions& grid, Index& node) {
  std::uint8_t flip = 0;
  for (const GridBorder& border : grid.borders) {
    int& i = node[static_cast<std::size_t>(border.axis)];
    const int at = nodeOf(grid, border);
    if (border.above ? i <= at : i >= at) continue;
    i = 2 * at - i;
    flip ^= static_cast<std::uint8_t>(border.kind == BorderKind::held ? 7 : 1 << border.axis);
  }
  return flip;
}

std::uint8_t fixedAt(const GridOptions& grid, const Index& node) {
  std::uint8_t fixed = grid.plane ? 4 : 0;
  for (const GridBorder& border : grid.borders)
    if (node[static_cast<std::size_t>(border.axis)] == nodeOf(grid, border))
      fixed |= static_cast<std::uint8_t>(border.kind == BorderKind::held ? 7 : 1 << border.axis);
  return fixed;
}

Vec3 placeOf(const GridOptions& grid, const Index& node) {
  const Vec3 x = grid.origin + grid.spacing * Vec3{1.0 * node[0], 1.0 * node[1], 1.0 * node[2]};
  return grid.plane ? Vec3{x.x, x.y, 0.0} : x;
}

/// Nodes before any is mirrored, ascending, and what becomes of them.
struct Reached {
  std::vector<Number> number;
  std::vector<int> node;  // in the rows
  std::vector<std::uint8_t> flip;
  std::vector<Vec3> place;
};

Reached reachedFrom(const GridOptions& grid, const Box& box, const std::vector<Number>& cells, GridRows& rows) {
  Reached reached;
  reached.number = cells;
  for (int axis = 0; axis < axesOf(grid); ++axis)
    reached.number = spread(reached.number, box.stride[static_cast<std::size_t>(axis)], reachOf(grid.shape));
  std::vector<Number> image;
  for (const Number number : reached.number) {
    Index node = box.indexOf(number);
    reached.place.push_back(placeOf(grid, node));
    reached.flip.push_back(fold(grid, node));
    image.push_back(box.numberOf(node));
  }
  std::vector<Number> nodes = image;
  if (!std::ranges::is_sorted(nodes)) std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  for (const Number number : nodes) {
    const Index node = box.indexOf(number);
    rows.X.push_back(placeOf(grid, node));
    rows.fixed.push_back(fixedAt(grid, node));
  }
  for (const Number number : image)
    reached.node.push_back(static_cast<int>(std::ranges::lower_bound(nodes, number) - nodes.begin()));
  return reached;
}

/// Calls visit(c, place of the node among those reached) for the node of each cell that is `above` its lowest.
template <class Visit>
void follow(const std::vector<Number>& cells, Number above, const Reached& reached, Visit&& visit) {
  std::size_t at = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    while (reached.number[at] < cells[c] + above) ++at;
    visit(c, at);
  }
}

/// Places of values 0 … count − 1 in `of`, ascending: CSR.
void sortInto(const std::vector<int>& of, std::size_t count, std::vector<int>& first, std::vector<int>& places) {
  first.assign(count + 1, 0);
  for (const int value : of) ++first[static_cast<std::size_t>(value) + 1];
  for (std::size_t k = 0; k < count; ++k) first[k + 1] += first[k];
  places.resize(of.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < of.size(); ++k)
    places[static_cast<std::size_t>(next[static_cast<std::size_t>(of[k])]++)] = static_cast<int>(k);
}

}  // namespace

int nodeOf(const GridOptions& grid, const GridBorder& border) {
  return static_cast<int>(std::lround((border.place - grid.origin[border.axis]) / grid.spacing));
}

void findNodes(const GridOptions& grid, const std::vector<Index>& first, const std::string& name, GridRows& rows) {
  const int reach = reachOf(grid.shape);
  const Box box = boxAround(first, reach, name);
  const std::vector<Number> cells = sortIntoCells(box, first, rows);
  const Reached reached = reachedFrom(grid, box, cells, rows);
  rows.node.resize(rows.perPoint * cells.size());
  rows.flip.resize(rows.node.size());
  rows.reached.resize(rows.node.size());
  for (std::size_t a = 0; a < rows.perPoint; ++a) {
    const auto i = static_cast<int>(a) % reach, j = static_cast<int>(a) / reach % reach,
               k = static_cast<int>(a) / (reach * reach);
    follow(cells, box.stride[0] * i + box.stride[1] * j + box.stride[2] * k, reached,
           [&](std::size_t c, std::size_t n) {
             rows.node[rows.perPoint * c + a] = reached.node[n];
             rows.flip[rows.perPoint * c + a] = reached.flip[n];
             rows.reached[rows.perPoint * c + a] = reached.place[n];
           });
  }
  sortInto(rows.node, rows.nodes(), rows.firstOfNode, rows.entryOfNode);
}

}  // namespace dovetail::mpm::detail
