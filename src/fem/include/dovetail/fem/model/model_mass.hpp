// The mass matrix of a model: lumped, consistent, or between.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"
#include "dovetail/linalg/block_matrix.hpp"

namespace dovetail::fem {

/// β that gives trilinear bricks of edge h the dispersion of a chain of particles of spacing d ≤ h, to second order in
/// the wave number: chain ω² ≈ c²k²(1 − k²d²/12), bricks with M = β consistent + (1 − β) lumped
/// ω² ≈ c²k²(1 − (1 − 2β)k²h²/12), hence β = (1 − (d/h)²)/2.
/// @throws InputError unless 0 ≤ d ≤ h and h > 0
double matchedFraction(double spacing, double elementSize);

/// M = fraction · consistent + (1 − fraction) · lumped, one number per pair of nodes, and its inverse for the free
/// components, (TᵀMT)⁻¹: a division for lumped masses that no tie couples, else a solver per distinct set of held nodes
/// that is made on first use. A fraction between dissipates nothing and sets the dispersion (matchedFraction).
///
/// The inverse uses work space of its own: one object serves one thread at a time.
class ModelMass {
public:
  /// @param dofs  must live as long as this
  /// @param linear  how M is solved for where that is no division; conjugate gradients to 1e-14
  /// @throws InputError for a fraction outside 0 … 1 or a node without mass (call addMass first)
  ModelMass(const Model& model, const DofMap& dofs, double fraction, const linalg::LinearOptions& linear = {});
  ~ModelMass();
  ModelMass(ModelMass&&) noexcept;

  double fraction() const { return fraction_; }
  const DofMap& dofs() const { return *dofs_; }
  /// Whether M⁻¹ is a division.
  bool isDiagonal() const { return fraction_ == 0.0 && !dofs_->hasTies(); }
  /// M⁻¹ where it is a division, 1/kg: three per node, 0 at components that are not free.
  std::span<const double> inverse() const { return inverse_; }
  /// y = M x.
  void multiply(std::span<const Vec3> x, std::span<Vec3> y) const;
  /// ½ vᵀMv, J.
  double kineticEnergy(std::span<const Vec3> v) const;
  /// S += factor M; the pattern must hold the couplings of all terms of the model.
  void addTo(linalg::BlockMatrix& S, double factor) const;
  /// f ← M⁻¹ f, accelerations with constraints at rest: T (TᵀMT)⁻¹ Tᵀ f, and 0 at components that are held.
  /// @throws NumericalError if the matrix is not positive definite
  void solve(std::span<Vec3> f) const;
  /// Accelerations under forces f: a = T (TᵀMT)⁻¹ Tᵀ(f − M a_g) + a_g.
  /// @param a  holds a_g, the accelerations of prescribed motion, at components that are not free; overwritten
  void accelerate(std::span<const Vec3> f, std::span<Vec3> a) const;

private:
  struct Factor;
  void factorOnce() const;
  void solveTied(std::span<Vec3> f) const;
  void solveOnRanks(std::span<Vec3> f) const;
  bool isFree(std::size_t node, int component) const {
    return dofs_->freeRow()[3 * node + static_cast<std::size_t>(component)] >= 0;
  }

  const DofMap* dofs_;
  linalg::LinearOptions linear_;
  double fraction_;
  std::vector<double> mass_;     // lumped, kg per node
  std::vector<double> inverse_;  // empty unless M⁻¹ is a division
  linalg::NodeMatrix matrix_;    // fraction · consistent + (1 − fraction) · lumped; empty if lumped
  mutable std::vector<Factor> factors_;
  mutable linalg::BlockMatrix tied_;  // with ties
  mutable std::unique_ptr<LinearSolver> tiedSolver_;
  mutable std::vector<double> reduced_;
};

}  // namespace dovetail::fem
