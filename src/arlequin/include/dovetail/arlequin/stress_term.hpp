// Experimental: a penalty on the difference between the coarse-grained stress of the contacts and the solid's.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dovetail/arlequin/bricks.hpp"
#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/fem/model/nodes.hpp"

namespace dovetail::arlequin {

/// Energy ½ Σ_e γ V_e/E |σ_DE − σ_FE|² over the overlap's elements, with the mean stresses at small strain
///   σ_DE = −(1/V_e) Σ k δ n ⊗ l over the contacts in e (l = the branch),   σ_FE = C : sym ∇u at the centre.
/// Its forces are the gradient; on each model they sum to zero: a stress cannot hand over momentum, hence the term
/// complements a penalty on the gap and does not replace it (the paper's outlook leaves that open).
class StressTerm {
public:
  /// @param stiffness  k of the contacts, N/m   @param share  γ
  /// Contacts are those of the list as they are now; their places and directions stay frozen (small strain).
  StressTerm(const Overlap& overlap, const Bricks& mesh, const fem::Nodes& nodes, const dem::Particles& particles,
             const dem::PairList& pairs, double stiffness, double youngsModulus, double poissonRatio, double share);

  /// Adds the forces; returns the energy, J.
  double apply(const dem::Particles& particles, const fem::Nodes& nodes, std::span<Vec3> particleForce,
               std::span<Vec3> nodeForce);
  double energy() const { return energy_; }
  /// Energy at the last evaluation but one less that at the last, J: the work of the forces over a step, which are
  /// linear.
  double workOfStep() const { return energyBefore_ - energy_; }

private:
  struct Branch {
    int i, j, cell;
    double restDistance;               // m: contact energy is ½ k (rest − distance)²
    Vec3 normal;                       // from j to i
    Eigen::Matrix3d stressPerStretch;  // Pa per m of overlap
  };
  struct Cell {
    std::array<int, 8> nodes;
    std::array<Vec3, 8> gradient;  // ∂ψ_a/∂X at the centre, 1/m
    double factor;                 // γ V/E, m³/Pa
    Eigen::Matrix3d difference;    // Pa
  };
  Eigen::Matrix3d solidStress(const Cell& cell, const fem::Nodes& nodes) const;

  std::vector<Branch> branches_;
  std::vector<Cell> cells_;
  double lambda_, mu_, energy_ = 0.0, energyBefore_ = 0.0;
};

}  // namespace dovetail::arlequin
