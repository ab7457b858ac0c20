#include "network.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"

namespace dovetail::rve {

namespace {

/// Components of (displacement, turn) that a grain has.
constexpr std::array<int, 3> discComponents{0, 1, 5};

int componentOf(const Cell& cell, int k) {
  return cell.shape == Shape::disc ? discComponents[static_cast<std::size_t>(k)] : k;
}

/// Branch and turns of both grains by the strain (k, n): δb = e_k b_n, and half the curl.
Eigen::Matrix<double, 9, 1> byStrain(const Touch& touch, int k, int n) {
  Eigen::Matrix<double, 9, 1> q = Eigen::Matrix<double, 9, 1>::Zero();
  q[k] = touch.branch[n];
  if (k == n) return q;
  const int axis = 3 - k - n;
  const double turn = (n + 1) % 3 == k ? 0.5 : -0.5;  // e_n × e_k = ± e_axis
  q[3 + axis] = q[6 + axis] = turn;
  return q;
}

}  // namespace

Network::Network(const Cell& cell, const Linearisation& what)
    : cell_(cell), perGrain_(cell.shape == Shape::disc ? 3 : 6), strains_(cell.dimension() * cell.dimension()) {
  numberUnknowns();
  forceByStrain_ = Eigen::MatrixXd::Zero(size_, strains_);
  stressByUnknown_ = Eigen::MatrixXd::Zero(strains_, size_);
  stressByStrain_ = Eigen::MatrixXd::Zero(strains_, strains_);
  forEachTouch(cell, [&](const Touch& touch) { add(touch, what); });
  addMultipliers();
}

void Network::numberUnknowns() {
  const Frame& frame = cell_.frame;
  const std::size_t per = static_cast<std::size_t>(perGrain_);
  std::vector<int> leader(cell_.size());
  for (std::size_t i = 0; i < leader.size(); ++i) leader[i] = static_cast<int>(i);
  for (const std::vector<int>& group : frame.alike)
    for (const int q : group)
      if (frame.on[static_cast<std::size_t>(q)] == Condition::periodic)
        leader[static_cast<std::size_t>(frame.grain[static_cast<std::size_t>(q)])] =
            frame.grain[static_cast<std::size_t>(group.front())];
  for (const int q : frame.those(Condition::displacement))
    leader[static_cast<std::size_t>(frame.grain[static_cast<std::size_t>(q)])] = -1;
  unknown_.assign(cell_.size() * per, -1);
  for (std::size_t i = 0; i < leader.size(); ++i)
    for (std::size_t k = 0; k < per && leader[i] >= 0; ++k) {
      const auto l = static_cast<std::size_t>(leader[i]);
      if (unknown_[l * per + k] < 0) unknown_[l * per + k] = size_++;
      unknown_[i * per + k] = unknown_[l * per + k];
    }
  if (!frame.those(Condition::traction).empty()) size_ += 4;
}

void Network::add(const Touch& touch, const Linearisation& what) {
  // Virtual work of the contact: force on b, less moments on turns.
  ContactMatrix m = linearised(cell_, touch, what);
  m.bottomRows<6>() *= -1.0;
  stiffest_ = std::max(stiffest_, touch.stiffness);
  // How b and the turns follow the unknowns of both grains, and strains.
  Eigen::Matrix<double, 9, 12> motion = Eigen::Matrix<double, 9, 12>::Zero();
  motion.block<3, 3>(0, 0) = -Eigen::Matrix3d::Identity();
  motion.block<3, 3>(0, 6) = Eigen::Matrix3d::Identity();
  motion.block<3, 3>(3, 3) = Eigen::Matrix3d::Identity();
  motion.block<3, 3>(6, 9) = Eigen::Matrix3d::Identity();
  const int dimension = cell_.dimension();
  Eigen::Matrix<double, 9, Eigen::Dynamic, 0, 9, 9> strain(9, strains_);
  for (int k = 0; k < dimension; ++k)
    for (int n = 0; n < dimension; ++n) strain.col(dimension * k + n) = byStrain(touch, k, n);
  const Eigen::Matrix<double, 12, 12> forces = -motion.transpose() * m * motion;
  const Eigen::Matrix<double, 12, Eigen::Dynamic, 0, 12, 9> strained = -motion.transpose() * m * strain;
  const Eigen::Matrix<double, Eigen::Dynamic, 12, 0, 9, 12> stressed = strain.transpose() * m * motion;
  std::array<int, 12> at;
  at.fill(-1);
  for (int k = 0; k < perGrain_; ++k) {
    at[static_cast<std::size_t>(componentOf(cell_, k))] = unknown(touch.i, k);
    at[static_cast<std::size_t>(componentOf(cell_, k) + 6)] = unknown(touch.j, k);
  }
  for (int c = 0; c < 12; ++c) {
    const int column = at[static_cast<std::size_t>(c)];
    if (column < 0) continue;
    for (int r = 0; r < 12; ++r)
      if (at[static_cast<std::size_t>(r)] >= 0 && forces(r, c) != 0.0)
        entries_.emplace_back(at[static_cast<std::size_t>(r)], column, forces(r, c));
    forceByStrain_.row(column) += strained.row(c);
    stressByUnknown_.col(column) += stressed.col(c);
  }
  stressByStrain_ += strain.transpose() * m * strain;
}

void Network::addMultipliers() {
  const Frame& frame = cell_.frame;
  const std::vector<int> free = frame.those(Condition::traction);
  if (free.empty()) return;
  // In units of stiffness, for the sake of the pivots.
  const double unit = stiffest_ / norm(frame.area[static_cast<std::size_t>(free.front())]);
  for (const int q : free) {
    const auto place = static_cast<std::size_t>(q);
    for (int k = 0; k < 2; ++k)
      for (int n = 0; n < 2; ++n) {
        const int row = size_ - 4 + 2 * k + n, column = unknown(static_cast<std::size_t>(frame.grain[place]), k);
        const double entry = unit * frame.area[place][n];
        entries_.emplace_back(row, column, entry);
        entries_.emplace_back(column, row, entry);
      }
  }
}

void Network::factor() {
  if (factors_) return;
  // Grains that touch nobody, and motions that nothing resists, stay where they are.
  const double slight = 1e-10 * stiffest_, r = 0.5 * meanDiameter(cell_);
  for (std::size_t i = 0; i < cell_.size(); ++i)
    for (int k = 0; k < perGrain_; ++k)
      if (const int u = unknown(i, k); u >= 0)
        entries_.emplace_back(u, u, componentOf(cell_, k) < 3 ? -slight : -slight * r * r);
  Eigen::SparseMatrix<double> matrix(size_, size_);
  matrix.setFromTriplets(entries_.begin(), entries_.end());
  factors_ = std::make_unique<Eigen::SparseLU<Eigen::SparseMatrix<double>>>();
  factors_->compute(matrix);
  if (factors_->info() != Eigen::Success)
    throw NumericalError("the network of contacts is singular", "cell of grains",
                         "bring the cell to rest under pressure");
}

Eigen::MatrixXd Network::relaxedStressByStrain() {
  factor();
  return stressByStrain_ - stressByUnknown_ * factors_->solve(forceByStrain_);
}

void Network::solve(Components& w, Components& theta) {
  factor();
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(size_);
  const auto field = [](Components& displacements, Components& turns, int c) -> std::vector<double>& {
    return c < 3 ? displacements[static_cast<std::size_t>(c)] : turns[static_cast<std::size_t>(c - 3)];
  };
  Components force = cell_.state.force, torque = cell_.state.torque;
  for (std::size_t i = 0; i < cell_.size(); ++i)
    for (int k = 0; k < perGrain_; ++k)
      if (const int u = unknown(i, k); u >= 0) forces[u] += field(force, torque, componentOf(cell_, k))[i];
  const Eigen::VectorXd motion = -factors_->solve(forces);
  w = force;
  theta = torque;
  for (std::size_t i = 0; i < cell_.size(); ++i)
    for (int k = 0; k < perGrain_; ++k) {
      const int u = unknown(i, k);
      field(w, theta, componentOf(cell_, k))[i] = u >= 0 ? motion[u] : 0.0;
    }
}

}  // namespace dovetail::rve
