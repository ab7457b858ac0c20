#include "dovetail/fem/motion/blended_mass.hpp"

#include <Eigen/SparseCholesky>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

double matchedShare(double spacing, double elementSize) {
  requirePositive(elementSize, "element size");
  if (!(spacing >= 0.0 && spacing <= elementSize))
    throw InputError("the spacing " + formatNumber(spacing) + " m is not within 0 and the element size " +
                         formatNumber(elementSize) + " m",
                     "matchedShare", "take particles that are no larger than an element");
  const double ratio = spacing / elementSize;
  return 0.5 * (1.0 - ratio * ratio);
}

/// Unit lower triangle by columns and by rows, in the order of elimination.
struct BlendedMass::Factor {
  std::vector<int> order;         // place → node
  std::vector<int> offsets, row;  // strictly lower, by columns
  std::vector<double> lower, inverseDiagonal;
  mutable std::vector<Vec3> work;

  Factor(const BlendedMass& mass, unsigned component) {
    const std::size_t n = mass.lumped_.size();
    std::vector<int> place(n, -1), free;
    for (std::size_t i = 0; i < n; ++i)
      if (!(mass.held_[i] >> component & 1)) {
        place[i] = static_cast<int>(free.size());
        free.push_back(static_cast<int>(i));
      }
    std::vector<Eigen::Triplet<double>> entries;
    for (const int i : free)
      for (int k = mass.offsets_[i]; k < mass.offsets_[i + 1]; ++k)
        if (place[mass.neighbour_[k]] >= 0) entries.emplace_back(place[i], place[mass.neighbour_[k]], mass.value_[k]);
    const auto size = static_cast<Eigen::Index>(free.size());
    Eigen::SparseMatrix<double> M(size, size);
    M.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(M);
    if (size > 0 && (ldlt.info() != Eigen::Success || !(ldlt.vectorD().minCoeff() > 0.0)))
      throw NumericalError("the mass matrix is not positive definite", "BlendedMass",
                           "take a smaller share of the consistent mass, or weights above zero");
    take(ldlt, free);
  }

  void take(const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>& ldlt, const std::vector<int>& free) {
    order.resize(free.size());
    work.resize(free.size());
    offsets.push_back(0);
    if (free.empty()) return;
    const auto& position = ldlt.permutationP().indices();
    for (std::size_t i = 0; i < free.size(); ++i)
      order[static_cast<std::size_t>(position[static_cast<Eigen::Index>(i)])] = free[i];
    const Eigen::SparseMatrix<double> L = ldlt.matrixL();
    const Eigen::VectorXd D = ldlt.vectorD();
    for (Eigen::Index column = 0; column < L.outerSize(); ++column) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(L, column); it; ++it)
        if (it.row() > column && it.value() != 0.0) {
          row.push_back(static_cast<int>(it.row()));
          lower.push_back(it.value());
        }
      offsets.push_back(static_cast<int>(row.size()));
      inverseDiagonal.push_back(1.0 / D[column]);
    }
  }

  /// work ← M⁻¹ f, in the order of elimination.
  void solve(std::span<const Vec3> f) const {
    const std::size_t n = order.size();
    for (std::size_t i = 0; i < n; ++i) work[i] = f[static_cast<std::size_t>(order[i])];
    for (std::size_t j = 0; j < n; ++j) {
      const Vec3 value = work[j];
      for (int k = offsets[j]; k < offsets[j + 1]; ++k) work[static_cast<std::size_t>(row[k])] -= lower[k] * value;
      work[j] = inverseDiagonal[j] * value;
    }
    for (std::size_t j = n; j-- > 0;) {
      Vec3 value = work[j];
      for (int k = offsets[j]; k < offsets[j + 1]; ++k) value -= lower[k] * work[static_cast<std::size_t>(row[k])];
      work[j] = value;
    }
  }
};

BlendedMass::BlendedMass(const ElementBlock& block, const Nodes& nodes, double share)
    : share_(share), lumped_(nodes.mass), held_(nodes.fixed) {
  if (!(share >= 0.0 && share <= 1.0))
    throw InputError("the share is " + formatNumber(share), "BlendedMass", "give 0 (lumped) to 1 (consistent)");
  if (nodes.mass.size() != block.nodeCount())
    throw InputError("the nodes are not those of the elements", "BlendedMass", "use the nodes of the same mesh");
  requireMass(nodes);
  const SparseMatrix M = consistentMass(block);
  offsets_.push_back(0);
  for (std::size_t n = 0; n < lumped_.size(); ++n) {  // the matrix is symmetric: its columns are its rows
    for (int k = M.offsets[3 * n]; k < M.offsets[3 * n + 1]; ++k) {
      if (M.row[k] % 3 != 0) continue;
      const auto other = static_cast<std::size_t>(M.row[k] / 3);
      const double value = share * M.value[k] + (other == n ? (1.0 - share) * lumped_[n] : 0.0);
      if (value == 0.0) continue;
      neighbour_.push_back(static_cast<int>(other));
      value_.push_back(value);
    }
    offsets_.push_back(static_cast<int>(value_.size()));
    if (held_[n]) heldNodes_.push_back(static_cast<int>(n));
  }
  const auto sameHeld = [&](unsigned a, unsigned b) {
    for (const int n : heldNodes_)
      if ((held_[n] >> a & 1) != (held_[n] >> b & 1)) return false;
    return true;
  };
  for (unsigned c = 0; c < 3; ++c) {
    unsigned first = 0;
    while (first < c && !sameHeld(first, c)) ++first;
    if (first < c) {
      factorOf_[c] = factorOf_[first];
      continue;
    }
    factorOf_[c] = static_cast<int>(factors_.size());
    factors_.push_back(std::make_unique<Factor>(*this, c));
  }
}

BlendedMass::~BlendedMass() = default;
BlendedMass::BlendedMass(BlendedMass&&) noexcept = default;
BlendedMass& BlendedMass::operator=(BlendedMass&&) noexcept = default;

void BlendedMass::solve(std::span<Vec3> f) const {
  const bool shared = factors_.size() == 1;
  for (const auto& factor : factors_) factor->solve(f);
  for (const int n : heldNodes_)
    for (int c = 0; c < 3; ++c)
      if (held_[n] >> c & 1) f[n][c] = 0.0;
  if (shared) {
    const Factor& factor = *factors_.front();
    for (std::size_t i = 0; i < factor.order.size(); ++i) f[factor.order[i]] = factor.work[i];
    return;
  }
  for (int c = 0; c < 3; ++c) {
    const Factor& factor = *factors_[factorOf_[static_cast<std::size_t>(c)]];
    for (std::size_t i = 0; i < factor.order.size(); ++i) f[factor.order[i]][c] = factor.work[i][c];
  }
}

std::vector<Vec3> BlendedMass::multiply(std::span<const Vec3> v) const {
  std::vector<Vec3> result(v.size());
  for (std::size_t n = 0; n < v.size(); ++n)
    for (int k = offsets_[n]; k < offsets_[n + 1]; ++k) result[n] += value_[k] * v[neighbour_[k]];
  return result;
}

double BlendedMass::kineticEnergy(std::span<const Vec3> v) const {
  const std::vector<Vec3> momentumOfNode = multiply(v);
  double sum = 0.0;
  for (std::size_t n = 0; n < v.size(); ++n) sum += 0.5 * dot(v[n], momentumOfNode[n]);
  return sum;
}

Vec3 BlendedMass::supportForce(std::span<const Vec3> acceleration, std::span<const Vec3> force) const {
  Vec3 sum;
  for (const int n : heldNodes_) {
    Vec3 inertia;
    for (int k = offsets_[n]; k < offsets_[n + 1]; ++k) inertia += value_[k] * acceleration[neighbour_[k]];
    for (int c = 0; c < 3; ++c)
      if (held_[n] >> c & 1) sum[c] += inertia[c] - force[n][c];
  }
  return sum;
}

}  // namespace dovetail::fem
