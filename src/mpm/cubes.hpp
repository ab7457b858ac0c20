// Points by cubes, for those near a place.
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::mpm::detail {

/// Points by cubes of an edge, m.
class Cubes {
public:
  Cubes(double edge, std::span<const Vec3> x) : edge_(edge), x_(x) {
    for (std::size_t p = 0; p < x.size(); ++p) points_[cubeOf(x[p])].push_back(p);
  }
  /// Calls visit(point, distance) for those in the cubes around, which hold all within an edge.
  template <class Visit>
  void near(const Vec3& place, Visit&& visit) const {
    const Cube centre = cubeOf(place);
    for (int k = -1; k <= 1; ++k)
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i)
          if (const auto found = points_.find({centre[0] + i, centre[1] + j, centre[2] + k}); found != points_.end())
            for (const std::size_t p : found->second) visit(p, norm(x_[p] - place));
  }

private:
  using Cube = std::array<long, 3>;
  Cube cubeOf(const Vec3& x) const {
    return {std::lround(x.x / edge_), std::lround(x.y / edge_), std::lround(x.z / edge_)};
  }
  double edge_;
  std::span<const Vec3> x_;
  std::map<Cube, std::vector<std::size_t>> points_;
};

}  // namespace dovetail::mpm::detail
