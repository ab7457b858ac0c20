// What a tie makes from the places of its particles: operators, stiffnesses, the constraint.
#pragma once

#include <memory>
#include <vector>

#include "dovetail/arlequin/absorber.hpp"
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/arlequin/coupling_options.hpp"
#include "dovetail/coupling/solid_side.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::arlequin {

/// What of a tie stays while particles come and go.
struct TieSetting {
  fem::SolidMesh mesh;
  CouplingOptions options;
  std::vector<double> nodalWeight;
  std::vector<double> penalty;  ///< per element, Pa/m²
  double bulkDensity = 0.0;     ///< of the packing: mass of the particles over the volume that they fill, kg/m³
};

struct TieParts {
  GapOperator gap;
  std::vector<double> stiffness;           ///< p Ω per member, N/m; Ω: the volume that a particle fills
  std::vector<double> slipLength;          ///< of each row, m: those of its members, in the mean by mass
  std::unique_ptr<Constraint> constraint;  ///< made when masses are known
  std::unique_ptr<Absorber> absorber;
};

/// A member whose part of the gap is longer slips, and ties that are longer by half of it are made anew, m.
inline double slipLengthOf(double radius) { return 0.1 * radius; }

/// p of every element: as given, or 20 E/h² of its own material and size.
/// @throws InputError where no modulus is known
std::vector<double> penaltyOfElements(const fem::SolidMesh& mesh, const fem::Model& solid,
                                      const CouplingOptions& options);
/// Median over the elements of the overlap of the mass of their particles over their volume, kg/m³.
double bulkDensityOf(const Overlap& overlap, const fem::SolidMesh& mesh, const dem::Particles& particles);

/// @param overlap   particles by number, with x the material point at which each is tied
TieParts makeParts(const TieSetting& setting, const Overlap& overlap, const dem::Model& m);
/// Sets parts.constraint and absorber. @param before  the constraint that it takes the place of @throws InputError if
/// the solid has no mass yet
void addConstraint(const TieSetting& setting, const Overlap& overlap, const dem::Model& m,
                   const coupling::SolidSide& side, TieParts& parts, std::unique_ptr<Constraint> before);

/// w m of every particle; ∞ for those that are driven.
std::vector<double> yieldingMasses(const dem::Model& m);

}  // namespace dovetail::arlequin
