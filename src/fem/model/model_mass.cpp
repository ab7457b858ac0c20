#include "dovetail/fem/model/model_mass.hpp"

#include <algorithm>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "solve/newton_tools.hpp"

namespace dovetail::fem {

namespace {
constexpr std::size_t nodeChunk = 4096;
}

double matchedFraction(double spacing, double elementSize) {
  requirePositive(elementSize, "element size");
  if (!(spacing >= 0.0 && spacing <= elementSize))
    throw InputError("the spacing " + formatNumber(spacing) + " m is not within 0 and the element size " +
                         formatNumber(elementSize) + " m",
                     "matchedFraction", "take particles that are no larger than an element");
  const double ratio = spacing / elementSize;
  return 0.5 * (1.0 - ratio * ratio);
}

/// Of the free nodes of some components, which are the same for each of these.
struct ModelMass::Factor {
  std::vector<int> components, free;  // the latter in the order of the unknowns
  linalg::DefiniteSolver solver;
  std::vector<double> work;

  Factor(const ModelMass& mass, int component) : components{component}, solver(mass.linear_) {
    const linalg::NodeMatrix& M = mass.matrix_;
    std::vector<int> place(M.nodes(), -1);
    for (std::size_t n = 0; n < place.size(); ++n)
      if (mass.isFree(n, component)) {
        place[n] = static_cast<int>(free.size());
        free.push_back(static_cast<int>(n));
      }
    linalg::SparseMatrix lower;
    lower.size = static_cast<int>(free.size());
    for (const int n : free) {
      for (int k = M.offsets()[n]; k < M.offsets()[n + 1]; ++k)
        if (M.columns()[k] >= n && place[M.columns()[k]] >= 0) {
          lower.row.push_back(place[M.columns()[k]]);
          lower.value.push_back(M.values()[k]);
        }
      lower.offsets.push_back(static_cast<int>(lower.row.size()));
    }
    if (!free.empty() && !solver.factor(lower))
      throw NumericalError("the mass matrix is not positive definite", "ModelMass",
                           "take a smaller fraction of the consistent mass, or fractions of the solid above zero");
  }

  void solve(std::span<Vec3> f) {
    if (free.empty()) return;
    work.resize(components.size() * free.size());
    eachEntry(f, [](double& own, double outer) { own = outer; });
    solver.solve(work, static_cast<int>(components.size()));
    eachEntry(f, [](double own, double& outer) { outer = own; });
  }
  template <class Visit>
  void eachEntry(std::span<Vec3> f, const Visit& visit) {
    for (std::size_t k = 0; k < components.size(); ++k)
      for (std::size_t n = 0; n < free.size(); ++n)
        visit(work[k * free.size() + n], f[static_cast<std::size_t>(free[n])][components[k]]);
  }
};

ModelMass::~ModelMass() = default;
ModelMass::ModelMass(ModelMass&&) noexcept = default;

ModelMass::ModelMass(const Model& model, const DofMap& dofs, double fraction, const linalg::LinearOptions& linear)
    : dofs_(&dofs),
      linear_(linear),
      fraction_(fraction),
      mass_(model.nodes.mass),
      reduced_(dofs.hasTies() ? dofs.size() : 0) {
  linear_.relativeTolerance = 1e-14;
  if (!(fraction >= 0.0 && fraction <= 1.0))
    throw InputError("the fraction is " + formatNumber(fraction), "ModelMass", "give 0 (lumped) to 1 (consistent)");
  for (std::size_t n = 0; n < mass_.size(); ++n)
    if (!(mass_[n] > 0.0) && model.nodes.fixed[n] != allComponents)
      throw InputError("it has no mass", "node " + std::to_string(n), "call addMass(model), or fix all its components");
  if (isDiagonal())
    for (std::size_t k = 0; k < 3 * mass_.size(); ++k)
      inverse_.push_back(dofs.freeRow()[k] >= 0 ? 1.0 / mass_[k / 3] : 0.0);
  if (fraction == 0.0) return;
  matrix_ = linalg::NodeMatrix(patternOf(model));
  for (const auto& term : model.terms) term->addConsistentMass(rowsFor(*term, matrix_));
  for (double& value : matrix_.values()) value *= fraction;
  matrix_.addOwnRowsOnly(true);
  for (std::size_t n = 0; n < mass_.size(); ++n)
    if (matrix_.takes(static_cast<int>(n)))
      matrix_.values()[matrix_.place(static_cast<int>(n), static_cast<int>(n))] += (1.0 - fraction) * mass_[n];
}

void ModelMass::multiply(std::span<const Vec3> x, std::span<Vec3> y) const {
  if (fraction_ > 0.0) return matrix_.multiply(x, y);
  parallelFor(x.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) y[n] = mass_[n] * x[n];
  });
}

double ModelMass::kineticEnergy(std::span<const Vec3> v) const {
  std::vector<Vec3> p(fraction_ > 0.0 ? v.size() : 0);
  if (fraction_ > 0.0) multiply(v, p);
  return parallelSum(v.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    std::array<double, 4> sum{};  // side by side, so that no sum waits for the one before
    for (std::size_t n = begin; n < end; ++n)
      sum[n % 4] += fraction_ > 0.0 ? 0.5 * dot(v[n], p[n]) : 0.5 * mass_[n] * squaredNorm(v[n]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  });
}

void ModelMass::addTo(linalg::BlockMatrix& S, double factor) const {
  const auto add = [&](std::size_t place, double mass) {
    for (std::size_t c = 0; c < 3; ++c) S.values()[9 * place + 4 * c] += factor * mass;
  };
  if (fraction_ == 0.0) {
    S.addOwnRowsOnly(true);
    for (std::size_t n = 0; n < mass_.size(); ++n)
      if (S.takes(static_cast<int>(n))) add(S.place(static_cast<int>(n), static_cast<int>(n)), mass_[n]);
    return;
  }
  if (!std::ranges::equal(S.columns(), matrix_.columns()) || !std::ranges::equal(S.offsets(), matrix_.offsets()))
    throw InputError("the matrix has another pattern", "ModelMass::addTo",
                     "make it with zeroTangent of the same model");
  parallelFor(matrix_.values().size(), 16 * nodeChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) add(k, matrix_.values()[k]);
  });
}

void ModelMass::factorOnce() const {
  if (!factors_.empty()) return;
  const auto sameFree = [&](int a, int b) {
    for (std::size_t n = 0; n < mass_.size(); ++n)
      if (isFree(n, a) != isFree(n, b)) return false;
    return true;
  };
  for (int c = 0; c < 3; ++c) {
    const auto same =
        std::ranges::find_if(factors_, [&](const Factor& one) { return sameFree(one.components.front(), c); });
    if (same != factors_.end())
      same->components.push_back(c);
    else
      factors_.emplace_back(*this, c);
  }
}

/// By conjugate gradients with the diagonal: what a rank has of a matrix is not to be factorised.
void ModelMass::solveOnRanks(std::span<Vec3> f) const {
  const auto hold = [&](std::span<Vec3> field) {
    for (std::size_t n = 0; n < field.size(); ++n)
      for (int c = 0; c < 3; ++c)
        if (!isFree(n, c)) field[n][c] = 0.0;
  };
  const auto scale = [&](std::span<const Vec3> r, std::span<Vec3> z) {
    for (std::size_t n = 0; n < r.size(); ++n) z[n] = mass_[n] > 0.0 ? (1.0 / mass_[n]) * r[n] : Vec3{};
  };
  hold(f);
  std::vector<Vec3> x(f.size()), r(f.begin(), f.end()), z(f.size()), p(f.size()), Mp(f.size());
  const double enough = linear_.relativeTolerance * detail::normOf(f);
  scale(r, z);
  p = z;
  double now = detail::innerProduct(r, z);
  for (int k = 0; !(detail::normOf(std::span<const Vec3>(r)) <= enough); ++k) {
    if (k == linear_.maxIterations || !std::isfinite(now))
      throw NumericalError("conjugate gradients do not converge for the masses", "ModelMass",
                           "take a lumped mass, or one process");
    multiply(p, Mp);
    hold(Mp);
    const double step = now / detail::innerProduct(p, Mp);
    for (std::size_t n = 0; n < x.size(); ++n) x[n] += step * p[n], r[n] -= step * Mp[n];
    scale(r, z);
    const double before = std::exchange(now, detail::innerProduct(r, z));
    for (std::size_t n = 0; n < p.size(); ++n) p[n] = z[n] + (now / before) * p[n];
  }
  std::ranges::copy(x, f.begin());
}

void ModelMass::solveTied(std::span<Vec3> f) const {
  if (!tiedSolver_) {
    tied_ = fraction_ > 0.0 ? linalg::BlockMatrix(matrix_) : linalg::BlockMatrix(linalg::MatrixPattern(mass_.size()));
    addTo(tied_, 1.0);
    tiedSolver_ = std::make_unique<LinearSolver>(*dofs_, linear_);
    if (!tiedSolver_->factor(tied_, true))
      throw NumericalError("the mass matrix is singular", "ModelMass", "check the masses of all nodes");
  }
  dofs_->reduce(f, reduced_);
  tiedSolver_->solve(reduced_, reduced_);
  std::fill(f.begin(), f.end(), Vec3{});
  dofs_->addIncrement(reduced_, f);
}

void ModelMass::solve(std::span<Vec3> f) const {
  if (dofs_->hasTies()) return solveTied(f);
  if (fraction_ == 0.0) {
    parallelFor(f.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n)
        f[n] = {inverse_[3 * n] * f[n].x, inverse_[3 * n + 1] * f[n].y, inverse_[3 * n + 2] * f[n].z};
    });
    return;
  }
  if (matrix_.isPart()) return solveOnRanks(f);
  factorOnce();
  for (Factor& factor : factors_) factor.solve(f);
  for (std::size_t n = 0; n < f.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (!isFree(n, c)) f[n][c] = 0.0;
}

void ModelMass::accelerate(std::span<const Vec3> f, std::span<Vec3> a) const {
  std::vector<Vec3> load(f.begin(), f.end());
  const bool moving = std::ranges::any_of(a, [](const Vec3& value) { return value != Vec3{}; });
  if (!moving) {
    solve(load);
    std::copy(load.begin(), load.end(), a.begin());
    return;
  }
  for (const int dof : dofs_->freeDofs()) a[static_cast<std::size_t>(dof / 3)][dof % 3] = 0.0;
  std::vector<Vec3> inertia(a.size());
  multiply(a, inertia);
  for (std::size_t n = 0; n < load.size(); ++n) load[n] -= inertia[n];
  solve(load);
  for (std::size_t n = 0; n < load.size(); ++n) a[n] += load[n];
}

}  // namespace dovetail::fem
