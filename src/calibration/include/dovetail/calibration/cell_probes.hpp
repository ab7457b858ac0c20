// What continuum a periodic cell of grains is: density, elastic moduli, speeds of waves, strength. The cell is strained
// along its axes in small steps and brought to rest after each (dem::strainCell, dem::relax); stresses are those of
// Love and Weber. Stresses and strains count positive in compression here, as is common in soil mechanics.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/dem/model/model.hpp"

namespace dovetail::calibration {

/// Normal stresses along the axes, Pa, compression > 0, of a cell at rest.
/// @throws InputError if forces have not been found yet
Vec3 cellPressures(const dem::Model& m);
double meanOf(const Vec3& v);
/// m³
double cellVolume(const dem::Model& m);
/// Mass over volume, kg/m³.
double cellDensity(const dem::Model& m);
/// Volume of the grains over that of the cell; overlaps count twice.
double cellSolidFraction(const dem::Model& m);

struct CompressionOptions {
  double pressure = 0.0;       ///< wanted, Pa
  double tolerance = 1e-3;     ///< of the pressure, relative
  double unbalanced = 1e-5;    ///< see dem::RelaxationReport
  std::int64_t strains = 400;  ///< given up after so many
};
/// Strains a cell isotropically until it rests at the pressure wanted under its own contact law, friction included.
/// Returns the bulk modulus on the way there, Pa, the secant of the last two states.
/// @throws InputError if the model is no cell (dem::strainCell) or has gravity, or a setting is not finite and > 0;
///   NumericalError if the pressure is not reached
double compressRve(dem::Model& m, const CompressionOptions& settings);

struct ModuliOptions {
  double strain = 1e-5;      ///< of the probes, to both sides
  double unbalanced = 1e-8;  ///< at rest; see dem::RelaxationReport
  std::int64_t steps = 200000;
};
/// Elastic moduli of a cell about the state that it is in, small strains to both sides. Only strains along the axes are
/// probed: `shear` is half the difference of stiffness along and across, which is that of isotropic cells (and of cubic
/// lattices in their planes at 45°). Stresses are those of the strained cell, so they hold terms of the order of the
/// pressure.
struct Moduli {
  double density = 0.0;  ///< kg/m³
  double solidFraction = 0.0;
  double pressure = 0.0;                             ///< Pa, of the state
  std::array<std::array<double, 3>, 3> stiffness{};  ///< ∂σ_row/∂ε_column, Pa
  double bulk = 0.0, shear = 0.0;                    ///< Pa, means over the axes
  double youngsModulus = 0.0;                        ///< Pa, 9 K G/(3 K + G)
  double poissonRatio = 0.0;
  double anisotropy = 0.0;    ///< largest deviation of a stiffness along an axis from their mean, over it
  double nonlinearity = 0.0;  ///< largest difference of stiffness along an axis between both senses, over the mean
  double pWaveSpeed = 0.0, sWaveSpeed = 0.0;  ///< m/s, √((K + 4/3 G)/ρ), √(G/ρ)
};
/// @throws InputError as strainCell; NumericalError if a probe does not come to rest
Moduli smallStrainModuli(const dem::Model& cell, const ModuliOptions& settings = {});

struct TriaxialOptions {
  double strain = 0.05;  ///< along z at the end, logarithmic
  int increments = 100;
  double tolerance = 5e-3;     ///< of the pressures across, relative
  double unbalanced = 1e-4;    ///< at rest after each increment
  std::int64_t steps = 20000;  ///< in each, given up after so many
};
/// Drained triaxial compression: shortened along z while the pressures along x and y stay. One entry per increment, the
/// first before any.
struct TriaxialCurve {
  std::vector<double> strain;   ///< along z, logarithmic
  std::vector<double> volume;   ///< volumetric strain, compression > 0
  std::vector<double> axial;    ///< Pa
  std::vector<double> lateral;  ///< Pa, mean of x and y
  double largestUnbalanced = 0.0;

  std::size_t size() const { return strain.size(); }
  double deviator(std::size_t k) const { return axial[k] - lateral[k]; }
  /// sin φ = (σ₁ − σ₃)/(σ₁ + σ₃)
  double mobilisedAngle(std::size_t k) const;
};
/// @throws InputError as strainCell, or for settings out of range; NumericalError if the pressures across are lost
TriaxialCurve triaxialCompression(dem::Model cell, const TriaxialOptions& settings = {});

/// Value of a curve at a strain, linear between increments. @throws InputError if the curve does not go so far
double atStrain(const TriaxialCurve& curve, std::span<const double> values, double strain);

/// What a curve says about strength.
struct Strength {
  double peakAngle = 0.0;       ///< rad, largest mobilised friction angle
  double peakStrain = 0.0;      ///< where
  double residualAngle = 0.0;   ///< rad, of the mean stresses over the last quarter
  double dilatancyAngle = 0.0;  ///< rad, from the steepest growth of volume over a tenth of the curve; < 0: it shrinks
};
/// @throws InputError for curves of fewer than 10 increments
Strength strengthOf(const TriaxialCurve& curve);

/// Parameters of fem::DruckerPrager with the cone through triaxial compression.
struct Cone {
  double frictionAngle = 0.0;   ///< rad
  double cohesion = 0.0;        ///< Pa; 0 from one curve
  double dilatancyAngle = 0.0;  ///< rad, mean of the curves', at least 0
  double misfit = 0.0;          ///< largest |q − q of the cone| over q among the peaks
};
/// The line q = M p + b through the peaks of the curves, least squares (through the origin for one curve or where b <
/// 0): sin φ = 3 M/(6 + M), c = b (3 − sin φ)/(6 cos φ). @throws InputError without curves
Cone coneThrough(std::span<const TriaxialCurve> curves);

}  // namespace dovetail::calibration
