// Stiffness operators ∂P/∂F of a cell at rest.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// ∂P_iJ/∂F_kL at row 3i + J, column 3k + L, Pa; discs: what lies in the plane, else 0.
using Tangent = Eigen::Matrix<double, 9, 9>;

/// Linear answer of the network of contacts, none of which slips: what grains do to stay balanced is eliminated,
/// (K_LL − K_Lw K_ww⁻¹ K_wL)/V, with the forces that contacts carry, grains' turns and the conditions of the frame.
/// Analytic twin of elasticProbe (PSTLO of Desrues et al. 2019).
/// @throws NumericalError if the matrix of the network is singular
Tangent elasticTangent(const Rve& cell);

/// The same with springs that slip where they are at the limit of friction.
Tangent frictionalTangent(const Rve& cell);

/// All grains move, and turn, with F, nothing slips, and what contacts carry is left out: Kruyt's bound, above the
/// elasticTangent's (UKO; Desrues et al. 2019, eq. 33, with the spin of F for the grains').
Tangent voigtTangent(const Rve& cell);

struct ProbeOptions {
  double strain = 1e-7;       ///< either way, > 0
  double unbalanced = 1e-10;  ///< of the probes, as Balance::unbalanced, > 0
};

/// Central differences of P from states relaxed after small deformations of each component, during which nothing slips
/// (DEMQO; Desrues et al. 2019, eq. 32). The cell stays as it is.
/// @throws InputError if a setting is not > 0; NumericalError if a probe does not come to rest
Tangent elasticProbe(const Rve& cell, const ProbeOptions& settings = {});

struct NumericalTangentOptions {
  double strain = 1e-5;  ///< > 0
  PathOptions path{.rest = {.tolerance = 1e-6}};
};

/// Differences of the answers themselves: P of the paths from the committed cell to F and to F with each component a
/// little larger, contacts slipping as they do (CTO; Desrues et al. 2019, eq. 31). One path for each component and one
/// more. The cell stays as it is.
/// @throws InputError as followPath, or if the strain is not > 0; NumericalError if a path does not end at rest
Tangent numericalTangent(const Rve& committed, const Eigen::Matrix3d& F, const NumericalTangentOptions& settings = {});

/// Operators of a cell as long as it hardens, and from its first softening step on, for good, the mean of those so far
/// (AEO; Desrues et al. 2019, sec. 2.5, with numericalTangent). A step ΔF, ΔP softens if ΔP : ΔF ≤ 0 (Hill), the turn
/// of the step taken out; operators turn with the cell.
struct AveragedTangent {
  Eigen::Matrix3d F = Eigen::Matrix3d::Zero();  ///< committed last while the cell hardened
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();  ///< there, Pa
  Tangent mean = Tangent::Zero();               ///< as it is without the turn R of F = R U
  int count = 0;                                ///< of operators that the mean is of
  bool frozen = false;

  /// The mean, turned as a cell is at F.
  Tangent at(const Eigen::Matrix3d& nowF) const;
  /// The operator to go on with from a committed state, P in Pa; `probe` is called as long as the cell hardens.
  Tangent next(const Eigen::Matrix3d& nowF, const Eigen::Matrix3d& nowP, const std::function<Tangent()>& probe);
};

}  // namespace dovetail::rve
