// Whether a sphere touches anybody.
#pragma once

#include <vector>

#include "dovetail/dem/setup/insertion.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

/// Particles and facets that reach into a region, with their periodic images.
class FreeRoom {
public:
  /// @throws InputError if a period is below two diameters
  FreeRoom(const Particles& particles, const Surroundings& surroundings, const geometry::Box& region);

  bool isFree(const Vec3& x, double radius) const;
  /// A newcomer, which the next ones see.
  void add(const Vec3& x, double radius);

private:
  using Triangle = std::array<Vec3, 3>;
  struct Facet {
    Triangle corner;
    bool oneSided;
  };
  void addFacets(const TriangulatedWall& wall, const geometry::Box& region);
  void sortIn();
  bool clearOf(std::size_t i, const Vec3& x, double radius) const;
  bool clearOfWalls(const Vec3& x, double radius) const;
  bool clearOfFacets(const Vec3& x, double radius) const;

  const Surroundings& surroundings_;
  std::vector<Vec3> shifts_;  // of space onto itself, no shift among them
  std::vector<Vec3> x_;
  std::vector<double> radius_;
  std::size_t sorted_ = 0;  // those in the grid; later ones are looked at one by one
  geometry::HierarchicalGrid grid_;
  std::vector<Facet> facets_;
};

}  // namespace dovetail::dem
