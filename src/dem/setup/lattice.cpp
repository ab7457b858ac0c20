// Regular packings.
#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/packing.hpp"

namespace dovetail::dem {

namespace {

/// Edges of a right-angled cell and the centres in it, as fractions of the edges, for a nearest distance of one.
struct Cell {
  Vec3 edge;
  std::vector<Vec3> place;
};

Cell cellOf(Lattice lattice) {
  switch (lattice) {
    case Lattice::simpleCubic:
      return {{1.0, 1.0, 1.0}, {{0.0, 0.0, 0.0}}};
    case Lattice::bodyCentred: {
      const double a = 2.0 / std::sqrt(3.0);
      return {{a, a, a}, {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}}};
    }
    case Lattice::faceCentred: {
      const double a = std::sqrt(2.0);
      return {{a, a, a}, {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.0, 0.5}, {0.0, 0.5, 0.5}}};
    }
    case Lattice::hexagonal:
      return {{1.0, std::sqrt(3.0), std::sqrt(8.0 / 3.0)},
              {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 1.0 / 6.0, 0.5}, {0.0, 2.0 / 3.0, 0.5}}};
  }
  throw InputError("the lattice is not known", "lattice", "give one of the enumeration");
}

template <class Place>
void forEachPlace(const Cell& cell, const std::array<int, 3>& cells, double distance, Place&& place) {
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i)
        for (const Vec3& p : cell.place)
          place(distance * Vec3{(i + p.x) * cell.edge.x, (j + p.y) * cell.edge.y, (k + p.z) * cell.edge.z});
}

}  // namespace

Packing latticeBlock(Lattice lattice, const std::array<int, 3>& cells, double radius, double distance) {
  requirePositive(radius, "radius of a lattice");
  requirePositive(distance, "distance of a lattice");
  const Cell cell = cellOf(lattice);
  Packing packing;
  packing.space.axes = {true, true, true};
  for (int k = 0; k < 3; ++k) {
    const int count = cells[static_cast<std::size_t>(k)];
    if (count < 1)
      throw InputError("a block has " + std::to_string(count) + " cells along axis " + "xyz"[k], "lattice",
                       "give 1 or more");
    packing.space.box.upper[k] = count * cell.edge[k] * distance;
  }
  forEachPlace(cell, cells, distance, [&](const Vec3& x) { packing.centre.push_back(x); });
  packing.radius.assign(packing.centre.size(), radius);
  return packing;
}

namespace {

/// Cells along an axis of a box in which spheres lie between walls; `room` is that of their centres, m.
double cellsBetweenWalls(double room, double edge, double slack, int axis) {
  if (!(std::isfinite(room) && room >= -slack))
    throw InputError(std::string("no sphere fits between the walls along axis ") + "xyz"[axis], "lattice",
                     "give a finite box of at least one diameter");
  return std::floor(room / edge + 1e-9) + 1.0;
}

/// Along an axis on which the box repeats.
double cellsInPeriod(double length, double edge, int axis) {
  const double cells = std::max(1.0, std::round(length / edge));
  if (!(std::abs(length - cells * edge) <= 1e-6 * edge))
    throw InputError("the box is " + formatNumber(length) + " m long along the periodic axis " + "xyz"[axis] +
                         ", which is no multiple of the lattice's cell, " + formatNumber(edge) + " m",
                     "lattice",
                     "make it " + formatNumber(cells * edge) + " m, or the distance of the centres " +
                         formatNumber(length / (cells * edge)) + " times as large");
  return cells;
}

}  // namespace

Packing fillWithLattice(Lattice lattice, const geometry::Box& box, double radius, double distance,
                        const std::array<bool, 3>& periodic) {
  requirePositive(radius, "radius of a lattice");
  requirePositive(distance, "distance of a lattice");
  Cell cell = cellOf(lattice);
  const geometry::Periodicity space{box, periodic};
  Packing packing{{}, {}, space};
  const double slack = 1e-9 * distance;  // so that a box made for a whole number of spheres holds them
  std::array<int, 3> cells{};
  Vec3 room;
  for (int k = 0; k < 3; ++k) {
    const bool repeats = periodic[static_cast<std::size_t>(k)];
    room[k] = repeats ? space.length(k) : space.length(k) - 2.0 * radius;
    const double edge = cell.edge[k] * distance;
    const double count = repeats ? cellsInPeriod(room[k], edge, k) : cellsBetweenWalls(room[k], edge, slack, k);
    if (!(count <= 1e6)) throw InputError("the box is too large for the lattice", "lattice", "give a smaller box");
    cells[static_cast<std::size_t>(k)] = static_cast<int>(count);
    if (repeats) cell.edge[k] = room[k] / count / distance;
  }
  const Vec3 first = box.lower + Vec3{radius, radius, radius};
  forEachPlace(cell, cells, distance, [&](const Vec3& x) {
    for (int k = 0; k < 3; ++k)
      if (x[k] > room[k] + slack) return;
    packing.centre.push_back(first + x);
  });
  packing.radius.assign(packing.centre.size(), radius);
  return packing;
}

}  // namespace dovetail::dem
