// Cells of grains of a scene: what answers for the deformation of a solid of theirs (FEM × DEM).
#pragma once

#include "dovetail/scene/grains.hpp"

namespace dovetail::scene {

/// Springs of one stiffness, or of one modulus; see rve::Springs.
struct CellLinearContact {
  std::optional<double> modulus, stiffness;  ///< Pa, k_n = 2 E r_i r_j/(r_i + r_j); or N/m
  double stiffnessRatio = 0.8;               ///< k_t/k_n
  double rolling = 0.0, rollingFriction = 0.0;
};
/// See rve::hertzMindlin.
struct CellHertzContact {
  double youngsModulus = required, poissonRatio = required;
};
struct CellContact {
  std::variant<CellLinearContact, CellHertzContact> law;
  double friction = required;
  std::string where;
};
/// Compression to a pressure.
struct CellPressing {
  double pressure = required;      ///< Pa
  std::optional<double> friction;  ///< of the contacts meanwhile; not given: their own
  std::string where;
};
/// How grains become cells.
struct CellPreparation {
  CellContact contact;
  std::vector<CellPressing> prepare;
  double tolerance = 1e-3;  ///< of the pressures
  std::int64_t number = 1;  ///< of cells
};
/// Grains at random places, pressed.
struct RandomCells : CellPreparation {
  std::int64_t count = 400;  ///< grains of each cell
  Sizes radius;
  double density = required;  ///< kg/m³
  std::int64_t seed = 1;
};
struct DiscCells : RandomCells {
  double thickness = required;  ///< m
};
struct SphereCells : RandomCells {};
/// Spheres whose centres lie in a box, which then repeats, pressed.
struct CutCells : CellPreparation {
  std::string file;                 ///< as dem grains are converted from
  geometry::Box box = requiredBox;  ///< of the first cell, m
  Vec3 step;                        ///< from each box to the next, m
  std::optional<double> density;    ///< kg/m³, where the file has none
};
/// As `dovetail cell` writes them.
struct CellFile {
  std::string file;
};
struct Cells {
  std::string name;
  std::variant<DiscCells, SphereCells, CutCells, CellFile> grains;
  std::string where;
};

}  // namespace dovetail::scene
