#include "network.hpp"

#include <algorithm>

#include "contacts/bonded.hpp"
#include "dovetail/core/error.hpp"

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

/// Calls visit(i, j, branch, normal stiffness, m) for every contact and bond; m is the matrix of its virtual work:
/// force on the branch, less moments on turns.
template <class Visit>
void forEachStiffness(const Rve& cell, const Linearisation& what, const Visit& visit) {
  const auto take = [&](const auto& of, double stiffness) {
    ContactMatrix m = linearised(cell, of, what);
    m.bottomRows<6>() *= -1.0;
    visit(of.i, of.j, of.branch, stiffness, m);
  };
  forEachTouch(cell, [&](const Touch& touch) { take(touch, touch.stiffness); });
  forEachBond(cell, [&](const BondTouch& bond) { take(bond, bond.normalStiffness); });
}

/// Sᵀ m S, of Sᵀ mᵀ.
Eigen::MatrixXd stressByStrain(const Vec3& branch, int dimension, const auto& strained) {
  return ofStrains(branch, dimension, strained.transpose().eval());
}

/// By columns.
auto entries(auto&& matrix) { return std::span(matrix.data(), static_cast<std::size_t>(matrix.size())); }

[[noreturn]] void failSingular() {
  throw NumericalError("the network of contacts is singular", "cell of grains",
                       "bring the cell to rest under pressure");
}

}  // namespace

Eigen::MatrixXd affineStressByStrain(const Rve& cell, const Linearisation& what) {
  const int dimension = cell.dimension();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(dimension * dimension, dimension * dimension);
  forEachStiffness(cell, what, [&](std::size_t, std::size_t, const Vec3& branch, double, const ContactMatrix& m) {
    sum += stressByStrain(branch, dimension, ofStrains(branch, dimension, m.transpose().eval()));
  });
  return sum;
}

Network::Network(const Rve& cell, const Linearisation& what)
    : cell_(cell),
      frame_(rowsOf(cell)),
      perGrain_(cell.shape == Shape::disc ? 3 : 6),
      strains_(cell.dimension() * cell.dimension()) {
  numberUnknowns();
  forceByStrain_ = Eigen::MatrixXd::Zero(size_, strains_);
  stressByUnknown_ = Eigen::MatrixXd::Zero(strains_, size_);
  stressByStrain_ = Eigen::MatrixXd::Zero(strains_, strains_);
  forEachStiffness(cell, what,
                   [&](std::size_t i, std::size_t j, const Vec3& branch, double stiffness, const ContactMatrix& m) {
                     stiffest_ = std::max(stiffest_, stiffness);
                     add(i, j, branch, m);
                   });
}

void Network::numberUnknowns() {
  const std::vector<int>& leader = frame_.leader;
  node_.assign(cell_.size(), -1);
  for (std::size_t i = 0; i < leader.size(); ++i) {
    if (leader[i] < 0) continue;
    int& node = node_[static_cast<std::size_t>(leader[i])];
    if (node < 0) node = nodes_++;
    node_[i] = node;
  }
  size_ = nodes_ * perGrain_ + static_cast<int>(frame_.rows.size());
}

void Network::add(std::size_t i, std::size_t j, const Vec3& branch, const ContactMatrix& m) {
  const auto stressed = ofStrains(branch, cell_.dimension(), m);
  const auto strained = ofStrains(branch, cell_.dimension(), m.transpose().eval());
  stressByStrain_ += stressByStrain(branch, cell_.dimension(), strained);
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
  const int a = node_[i], b = node_[j];
  parts_.push_back({a < 0 ? b : a, a < 0 ? -1 : b, {}});
  auto& forces = parts_.back().forces;
  forces.resize(n, n);
  for (std::size_t c = 0; c < count; ++c) {
    for (std::size_t r = 0; r < count; ++r)
      forces(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) =
          -sign[r] * sign[c] * m(follows[r], follows[c]);
    forceByStrain_.row(at[c]) -= sign[c] * strained.col(follows[c]).transpose();
    stressByUnknown_.col(at[c]) += sign[c] * stressed.col(follows[c]);
  }
}

void Network::addMultipliers(linalg::MultifrontalLu& matrix) const {
  const auto rows = static_cast<Eigen::Index>(frame_.rows.size());
  for (Eigen::Index r = 0; r < rows; ++r) {
    const FrameRow& row = frame_.rows[static_cast<std::size_t>(r)];
    for (const auto& [grain, coefficients] : row) {
      // In units of stiffness, for the sake of the pivots.
      Eigen::MatrixXd part = Eigen::MatrixXd::Zero(perGrain_ + rows, perGrain_ + rows);
      for (int k = 0; k < perGrain_; ++k) part(perGrain_ + r, k) = part(k, perGrain_ + r) = stiffest_ * coefficients[k];
      // What is held may be stiff too: a grain that nothing else holds is no small pivot then.
      if (row.size() == 1) part.topLeftCorner<3, 3>() = -stiffest_ * coefficients * coefficients.transpose();
      matrix.add(node_[static_cast<std::size_t>(grain)], nodes_, entries(part));
    }
  }
}

void Network::factor() {
  if (factors_) return;
  std::vector<int> first{0};
  for (int k = 0; k < nodes_; ++k) first.push_back(first.back() + perGrain_);
  const int rows = static_cast<int>(frame_.rows.size());
  if (rows > 0) first.push_back(first.back() + rows);
  linalg::MultifrontalLu matrix(std::move(first), rows > 0 ? nodes_ : -1);
  for (const Part& part : parts_) matrix.add(part.a, part.b, entries(part.forces));
  addMultipliers(matrix);
  // Grains that touch nobody, and motions that nothing resists, stay where they are.
  const double held = slight * stiffest_, r = 0.5 * meanDiameter(cell_);
  Eigen::MatrixXd part = Eigen::MatrixXd::Zero(perGrain_, perGrain_);
  for (int k = 0; k < perGrain_; ++k) part(k, k) = componentOf(k) < 3 ? -held : -held * r * r;
  for (int node = 0; node < nodes_; ++node) matrix.add(node, -1, entries(part));
  if (!matrix.factor()) failSingular();
  factors_ = std::move(matrix);
}

Eigen::MatrixXd Network::solved(Eigen::MatrixXd b) {
  factor();
  if (!factors_->solve(entries(b), static_cast<int>(b.cols()))) failSingular();
  return b;
}

Eigen::MatrixXd Network::relaxedStressByStrain() {
  if (cell_.shape == Shape::sphere)
    if (const std::optional<Eigen::MatrixXd> found = relaxedByGradients()) return *found;
  return stressByStrain_ - stressByUnknown_ * solved(forceByStrain_);
}

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
