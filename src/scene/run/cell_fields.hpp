// What frames and probes show of cells of grains at the points of solids.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/rve/rve.hpp"
#include "point_fields.hpp"

namespace dovetail::scene {

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

/// "void_ratio", "coordination", "sliding" and "fabric" (nine numbers) of the cells as they were accepted last; 0 at
/// points of other laws. Empty for solids without cells.
std::vector<MeshField> cellsAt(const Points& points);

/// A point of a solid that has a cell of grains.
struct CellPoint {
  const fem::PointField* field;
  std::size_t number;  ///< in the field
  int element, point;  ///< of the mesh, and within it
  Vec3 X;              ///< m
  double volume;       ///< reference, m³
};
/// All of a solid, none if it has no cells.
std::vector<CellPoint> cellPoints(const fem::Model& model);
/// The same by the solid's name. @throws InputError if there is no such solid, or it has no cells
std::vector<CellPoint> cellPointsOf(const std::string& solid, const Built& built);
/// @param cells  at least one
const CellPoint& nearestCell(const std::vector<CellPoint>& cells, const Vec3& at);
/// Of the cells that frames show, in their order. @throws InputError also for names of files that two have
std::vector<CellPoint> shownCells(const Built& built, const Output& output);
/// Shows the cell as it was accepted last.
void visit(const CellPoint& place, const std::function<void(const rve::Rve&)>& look);

/// Mean by the volumes. @param cells  at least one  @param dimension  out: 2 of discs, 3 of spheres
CellMeasures meanOf(const std::vector<CellPoint>& cells, int& dimension);

/// Cells that have become thin, and are several copies side by side.
struct RepeatedCells {
  std::size_t all = 0, repeated = 0;
  int mostCopies = 0;  ///< of one cell
};
RepeatedCells repeatedCells(const fem::Model& model);
/// A line for each solid that has some.
std::vector<std::string> linesOnRepeatedCells(const coupling::CoupledRun& run);

/// Of fields of cells on several ranks.
std::vector<const hierarchical::FarmReport*> farmsOf(const fem::Model& model);
/// Who answered for how many cells: a line for each.
std::vector<std::string> linesOnFarms(const coupling::CoupledRun& run);

/// What cells there are, as prepared, and how many grains and bytes the points of solids have.
std::vector<std::string> linesOnCells(const Built& built);

}  // namespace dovetail::scene
