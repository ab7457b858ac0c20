// Scenes with a solid of material points.
#pragma once

#include <numeric>
#include <string>
#include <vector>

#include "build/parts.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/mpm/point_solid.hpp"
#include "scene_parts.hpp"

namespace dovetail::scene::test::points {

inline const std::string law =
    R"("material": {"law": "neo-Hookean", "youngs_modulus": 1e5, "poisson_ratio": 0.3, "density": 1000})";

/// @param points, grid  keys of the two @param more  keys of the solid
inline std::string body(const std::string& points, const std::string& grid, const std::string& more = law) {
  return R"("solids": [{"name": "snow", "mesh": "points", "points": {)" + points + R"(}, "grid": {)" + grid + "}, " +
         more + "}],";
}
inline const std::string box = R"("from": "box", "box": [[0, 0, 0], [0.2, 0.4, 0.05]])";
inline const std::string plane = R"("spacing": 0.05, "plane_strain": true)";
inline const std::string base = R"(, "borders": [{"side": "y-", "at": 0}])";

inline const mpm::PointSolid& pointsIn(const Built& built) { return *materialPoints(*built.run->solid(0).model); }
inline double massIn(const Built& built) {
  const std::vector<double>& mass = pointsIn(built).masses();
  return std::accumulate(mass.begin(), mass.end(), 0.0);
}

}  // namespace dovetail::scene::test::points
