// The network of contacts as a linear system.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <memory>
#include <vector>

#include "linear_contact.hpp"

namespace dovetail::rve {

/// Forces on the unknowns, and stresses, by unknowns and by strain. Unknowns are displacements and turns of grains that
/// the frame's conditions leave, then multipliers of `traction`. Strains are components of δF F⁻¹ and, of discs, those
/// in the plane, by rows; grains turn with its spin.
class Network {
public:
  Network(const Cell& cell, const Linearisation& what);

  /// What is conjugate to strain, V σ, by strain while all grains move and turn with it, J.
  const Eigen::MatrixXd& stressByStrain() const { return stressByStrain_; }
  /// The same after what is unbalanced has been relaxed. @throws NumericalError if the network is singular
  Eigen::MatrixXd relaxedStressByStrain();
  /// Displacements and turns that would balance the forces now. @throws NumericalError if the network is singular
  void solve(Components& w, Components& theta);

private:
  void numberUnknowns();
  void add(const Touch& touch, const Linearisation& what);
  void addMultipliers();
  void factor();
  int unknown(std::size_t grain, int component) const {
    return unknown_[grain * static_cast<std::size_t>(perGrain_) + static_cast<std::size_t>(component)];
  }

  const Cell& cell_;
  int perGrain_, strains_;
  std::vector<int> unknown_;
  int size_ = 0;
  double stiffest_ = 0.0;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::MatrixXd forceByStrain_, stressByUnknown_, stressByStrain_;
  std::unique_ptr<Eigen::SparseLU<Eigen::SparseMatrix<double>>> factors_;
};

}  // namespace dovetail::rve
