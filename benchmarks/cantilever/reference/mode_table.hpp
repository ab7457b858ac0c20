// The deformed beam from its modal amplitudes, by tables that are quick inside a time step.
#pragma once

#include <Eigen/Core>
#include <array>

#include "reference/beam_modes.hpp"

namespace dovetail::cantilever {

/// The deformed beam inside one cell of the table, for given modal amplitudes.
struct BeamCell {
  int index = 0;
  double start = 0.0;                          ///< m
  std::array<double, 6> deflection, rotation;  ///< w and θ: coefficients of t⁰ … t⁵, t the distance from the start
  double axialAtStart = 0.0, sinkAtStart = 0.0;  ///< ∫ (cos w' − 1) ds and ∫ (sin w' − w') ds from 0 to the start, m
  Eigen::MatrixX2d gradientAtStart;              ///< of these two by q_j; one row per mode
};

/// Place and turn of one section; values and two derivatives by s.
struct BeamFields {
  std::array<double, 3> axial;     ///< displacement of the axis along y, m
  std::array<double, 3> vertical;  ///< displacement of the axis along z, m
  std::array<double, 3> rotation;  ///< θ
};

/// ∂/∂q_j at one section.
struct BeamGradients {
  Eigen::VectorXd axial, vertical, rotation;
};

/// Piecewise quintic mode shapes φ, ψ, twice continuously differentiable, which *are* the beam's shape here: every
/// slope is their exact derivative, so that forces taken from the geometry have a potential.
///
/// With large rotations w' is the angle of an inextensible axis, y = ∫ cos w' ds, z = ∫ sin w' ds, so that moments keep
/// their true arms (Reissner's beam up to the square of the shear angle); the two integrals are taken by Gauss' rule in
/// each cell. Without, the axis moves along z only, by w.
class ModeTable {
public:
  ModeTable(const BeamModes& modes, int cells, bool largeRotations);

  int modes() const { return static_cast<int>(deflection_.rows()); }
  double length() const { return length_; }
  int cellOf(double s) const;
  /// Sets up the cell that holds s (clamped to the beam) for amplitudes q (one per mode).
  void loadCell(double s, const Eigen::VectorXd& q, BeamCell& cell) const;
  /// @param s inside the cell, or as little outside as rounding brings
  BeamFields fields(const BeamCell& cell, double s) const;
  void gradients(const BeamCell& cell, double s, BeamGradients& gradients) const;

private:
  double length_, cellWidth_;
  int cells_;
  bool largeRotations_;
  Eigen::MatrixXd deflection_, rotation_;  ///< modes × (6 cells): coefficients of t⁰ … t⁵
  Eigen::MatrixXd gaussSlope_;             ///< modes × (Gauss points of all cells): φ'
};

}  // namespace dovetail::cantilever
