#include "network.hpp"

#include <algorithm>

#include "contacts/bonded.hpp"
#include "dovetail/core/error.hpp"
#include "motion/projection.hpp"

namespace dovetail::rve {

namespace {

/// Sᵀ m, where S makes branch and turns of both grains of the strains (k, n): δb = e_k b_n, and half the curl.
template <class Matrix>
Eigen::Matrix<double, Eigen::Dynamic, Matrix::ColsAtCompileTime, 0, 9, Matrix::MaxColsAtCompileTime> ofStrains(
    const Vec3& branch, int dimension, const Matrix& m) {
  Eigen::Matrix<double, Eigen::Dynamic, Matrix::ColsAtCompileTime, 0, 9, Matrix::MaxColsAtCompileTime> result(
      dimension * dimension, m.cols());
  for (int k = 0; k < dimension; ++k)
    for (int n = 0; n < dimension; ++n) {
      result.row(dimension * k + n) = branch[n] * m.row(k);
      if (k == n) continue;
      const int axis = 3 - k - n;
      const double turn = (n + 1) % 3 == k ? 0.5 : -0.5;  // e_n × e_k = ± e_axis
      result.row(dimension * k + n) += turn * (m.row(3 + axis) + m.row(6 + axis));
    }
  return result;
}

/// By columns.
auto entries(auto& matrix) { return std::span(matrix.data(), static_cast<std::size_t>(matrix.size())); }

[[noreturn]] void failSingular() {
  throw NumericalError("the network of contacts is singular", "cell of grains",
                       "bring the cell to rest under pressure");
}

}  // namespace

Network::Network(const Rve& cell, const Linearisation& what)
    : cell_(cell), perGrain_(cell.shape == Shape::disc ? 3 : 6), strains_(cell.dimension() * cell.dimension()) {
  numberUnknowns();
  forceByStrain_ = Eigen::MatrixXd::Zero(size_, strains_);
  stressByUnknown_ = Eigen::MatrixXd::Zero(strains_, size_);
  stressByStrain_ = Eigen::MatrixXd::Zero(strains_, strains_);
  forEachTouch(cell, [&](const Touch& touch) {
    stiffest_ = std::max(stiffest_, touch.stiffness);
    add(touch.i, touch.j, touch.branch, linearised(cell, touch, what));
  });
  forEachBond(cell, [&](const BondTouch& bond) {
    stiffest_ = std::max(stiffest_, bond.normalStiffness);
    add(bond.i, bond.j, bond.branch, linearised(cell, bond, what));
  });
  addMultipliers();
}

void Network::numberUnknowns() {
  const Frame& frame = cell_.frame;
  std::vector<int> leader(cell_.size());
  for (std::size_t i = 0; i < leader.size(); ++i) leader[i] = static_cast<int>(i);
  for (const std::vector<int>& group : frame.alike)
    for (const int q : group)
      if (frame.on[static_cast<std::size_t>(q)] == Condition::periodic)
        leader[static_cast<std::size_t>(frame.grain[static_cast<std::size_t>(q)])] =
            frame.grain[static_cast<std::size_t>(group.front())];
  for (const int q : frame.those(Condition::displacement))
    leader[static_cast<std::size_t>(frame.grain[static_cast<std::size_t>(q)])] = -1;
  node_.assign(cell_.size(), -1);
  for (std::size_t i = 0; i < leader.size(); ++i) {
    if (leader[i] < 0) continue;
    int& node = node_[static_cast<std::size_t>(leader[i])];
    if (node < 0) node = nodes_++;
    node_[i] = node;
  }
  std::vector<int> first{0};
  for (int k = 0; k < nodes_; ++k) first.push_back(first.back() + perGrain_);
  const bool multiplied = !frame.those(Condition::traction).empty();
  if (multiplied) first.push_back(first.back() + 4);
  size_ = first.back();
  matrix_.emplace(std::move(first), multiplied ? nodes_ : -1);
}

void Network::add(std::size_t i, std::size_t j, const Vec3& branch, ContactMatrix m) {
  // Virtual work of the contact: force on b, less moments on turns.
  m.bottomRows<6>() *= -1.0;
  const ContactMatrix transposed = m.transpose();
  const auto stressed = ofStrains(branch, cell_.dimension(), m);
  const auto strained = ofStrains(branch, cell_.dimension(), transposed);
  stressByStrain_ += ofStrains(branch, cell_.dimension(), strained.transpose().eval());
  // How b and the turns follow the components of both grains that are unknown.
  std::array<int, 12> follows, at;
  std::array<double, 12> sign;
  std::size_t count = 0;
  for (const int grain : {0, 1})
    for (int k = 0; k < perGrain_; ++k) {
      const int u = unknown(grain == 0 ? i : j, k), component = componentOf(k);
      if (u < 0) continue;
      follows[count] = component < 3 ? component : component + 3 * grain;
      sign[count] = component < 3 && grain == 0 ? -1.0 : 1.0;
      at[count++] = u;
    }
  if (count == 0) return;
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 12, 12> forces(n, n);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t r = 0; r < count; ++r)
      forces(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          -sign[r] * sign[c] * m(follows[r], follows[c]);
    forceByStrain_.row(at[c]) -= sign[c] * strained.col(follows[c]).transpose();
    stressByUnknown_.col(at[c]) += sign[c] * stressed.col(follows[c]);
  }
  const int a = node_[i], b = node_[j];
  matrix_->add(a < 0 ? b : a, a < 0 ? -1 : b, entries(forces));
}

void Network::addMultipliers() {
  const Frame& frame = cell_.frame;
  const std::vector<int> free = frame.those(Condition::traction);
  if (free.empty()) return;
  // In units of stiffness, for the sake of the pivots.
  const double unit = stiffest_ / norm(frame.area[static_cast<std::size_t>(free.front())]);
  Eigen::Matrix2d areas = Eigen::Matrix2d::Zero();
  for (const int q : free) {
    const auto place = static_cast<std::size_t>(q);
    const Eigen::Vector2d area(frame.area[place].x, frame.area[place].y);
    areas += area * area.transpose();
    Eigen::MatrixXd part = Eigen::MatrixXd::Zero(perGrain_ + 4, perGrain_ + 4);
    for (int k = 0; k < 2; ++k)
      for (int n = 0; n < 2; ++n)
        part(perGrain_ + 2 * k + n, k) = part(k, perGrain_ + 2 * k + n) = unit * frame.area[place][n];
    matrix_->add(node_[static_cast<std::size_t>(frame.grain[place])], nodes_, entries(part));
  }
  // Of areas that are all parallel, half of the multipliers have nothing to do, and stay 0.
  const Eigen::Matrix2d idle = Eigen::Matrix2d::Identity() - areas * inverseOfAreas(areas);
  if (idle.norm() < 0.5) return;
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(4, 4);
  held.topLeftCorner<2, 2>() = held.bottomRightCorner<2, 2>() = stiffest_ * idle;
  matrix_->add(nodes_, -1, entries(held));
}

void Network::factor() {
  if (factored_) return;
  // Grains that touch nobody, and motions that nothing resists, stay where they are.
  const double slight = 1e-10 * stiffest_, r = 0.5 * meanDiameter(cell_);
  Eigen::MatrixXd held = Eigen::MatrixXd::Zero(perGrain_, perGrain_);
  for (int k = 0; k < perGrain_; ++k) held(k, k) = componentOf(k) < 3 ? -slight : -slight * r * r;
  for (const int node : node_)
    if (node >= 0) matrix_->add(node, -1, entries(held));
  if (!matrix_->factor()) failSingular();
  factored_ = true;
}

Eigen::MatrixXd Network::solved(Eigen::MatrixXd b) {
  factor();
  if (!matrix_->solve(entries(b), static_cast<int>(b.cols()))) failSingular();
  return b;
}

Eigen::MatrixXd Network::relaxedStressByStrain() { return stressByStrain_ - stressByUnknown_ * solved(forceByStrain_); }

void Network::solve(Components& w, Components& theta) {
  Eigen::MatrixXd forces = Eigen::MatrixXd::Zero(size_, 1);
  const auto field = [](Components& displacements, Components& turns, int c) -> std::vector<double>& {
    return c < 3 ? displacements[static_cast<std::size_t>(c)] : turns[static_cast<std::size_t>(c - 3)];
  };
  Components force = cell_.state.force, torque = cell_.state.torque;
  for (std::size_t i = 0; i < cell_.size(); ++i)
    for (int k = 0; k < perGrain_; ++k)
      if (const int u = unknown(i, k); u >= 0) forces(u, 0) += field(force, torque, componentOf(k))[i];
  const Eigen::VectorXd motion = -solved(std::move(forces));
  w = force;
  theta = torque;
  for (std::size_t i = 0; i < cell_.size(); ++i)
    for (int k = 0; k < perGrain_; ++k) {
      const int u = unknown(i, k);
      field(w, theta, componentOf(k))[i] = u >= 0 ? motion[u] : 0.0;
    }
}

}  // namespace dovetail::rve
