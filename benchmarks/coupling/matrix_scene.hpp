// Scenes of the matrix: grains of several sizes between walls, under gravity, on or in a solid of a few elements.
#pragma once

#include <memory>

#include "dovetail/core/quaternion.hpp"
#include "dovetail/coupling/run.hpp"
#include "matrix_case.hpp"

namespace dovetail::coupling_matrix {

/// How a scene is laid into space. Lengths are multiplied by `length`, moduli, stiffnesses, velocities and gravity so
/// that times and densities stay: a scene of another length is the same scene.
struct Placement {
  double length = 1.0;
  Quaternion turn{};
  Vec3 shift{};  ///< m, after the turn
  /// The solid's reference stays where it is and its nodes are displaced; else its reference is laid there too.
  bool byDisplacement = false;

  Vec3 direction(const Vec3& a) const { return rotate(turn, length * a); }
  Vec3 place(const Vec3& x) const { return direction(x) + shift; }
};

/// Not started. Surface: 32 grains fall on a block of 2 × 2 × 1 cells that is held below. Overlap: 54 grains reach two
/// cells deep into a column of three that is held below. All move at random, so that friction works.
/// @throws InputError for what cannot be combined
std::unique_ptr<coupling::CoupledRun> makeScene(const Case& c, const Placement& placement = {});

/// K, and 'share' of the critical step of the scene at its start, s; the run is then started.
void startAt(coupling::CoupledRun& run, const Case& c, double fraction);

}  // namespace dovetail::coupling_matrix
