#include "dovetail/arlequin/stress_term.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "dovetail/fem/laws/materials.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

namespace {

Eigen::Vector3d toEigen(const Vec3& v) { return {v.x, v.y, v.z}; }
Vec3 toVec3(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

/// ∂X_i/∂ξ_j at the centre.
Eigen::Matrix3d centreJacobian(const Bricks& mesh, const std::array<int, 8>& element) {
  const std::array<Vec3, 8> parent = fem::parentGradients({});
  Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < 8; ++a)
    J += toEigen(mesh.X[static_cast<std::size_t>(element[a])]) * toEigen(parent[a]).transpose();
  return J;
}

}  // namespace

StressTerm::StressTerm(const Overlap& overlap, const Bricks& mesh, const fem::Nodes& nodes,
                       const dem::Particles& particles, const dem::PairList& pairs, double stiffness,
                       double youngsModulus, double poissonRatio, double share) {
  requirePositive(share, "stress penalty");
  const fem::LameConstants lame = fem::lameConstants(youngsModulus, poissonRatio);
  lambda_ = lame.lambda;
  mu_ = lame.mu;
  std::vector<double> volume;
  for (const int e : overlap.elements) {
    const auto& element = mesh.elements[static_cast<std::size_t>(e)];
    const Eigen::Matrix3d J = centreJacobian(mesh, element);
    const Eigen::Matrix3d toSpace = J.inverse().transpose();
    const std::array<Vec3, 8> parent = fem::parentGradients({});
    Cell cell;
    cell.nodes = element;
    for (std::size_t a = 0; a < 8; ++a) cell.gradient[a] = toVec3(toSpace * toEigen(parent[a]));
    volume.push_back(8.0 * J.determinant());
    cell.factor = share * volume.back() / youngsModulus;
    cell.difference.setZero();
    cells_.push_back(cell);
  }
  std::vector<Vec3> position(nodes.X.size());
  for (std::size_t n = 0; n < position.size(); ++n) position[n] = nodes.X[n] + nodes.u[n];
  const fem::CellLocator locator = locatorOf(mesh.elements, position);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const int i = pairs.pairs()[p][0], j = pairs.pairs()[p][1];
    const dem::PairContact contact =
        dem::pairContact(particles, static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    const auto place = locator.find(particles.x[static_cast<std::size_t>(i)] + contact.armI);
    if (!place) continue;
    const auto found = std::lower_bound(overlap.elements.begin(), overlap.elements.end(), place->element);
    if (found == overlap.elements.end() || *found != place->element) continue;
    const int cell = static_cast<int>(found - overlap.elements.begin());
    const Vec3 branch = particles.x[static_cast<std::size_t>(i)] - particles.x[static_cast<std::size_t>(j)];
    Branch b;
    b.i = i;
    b.j = j;
    b.cell = cell;
    b.restDistance = particles.radius[static_cast<std::size_t>(i)] + particles.radius[static_cast<std::size_t>(j)];
    b.normal = contact.normal;
    b.stressPerStretch =
        -stiffness / volume[static_cast<std::size_t>(cell)] * toEigen(contact.normal) * toEigen(branch).transpose();
    branches_.push_back(b);
  }
}

Eigen::Matrix3d StressTerm::solidStress(const Cell& cell, const fem::Nodes& nodes) const {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < 8; ++a)
    H += toEigen(nodes.u[static_cast<std::size_t>(cell.nodes[a])]) * toEigen(cell.gradient[a]).transpose();
  const Eigen::Matrix3d strain = 0.5 * (H + H.transpose());
  return lambda_ * strain.trace() * Eigen::Matrix3d::Identity() + 2.0 * mu_ * strain;
}

double StressTerm::apply(const dem::Particles& particles, const fem::Nodes& nodes, std::span<Vec3> particleForce,
                         std::span<Vec3> nodeForce) {
  for (Cell& cell : cells_) cell.difference = -solidStress(cell, nodes);
  for (const Branch& b : branches_) {
    const double overlap = b.restDistance - dot(b.normal, particles.x[static_cast<std::size_t>(b.i)] -
                                                              particles.x[static_cast<std::size_t>(b.j)]);
    cells_[static_cast<std::size_t>(b.cell)].difference += overlap * b.stressPerStretch;
  }
  energyBefore_ = energy_;
  energy_ = 0.0;
  for (const Cell& cell : cells_) {
    energy_ += 0.5 * cell.factor * cell.difference.squaredNorm();
    const Eigen::Matrix3d symmetric = 0.5 * (cell.difference + cell.difference.transpose());
    const Eigen::Matrix3d stress =
        cell.factor * (lambda_ * symmetric.trace() * Eigen::Matrix3d::Identity() + 2.0 * mu_ * symmetric);
    for (std::size_t a = 0; a < 8; ++a) nodeForce[cell.nodes[a]] += toVec3(stress * toEigen(cell.gradient[a]));
  }
  for (const Branch& b : branches_) {
    const Cell& cell = cells_[static_cast<std::size_t>(b.cell)];
    const double push = cell.factor * cell.difference.cwiseProduct(b.stressPerStretch).sum();  // dU/d overlap
    particleForce[b.i] += push * b.normal;
    particleForce[b.j] -= push * b.normal;
  }
  return energy_;
}

}  // namespace dovetail::arlequin
