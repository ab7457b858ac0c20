// Moduli of cells: of tangents, and of finite strains.
#pragma once

#include <span>
#include <vector>

#include "dovetail/rve/drive.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Pa. Of discs those of their plane: the pressure is −(σ₁₁ + σ₂₂)/2, the volume the area.
struct Moduli {
  double bulk = 0.0, shear = 0.0;
};

/// Isotropic part of what the Cauchy stress answers to strains without spin, at the cell's stress: K = −∂p/∂ln V, and G
/// the mean over all deviatoric strains.
/// @param tangent  ∂P/∂F there
Moduli moduliOf(const Rve& cell, const Tangent& tangent);

/// Secant moduli by the strain at which they end: K = Δp/ε by isotropic compression to ε = −ln V, and G = Δσ₁₂/γ by
/// simple shear to γ.
struct SecantModuli {
  std::vector<double> strain;
  std::vector<double> bulk, shear;  ///< Pa
};

/// From rest to rest: two drives of a copy of the cell, grains slipping as they do.
/// @param strains  > 0, growing
/// @throws InputError as drive, or for other strains; NumericalError as drive, or if a state does not come to rest
SecantModuli secantModuli(const Rve& cell, std::span<const double> strains,
                          const DriveOptions& settings = {.inertialNumber = 1e-4,
                                                          .rest = RestCriterion{.tolerance = 1e-6}});

}  // namespace dovetail::rve
