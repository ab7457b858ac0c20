// Columns of frictional grains of many sizes with periodic sides, and the same with a solid in the place of their lower
// part.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"

namespace dovetail::disordered_overlap {

/// Grains of all columns: radii evenly from 0.4 d to 0.6 d, linear springs and friction, rotation; dashpots
/// (restitution 0.5) but under a lid.
namespace grain {
inline constexpr double diameter = 0.01;     ///< d, the mean, m
inline constexpr double density = 2500.0;    ///< kg/m³
inline constexpr double stiffness = 1e5;     ///< N/m
inline constexpr double tangential = 0.8e5;  ///< N/m
inline constexpr double friction = 0.5;
}  // namespace grain
inline constexpr double standardGravity = 9.81;  ///< m/s²

struct ColumnSize {
  double width = 5.0 * grain::diameter;  ///< of the square that repeats, m
  double height = 0.0;                   ///< m
  std::uint64_t seed = 1;
};

/// At rest under gravity on a floor at z = 0. @throws NumericalError if it does not come to rest
dem::Model fallenColumn(const ColumnSize& size);

/// At rest without gravity between a floor and a lid: brought to the pressure, within 3 %, from all sides without
/// friction, and then pressed by the lid with friction, by a strain of 2e-4. Sides and height come out a little
/// different from those asked.
/// @throws NumericalError if it does not come to rest
dem::Model pressedColumn(const ColumnSize& size, double pressure);
/// The same under friction all along: grains that hardly touch are brought closer in proportion until they bear half of
/// the pressure, and pressed by the lid to within 10 % of it. That leaves many contacts about to slide, and the packing
/// stiffer one way than the other, so the lid then shakes it down: up and down and sideways by a strain of 5e-5.
/// @throws NumericalError if it does not come to rest or to its pressure
dem::Model columnPressedWithFriction(const ColumnSize& size, double pressure);
double widthOf(const dem::Model& column);  ///< m
/// Moves the lid of such columns slowly, m, and brings all to rest. @throws NumericalError as pressedColumn
void moveLid(dem::Model& column, const Vec3& way);
enum PressedWalls : std::size_t { lidOfPressed = 0, floorOfPressed = 1 };  ///< for dem::primitiveWall

/// Mass of the grains, whole spheres cut at the heights, over the volume between two heights, kg/m³.
double bulkDensity(const dem::Particles& p, double width, double lower, double upper);

/// What a solid is in place of grains.
struct Elastic {
  double density;         ///< kg/m³
  double young, poisson;  ///< Pa, 1
};

/// Where the solid is: from `bottom` to `top`; grains from `border` upwards, and weighed in between.
struct SolidPlace {
  double width = 0.0;                            ///< m
  double bottom = 0.0, border = 0.0, top = 0.0;  ///< m
  double element = 0.0;                          ///< height of an element, m
  int across = 1;                                ///< elements
};

struct JoinOptions {
  bool initialEquilibrium = true;  ///< the solid carries what it is handed; otherwise it is without stress
  double massFraction = 0.0;       ///< of the consistent mass
  arlequin::WeightOptions weights{.floor = 0.01};
  arlequin::CouplingOptions coupling{};
};

/// A column of grains upon a solid; not started.
struct JoinedColumn {
  coupling::CoupledRun run;
  fem::SolidMesh mesh;
  arlequin::ArlequinCoupling* tie = nullptr;
  int rounds = 0;  ///< of arlequin::initialEquilibrium
};

/// The packing without its floor and without what lies below the border, on a solid that is held at its bottom.
/// @param floor  number of its wall
std::unique_ptr<JoinedColumn> joinSolid(const dem::Model& packing, std::size_t floor, const SolidPlace& place,
                                        const Elastic& elastic, const JoinOptions& options);

/// Starts a run with a weight of its critical step.
void startWith(coupling::CoupledRun& run, double fractionOfCritical);

}  // namespace dovetail::disordered_overlap
