// Tests of cells: some components of the strain follow a course, others give way to a stress.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/core/rest.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// What each component of the velocity gradient L does: it is a rate, or what keeps the Cauchy stress at its place.
/// Components whose stress is held have no rate.
struct Drive {
  Eigen::Matrix3d rate = Eigen::Matrix3d::Zero();  ///< L over the rate of the strain that the test counts
  /// σ that is held, Pa, tension positive; NaN where none is.
  Eigen::Matrix3d stress = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());

  bool holds() const { return !stress.array().isNaN().all(); }
};

/// Tests of the field. Strains that they count are logarithmic, shortening positive, or the shear γ = ∫ L₁₂ dt.
/// Pressures, Pa, > 0 in compression, are those that the sides keep; none: the volume is constant (undrained).
/// @param axis  0, 1 or, of spheres, 2: that which is shortened
/// All throw InputError for an axis that the shape does not have.

/// Alike along all axes; counts the volumetric strain.
Drive isotropicCompression(Shape shape);
/// No strain across.
Drive oedometer(Shape shape, int axis);
/// In the plane x, y; spheres keep their width along z (plane strain).
Drive biaxial(Shape shape, int axis, std::optional<double> pressure);
/// Of spheres; the two axes across have the same pressure, or without one the same strain.
Drive triaxial(int axis, std::optional<double> pressure);
/// Along x, in planes of the normal y, whose pressure is kept; no other strain.
Drive simpleShear(std::optional<double> pressure);

struct DriveOptions {
  double inertialNumber = 1e-3;  ///< I of the rate, by the pressure that there is; in (0, 1e-2]
  double damping = 0.1;          ///< as in step, in [0, 1)
  double tolerance = 1e-3;       ///< of the stresses held, relative, at the strains looked at; > 0
  double stepFraction = 0.8;
  std::optional<RestCriterion> rest = {};  ///< at the strains looked at; none: they are looked at in motion
  std::int64_t steps = 20000000;           ///< given up after so many
};

/// A cell at one strain of a test.
struct DrivenState {
  double strain = 0.0;  ///< that the test counts
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();  ///< Cauchy, Pa, tension positive
  double volume = 0.0;                               ///< m³
  double solidFraction = 0.0;
  double coordination = 0.0;  ///< as Balance
  double sliding = 0.0;       ///< fraction of contacts at the limit of friction
  double unbalanced = 0.0;    ///< as Balance
  Eigen::Matrix3d fabric = Eigen::Matrix3d::Zero();
  RveLedger ledger;
  double stored = 0.0, kinetic = 0.0;  ///< J

  double voidRatio() const { return 1.0 / solidFraction - 1.0; }
};
DrivenState lookAt(const Rve& cell, double strain);

/// Drives a cell that repeats, from the state that it is in, to one strain after the other; they may turn back. While a
/// stress is off by more than the tolerance the cell waits for the servo, which learns what strain comes with that of
/// the test; so it is at the strains that are looked at. Rates alone give F in closed form: constant volumes are so to
/// round-off.
/// @param strains  that are looked at; the start, 0, is looked at before them
/// @param each     called with every state as it comes
/// @return one state more than strains
/// @throws InputError if a setting, strain or stress is not valid, the cell has a frame or, of discs, a component out
/// of
///   the plane is driven or held; NumericalError if it gives up, or as step
std::vector<DrivenState> drive(Rve& cell, const Drive& how, std::span<const double> strains,
                               const DriveOptions& settings = {},
                               const std::function<void(const DrivenState&)>& each = {});

/// n strains, the last is `most`: equal steps, or equal factors from `least` on.
std::vector<double> equalStrains(double most, int n);
std::vector<double> growingStrains(double least, double most, int n);

}  // namespace dovetail::rve
