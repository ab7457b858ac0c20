// Bonds between discs of a cell.
#pragma once

#include <limits>

namespace dovetail::rve {

struct Rve;

/// A bond presses and pulls with k_n, resists sliding with k_s and turning with k_θ, and breaks for good when
/// f_n/f_n^u + |f_s|/f_s^u + |m|/m^u reaches 1, f_n > 0 tension, so that pressure delays it (Liu, thesis TU Eindhoven
/// 2018, eqs 2.7–2.8). What has broken is a contact with the springs of the cell.
struct BondLaw {
  double normal = 0.0;                                               ///< k_n, N/m; 0: there are no bonds
  double shear = 0.0;                                                ///< k_s, N/m, ≥ 0
  double bending = 0.0;                                              ///< k_θ, N m, ≥ 0
  double tensileStrength = std::numeric_limits<double>::infinity();  ///< f_n^u, N, > 0
  double shearStrength = std::numeric_limits<double>::infinity();    ///< f_s^u, N, > 0
  double bendingStrength = std::numeric_limits<double>::infinity();  ///< m^u, N m, > 0

  friend bool operator==(const BondLaw&, const BondLaw&) = default;
};

/// @throws InputError unless k_n > 0, k_s and k_θ ≥ 0, all finite, and strengths > 0
void validate(const BondLaw& law);

/// Of a contact that is bonded.
struct Bond {
  double length = 0.0;    ///< of the branch where the bond neither presses nor pulls, m; 0: not bonded
  double fraction = 0.0;  ///< that lies here, in a framed cell; multiplies stiffnesses and strengths
  double stretch = 0.0;   ///< of the shear spring, along e_z × n, m
  double turn = 0.0;      ///< of i less that of j, rad
};

/// Bonds all contacts that touch now; each bond carries what its contact carried. What that changes of the stored
/// energy is booked (RveLedger::bonds).
/// @throws InputError for spheres, cells that are bonded already, or a law that is not valid
void bond(Rve& cell, const BondLaw& law);

}  // namespace dovetail::rve
