#include "dovetail/fem/model/model_mass.hpp"

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::fem {

namespace {
constexpr std::size_t nodeGrain = 4096;
}

ModelMass::ModelMass(const Model& model, const DofMap& dofs, double share)
    : dofs_(&dofs), share_(share), diagonal_(share == 0.0 && !dofs.hasTies()), solver_(dofs), reduced_(dofs.size()) {
  if (!(share >= 0.0 && share <= 1.0))
    throw InputError("the share is " + formatNumber(share), "ModelMass", "give 0 (lumped) to 1 (consistent)");
  for (std::size_t n = 0; n < model.nodes.mass.size(); ++n) {
    if (!(model.nodes.mass[n] > 0.0) && model.nodes.fixed[n] != allComponents)
      throw InputError("it has no mass", "node " + std::to_string(n), "call addMass(model), or fix all its components");
    lumped_.push_back((1.0 - share) * model.nodes.mass[n]);
  }
  work_.resize(lumped_.size());
  if (share == 0.0) return;
  consistent_ = couplingPattern(model);
  consistent_.setZero();
  for (const auto& term : model.terms) term->addConsistentMass(consistent_);
  for (double& value : consistent_.values()) value *= share;
}

void ModelMass::multiply(std::span<const Vec3> x, std::span<Vec3> y) const {
  if (share_ > 0.0)
    consistent_.multiply(x, y);
  else
    std::fill(y.begin(), y.end(), Vec3{});
  parallelFor(x.size(), nodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) y[n] += lumped_[n] * x[n];
  });
}

double ModelMass::kineticEnergy(std::span<const Vec3> v) const {
  std::vector<Vec3> p(v.size());
  multiply(v, p);
  return parallelSum(v.size(), nodeGrain, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t n = begin; n < end; ++n) sum += 0.5 * dot(v[n], p[n]);
    return sum;
  });
}

void ModelMass::addTo(BlockMatrix& S, double factor) const {
  for (std::size_t n = 0; n < lumped_.size(); ++n) {
    double* const block = &S.values()[9 * S.place(static_cast<int>(n), static_cast<int>(n))];
    for (std::size_t c = 0; c < 3; ++c) block[4 * c] += factor * lumped_[n];
  }
  if (share_ == 0.0) return;
  if (!std::ranges::equal(S.columns(), consistent_.columns()) ||
      !std::ranges::equal(S.offsets(), consistent_.offsets()))
    throw InputError("the matrix has another pattern", "ModelMass::addTo",
                     "make it with couplingPattern of the same model");
  for (std::size_t k = 0; k < S.values().size(); ++k) S.values()[k] += factor * consistent_.values()[k];
}

/// a = f/m of the free components where nothing couples them.
void ModelMass::accelerateEach(std::span<const Vec3> f, std::span<Vec3> a) const {
  const std::span<const int> row = dofs_->freeRow();
  parallelFor(a.size(), nodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      if (row[3 * n] >= 0) a[n].x = f[n].x / lumped_[n];
      if (row[3 * n + 1] >= 0) a[n].y = f[n].y / lumped_[n];
      if (row[3 * n + 2] >= 0) a[n].z = f[n].z / lumped_[n];
    }
  });
}

void ModelMass::accelerate(std::span<const Vec3> f, std::span<Vec3> a) {
  if (diagonal_ && !dofs_->hasTies()) return accelerateEach(f, a);
  const std::span<const int> free = dofs_->freeDofs();
  parallelFor(free.size(), 3 * nodeGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) a[static_cast<std::size_t>(free[i] / 3)][free[i] % 3] = 0.0;
  });
  if (diagonal_) {
    dofs_->reduce(f, reduced_);
    parallelFor(free.size(), 3 * nodeGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) reduced_[i] /= lumped_[static_cast<std::size_t>(free[i] / 3)];
    });
    dofs_->addIncrement(reduced_, a);
    return;
  }
  if (!solver_.factored()) {
    whole_ = share_ > 0.0 ? consistent_ : BlockMatrix(Couplings(lumped_.size()));
    whole_.setZero();
    addTo(whole_, 1.0);
    if (!solver_.factor(whole_, true))
      throw NumericalError("the mass matrix is singular", "ModelMass", "check the masses of all nodes");
  }
  multiply(a, work_);
  for (std::size_t n = 0; n < work_.size(); ++n) work_[n] = f[n] - work_[n];
  dofs_->reduce(work_, reduced_);
  solver_.solve(reduced_, reduced_);
  dofs_->addIncrement(reduced_, a);
}

}  // namespace dovetail::fem
