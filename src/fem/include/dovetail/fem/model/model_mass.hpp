// The mass matrix of a model: lumped, consistent, or between.
#pragma once

#include <span>
#include <vector>

#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"

namespace dovetail::fem {

/// M = share · consistent + (1 − share) · lumped, and its inverse for the free components, (TᵀMT)⁻¹: a division for
/// lumped masses that no tie couples, else factors that are made on first use. A share between dissipates nothing and
/// sets the dispersion (matchedShare in blended_mass.hpp).
class ModelMass {
public:
  /// @param dofs  must live as long as this
  /// @throws InputError for a share outside 0 … 1 or a node without mass (call addMass first)
  ModelMass(const Model& model, const DofMap& dofs, double share);

  double share() const { return share_; }
  /// y = M x.
  void multiply(std::span<const Vec3> x, std::span<Vec3> y) const;
  /// ½ vᵀMv, J.
  double kineticEnergy(std::span<const Vec3> v) const;
  /// S += factor M; the pattern must hold the couplings of all terms of the model.
  void addTo(BlockMatrix& S, double factor) const;
  /// Accelerations under forces f: a = T (TᵀMT)⁻¹ Tᵀ(f − M a_g) + a_g.
  /// @param a  holds a_g, the accelerations of prescribed motion, at components that are not free; overwritten
  /// @throws NumericalError if the matrix is singular
  void accelerate(std::span<const Vec3> f, std::span<Vec3> a);

private:
  void accelerateEach(std::span<const Vec3> f, std::span<Vec3> a) const;
  const DofMap* dofs_;
  double share_;
  bool diagonal_;
  std::vector<double> lumped_;  // share of the diagonal, kg per node
  BlockMatrix consistent_;      // share · consistent; empty if share is 0
  BlockMatrix whole_;           // for the factors; empty until needed
  LinearSolver solver_;
  std::vector<double> reduced_;
  std::vector<Vec3> work_;
};

}  // namespace dovetail::fem
