// What somebody would write by hand for one scene: frictionless springs between spheres of one size.
#pragma once

#include <array>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::overhead {

/// Arrays and a list of pairs of a frictionless periodic lattice, and a loop over them: velocity Verlet, one kick per
/// step, and a look at how far the spheres have moved since the list was made, which is what a step of the engine does.
/// Stops short of everything else: one radius, one mass, no sorting, no checks of numbers, one thread.
class HandLoop {
public:
  /// Copies places, velocities, forces and the list of pairs. @param stiffness  of the springs, N/m
  HandLoop(const dem::Model& model, double stiffness);

  /// @param dt  s; the first step makes half a kick, as the engine's first does
  void step(double dt);

  std::vector<Vec3> x, v, f;                 ///< m, m/s, N, in the order of the model
  bool listIsGood() const { return good_; }  ///< whether no sphere has moved by half of the list's inner skin
  std::size_t bytes() const;                 ///< held

private:
  struct Pair {
    int i, j;
    Vec3 shift;  // to be added to x_i − x_j, m
  };
  std::vector<std::array<int, 2>> within_;  // the same cell: no shift
  std::vector<Pair> across_;                // through a period
  std::vector<Vec3> start_;                 // where the list was made
  double diameter_, mass_, stiffness_, limit_;
  bool first_ = true, good_ = true;
};

}  // namespace dovetail::overhead
