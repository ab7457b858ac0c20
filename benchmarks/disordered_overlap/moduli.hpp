// What a packing is as an elastic solid, by probes small enough to be linear.
#pragma once

#include "column.hpp"

namespace dovetail::disordered_overlap {

/// Of a column under pressure, in the state that it has now.
struct Moduli {
  double pressure;            ///< on the lid, Pa
  double density;             ///< kg/m³
  double axial;               ///< M = dσ_zz/dε_zz, no strain sideways, Pa
  double shear;               ///< G = dσ_xz/dγ_xz, Pa
  double axialSpeed() const;  ///< √(M/ρ), m/s
  double shearSpeed() const;
};

/// Moves the lid of a copy up, and of another one sideways, lets both come to rest, and divides the change of its
/// stress by the slope of the displacements of the middle four fifths of the grains.
/// @param column  of pressedColumn   @throws NumericalError if a copy does not come to rest
Moduli probe(const dem::Model& column, double strain = 1e-5);

/// The St Venant–Kirchhoff solid whose tangents are M and G, and whose density is the packing's, where it bears the
/// pressure without strain sideways. With F its stretch: M' F (½(F² − 1) + F²) = M, M' ½(F² − 1) F = −p,
/// G' = (G + p)/F, ρ' = ρ F.
Elastic solidOf(const Moduli& m);

}  // namespace dovetail::disordered_overlap
