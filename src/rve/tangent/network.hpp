// The network of contacts as a linear system.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "condensation.hpp"
#include "contacts/linear_contact.hpp"
#include "dovetail/linalg/multifrontal_lu.hpp"
#include "frame_rows.hpp"

namespace dovetail::rve {

/// What is conjugate to strain, V σ, by strain while all grains move and turn with it, J. Without the network.
Eigen::MatrixXd affineStressByStrain(const Rve& cell, const Linearisation& what);

/// Forces on the unknowns, and stresses, by unknowns and by strain. Unknowns are displacements and turns of grains that
/// the frame's conditions leave, then multipliers of the other conditions. Strains are components of δF F⁻¹ and, of
/// discs, those in the plane, by rows; grains turn with its spin.
class Network {
public:
  Network(const Rve& cell, const Linearisation& what);

  /// What is conjugate to strain, V σ, by strain after what is unbalanced has been relaxed: of spheres by bi-conjugate
  /// gradients on what is left when grains with few contacts are eliminated, to 1e-6 of its norm or better, or
  /// factorised where these do not converge.
  /// @throws NumericalError if the network is singular
  Eigen::MatrixXd relaxedStressByStrain();
  /// Displacements and turns that would balance the forces now. @throws NumericalError if the network is singular
  void solve(Components& w, Components& theta);

private:
  /// Forces on the unknowns of two nodes by these; b −1: on those of one.
  struct Part {
    int a, b;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 12, 12> forces;
  };

  void numberUnknowns();
  /// Both grains of a contact, its branch, m, and its virtual work by these.
  void add(std::size_t i, std::size_t j, const Vec3& branch, const ContactMatrix& m);
  void factor();
  void addMultipliers(linalg::MultifrontalLu& matrix) const;
  SphereRows rowsOfSpheres(double r) const;
  std::optional<Eigen::MatrixXd> relaxedByGradients() const;
  /// K⁻¹ b. @throws NumericalError if the network is singular
  Eigen::MatrixXd solved(Eigen::MatrixXd b);
  int componentOf(int k) const { return perGrain_ == 3 ? discComponents[static_cast<std::size_t>(k)] : k; }
  int unknown(std::size_t grain, int k) const { return node_[grain] < 0 ? -1 : node_[grain] * perGrain_ + k; }

  /// Stiffness of what nothing else holds, over that of the stiffest contact.
  static constexpr double slight = 1e-10;
  /// Components of (displacement, turn) that a disc has.
  static constexpr std::array<int, 3> discComponents{0, 1, 5};

  const Rve& cell_;
  FrameRows frame_;
  int perGrain_, strains_;
  std::vector<int> node_;  // of a grain; those that move alike have the same, those that are held −1
  int nodes_ = 0, size_ = 0;
  double stiffest_ = 0.0;
  std::vector<Part> parts_;
  std::optional<linalg::MultifrontalLu> factors_;
  Eigen::MatrixXd forceByStrain_, stressByUnknown_, stressByStrain_;
};

}  // namespace dovetail::rve
