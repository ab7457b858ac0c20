// Ways of a cell to rest: paths, relaxation, preparation.
#pragma once

#include <cstdint>

#include "dovetail/core/rest.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Relaxes the grains under constant F by FIRE (dem::Fire); contacts slip and remember as in any step. What that takes
/// is booked as damping; afterwards velocities are zero.
/// @throws InputError if a setting is not valid; NumericalError as step
RestReport relax(Rve& cell, const RestCriterion& rest = {}, double stepFraction = 0.8);

/// Newton's method on the network of contacts (operators.hpp), from a relaxed state; the cell is left as it was at the
/// best of the iterations. Converges in a few as long as no contact begins or ends to touch or slip.
RestReport polish(Rve& cell, double tolerance = 1e-10, int iterations = 10);

struct PathOptions {
  /// I of the path, in (0, 1e-2]: its duration is γ d / (I √(p/ρ)), with γ the difference of the principal strains
  /// (DeformationPath::strains; or the largest of them, if that is more), d the mean diameter and p the pressure at the
  /// start, at least 1e-6 of mean k_n/d (spheres) or k_n over thickness (discs) (Desrues et al. 2019, eqs 3, 16–18).
  double inertialNumber = 1e-3;
  double damping = 0.7;  ///< as in step, in [0, 1)
  double stepFraction = 0.8;
  RestCriterion rest = {};  ///< at the end; rest.steps = 0: the cell is left in motion
};

struct PathReport {
  std::int64_t steps = 0;        ///< of the path
  double kineticFraction = 0.0;  ///< kinetic energy over the work of the boundary, at the end of the path
  RestReport rest;
};

/// Goes from the present deformation to F along a DeformationPath in proportion to time, then relaxes. A turn takes no
/// time and strains nothing.
/// @throws InputError if F is more than 5 % of strain away (DeformationPath::strain), does not fit discs, det F ≤ 0, or
/// a setting is not valid
PathReport followPath(Rve& cell, const Eigen::Matrix3d& F, const PathOptions& settings = {});

struct CompressionOptions {
  Vec3 pressure{1e5, 1e5, 1e5};  ///< wanted along x, y, z, > 0, Pa; discs: the third does not count
  double friction = 0.5;         ///< of the contacts meanwhile
  double tolerance = 1e-3;       ///< of the pressures, relative
  double inertialNumber = 1e-2;  ///< of the fastest strain rate
  double damping = 0.7;
  RestCriterion rest = {};
  double stepFraction = 0.8;
  std::int64_t steps = 1000000;  ///< given up after so many
};

/// Strains a cell that repeats along its axes until it presses as wanted, at rest. Each strain rate is in proportion to
/// what is missing. Then the springs have the cell's own friction again; if contacts slip by that, the same is done
/// with it. F = 1 and volume are those of the new state, and the book begins anew.
/// @throws InputError if a setting is not valid or the cell is framed; NumericalError if it gives up, or as
/// step; the cell is then where it got to, with the friction of the preparation
void compress(Rve& cell, const CompressionOptions& settings);

}  // namespace dovetail::rve
