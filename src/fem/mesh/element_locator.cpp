#include "dovetail/fem/mesh/element_locator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/shape.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "parent_coordinates.hpp"
#include "shapes.hpp"

namespace dovetail::fem {

namespace {

std::string label(int element) { return "element " + std::to_string(element); }

bool contains(const geometry::Box& box, const Vec3& x) {
  for (int c = 0; c < 3; ++c)
    if (x[c] < box.lower[c] || x[c] > box.upper[c]) return false;
  return true;
}

/// Grown by what round-off may do to a point on its border.
geometry::Box withRoundOff(const geometry::Box& box) {
  double size = 0.0;
  for (int c = 0; c < 3; ++c) size = std::max({size, std::abs(box.lower[c]), std::abs(box.upper[c])});
  return geometry::expanded(box,
                            64.0 * std::numeric_limits<double>::epsilon() * size + 1e-9 * norm(box.upper - box.lower));
}

void requireNodes(std::span<const ElementGroup> groups, std::size_t count) {
  int first = 0;
  for (const ElementGroup& group : groups) {
    const auto bad =
        std::ranges::find_if(group.node, [&](int n) { return n < 0 || static_cast<std::size_t>(n) >= count; });
    if (bad != group.node.end())
      throw InputError("node " + std::to_string(*bad) + " does not exist",
                       label(first + static_cast<int>(bad - group.node.begin()) / nodesOf(group.shape)),
                       "use node numbers of the mesh");
    first += static_cast<int>(group.size());
  }
}

/// From a point outside to the faces between the corners of a cell, m.
double distanceTo(ElementShape shape, std::span<const Vec3> nodes, const Vec3& x) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Face& face : localFacesOf(shape)) {
    const auto corner = [&](std::size_t k) { return nodes[static_cast<std::size_t>(face.node[k])]; };
    const int corners = cornersOf(face.shape);
    for (std::size_t k = 1; k == 1 || static_cast<int>(k) + 1 < corners; ++k) {
      const Vec3 third = corners == 2 ? corner(1) : corner(k + 1);
      nearest = std::min(nearest, norm(geometry::closestPointOnTriangle(x, corner(0), corner(k), third).point - x));
    }
  }
  return nearest;
}

constexpr double nearer = 1e-9;  // relative: what is nearer by less is as near

/// Positions of the nodes of one element.
class CellNodes {
public:
  CellNodes(std::span<const int> node, std::span<const Vec3> position) : count_(node.size()) {
    for (std::size_t a = 0; a < count_; ++a) x_[a] = position[static_cast<std::size_t>(node[a])];
  }
  operator std::span<const Vec3>() const { return std::span(x_).first(count_); }

private:
  std::size_t count_;
  std::array<Vec3, detail::maxCellNodes> x_;
};

}  // namespace

ElementLocator::ElementLocator(const SolidMesh& mesh) : ElementLocator(mesh.groups, mesh.X) {}

ElementLocator::ElementLocator(std::span<const ElementGroup> groups, std::span<const Vec3> position)
    : groups_(groups.begin(), groups.end()), position_(position.begin(), position.end()) {
  requireNodes(groups, position.size());
  requireFinite(position, "node", "position", "search for elements");
  int count = 0;
  for (const ElementGroup& group : groups) end_.push_back(count += static_cast<int>(group.size()));
  if (count == 0) throw InputError("there are no elements", "ElementLocator", "give the elements of the solid's mesh");
  plane_ = dimensionOf(cell(0).shape) == 2;
  std::vector<Vec3> centre;
  std::vector<double> radius;
  for (int e = 0; e < count; ++e) {
    const geometry::Box box = detail::boxOf(cell(e).shape, CellNodes(cell(e).node, position_));
    if (box.lower == box.upper)
      throw InputError("all its nodes are at one place", label(e), "give an element with a volume");
    box_.push_back(withRoundOff(box));
    centre.push_back(0.5 * (box.lower + box.upper));
    radius.push_back(0.5 * norm(box_.back().upper - box_.back().lower));
  }
  grid_.build(centre, radius);
}

ElementLocator::Cell ElementLocator::cell(int element) const {
  const auto k = static_cast<std::size_t>(std::ranges::upper_bound(end_, element) - end_.begin());
  const auto first = static_cast<std::size_t>(element - (k == 0 ? 0 : end_[k - 1]));
  const auto count = static_cast<std::size_t>(nodesOf(groups_[k].shape));
  return {groups_[k].shape, std::span(groups_[k].node).subspan(first * count, count)};
}

CellPlace ElementLocator::placeAt(int element, const Vec3& xi) const {
  return {element, xi, shapeRow(cell(element).shape, xi)};
}

Vec3 ElementLocator::inPlane(const Vec3& point) const {
  if (!isFinite(point)) throw InputError("the point is not finite", "ElementLocator", "give a position");
  return plane_ ? Vec3{point.x, point.y, position_[static_cast<std::size_t>(cell(0).node[0])].z} : point;
}

std::optional<CellPlace> ElementLocator::find(const Vec3& point) const {
  const Vec3 x = inPlane(point);
  std::vector<int> beyond;  // elements that Newton's method left
  for (const int e : grid_.query({x, x})) {
    if (!contains(box_[static_cast<std::size_t>(e)], x)) continue;
    const CellNodes nodes(cell(e).node, position_);
    const detail::ParentGuess guess = detail::guessParent(cell(e).shape, nodes, x);
    if (guess.verdict == detail::Verdict::inside) return placeAt(e, guess.xi);
    if (guess.verdict == detail::Verdict::outside) beyond.push_back(e);
    if (guess.verdict != detail::Verdict::unsettled) continue;
    if (const auto xi = detail::searchParent(cell(e).shape, nodes, x, label(e))) return placeAt(e, *xi);
  }
  for (const int e : beyond)
    if (const auto xi = detail::searchParent(cell(e).shape, CellNodes(cell(e).node, position_), x, label(e)))
      return placeAt(e, *xi);
  return std::nullopt;
}

std::optional<CellPlace> ElementLocator::findNear(const Vec3& point, double reach) const {
  if (auto place = find(point); place || !(reach > 0.0)) return place;
  const Vec3 x = inPlane(point);
  double nearest = reach;
  int element = -1;
  Vec3 xi;
  for (const int e : grid_.query(geometry::expanded({x, x}, reach))) {
    if (!contains(geometry::expanded(box_[static_cast<std::size_t>(e)], reach), x)) continue;
    const CellNodes nodes(cell(e).node, position_);
    const detail::ParentGuess guess = detail::guessParent(cell(e).shape, nodes, x);
    if (guess.verdict == detail::Verdict::unsettled) continue;
    const double distance = distanceTo(cell(e).shape, nodes, x);
    if (!(distance < nearest * (1.0 - nearer))) continue;
    nearest = distance, element = e, xi = guess.xi;
  }
  return element < 0 ? std::nullopt : std::optional(placeAt(element, xi));
}

}  // namespace dovetail::fem
