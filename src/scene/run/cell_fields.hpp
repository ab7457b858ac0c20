// What frames and probes show of strains, and of cells of grains at the points of solids.
#pragma once

#include <Eigen/Core>

#include "frame_fields.hpp"

namespace dovetail::scene {

/// Means of the points of each element: "strain", the logarithmic one by its principal stretches, nine numbers;
/// "volume_strain" ln det F; "shear_strain" √(2 e : e) with e its deviator, in simple shear the angle for small ones.
std::vector<MeshField> elementStrains(const fem::Model& model, std::size_t elements);

/// A cell of grains in a few numbers.
struct CellMeasures {
  double voidRatio = 0.0;
  double coordination = 0.0;                         ///< contacts per grain
  double sliding = 0.0;                              ///< fraction of the contacts that slip
  Eigen::Matrix3d fabric = Eigen::Matrix3d::Zero();  ///< mean of n ⊗ n
  Eigen::Matrix3d cauchy = Eigen::Matrix3d::Zero();  ///< Pa, tension > 0

  CellMeasures& operator+=(const CellMeasures& other);
  CellMeasures operator*(double factor) const;
  /// −tr σ over the dimension, Pa.
  double pressure(int dimension) const;
  /// (σ₁ − σ₃)/(σ₁ + σ₃) of the largest and smallest principal stress; of discs in their plane.
  double stressRatio(int dimension) const;
};

/// "void_ratio", "coordination", "sliding" and "fabric" (nine numbers): means of the cells of each element, as they
/// were accepted last. Empty for solids without cells.
std::vector<MeshField> elementCells(const fem::Model& model, std::size_t elements);

/// Mean of all cells of a solid by their volumes, or of the one nearest to a place.
/// @param dimension  out: 2 of discs, 3 of spheres
/// @throws InputError if it has none
CellMeasures meanOfCells(const fem::Model& model, const Vec3* at, int& dimension);

/// What cells there are, as prepared, and how many grains and bytes the points of solids have.
std::vector<std::string> linesOnCells(const Built& built);

}  // namespace dovetail::scene
