#include "dovetail/fem/motion/stable_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/solve/block_matrix.hpp"

namespace dovetail::fem {

namespace {

/// 2/ω of the largest eigenvalue ω² of A by Lanczos' iteration with full orthogonalisation.
template <class Operator>
double stepByLanczos(const Operator& A, double accuracy) {
  std::vector<Eigen::VectorXd> basis{A.start()};
  std::vector<double> diagonal, offDiagonal;
  constexpr std::size_t maxSteps = 400;
  while (basis.size() <= maxSteps) {
    Eigen::VectorXd w = A(basis.back());
    diagonal.push_back(w.dot(basis.back()));
    for (int pass = 0; pass < 2; ++pass)
      for (const Eigen::VectorXd& q : basis) w -= q.dot(w) * q;
    const double beta = w.norm();
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
    ritz.computeFromTridiagonal(
        Eigen::Map<const Eigen::VectorXd>(diagonal.data(), static_cast<Eigen::Index>(diagonal.size())),
        Eigen::Map<const Eigen::VectorXd>(offDiagonal.data(), static_cast<Eigen::Index>(offDiagonal.size())));
    const Eigen::Index last = ritz.eigenvalues().size() - 1;
    const double theta = ritz.eigenvalues()[last], error = beta * std::abs(ritz.eigenvectors()(last, last));
    if (error <= accuracy * theta) return 2.0 / std::sqrt(theta + error);
    offDiagonal.push_back(beta);
    basis.push_back(w / beta);
  }
  throw NumericalError("the Lanczos iteration did not settle in 400 steps", "assembledStableStep",
                       "ask for less accuracy, or use stableStep");
}

/// A start vector that no symmetry of a mesh is orthogonal to.
Eigen::VectorXd startVector(const std::vector<double>& scale) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(scale.size()));
  for (std::size_t i = 0; i < scale.size(); ++i)
    x[static_cast<Eigen::Index>(i)] = scale[i] > 0.0 ? std::sin(1.0 + 1.7 * static_cast<double>(i * i % 10007)) : 0.0;
  return x / x.norm();
}

/// M^(−½) TᵀKT M^(−½) of a model, M the row sums of Tᵀ(lumped mass)T.
class ScaledModel {
public:
  ScaledModel(Model& model, const Instant& now)
      : dofs_(model.constraints, model.nodes),
        K_(couplingPattern(model)),
        full_(model.nodes.X.size()),
        pushed_(full_.size()) {
    for (const auto& term : model.terms) term->addTangent(model.nodes, now, K_);
    scale_.resize(dofs_.size());
    std::vector<double> mass(dofs_.size());
    for (std::size_t i = 0; i < mass.size(); ++i)
      mass[i] = model.nodes.mass[static_cast<std::size_t>(dofs_.freeDofs()[i] / 3)];
    for (const Tie& tie : dofs_.ties())
      for (const Tie::Master& master : tie.masters)
        mass[static_cast<std::size_t>(dofs_.freeRow()[static_cast<std::size_t>(3 * master.node + master.component)])] +=
            master.factor * model.nodes.mass[static_cast<std::size_t>(tie.node)];
    for (std::size_t i = 0; i < mass.size(); ++i) scale_[i] = 1.0 / std::sqrt(mass[i]);
  }
  Eigen::VectorXd operator()(const Eigen::VectorXd& x) const {
    std::vector<double> scaled(scale_.size());
    for (std::size_t i = 0; i < scaled.size(); ++i) scaled[i] = scale_[i] * x[static_cast<Eigen::Index>(i)];
    std::fill(full_.begin(), full_.end(), Vec3{});
    dofs_.addIncrement(scaled, full_);
    K_.multiply(full_, pushed_);
    dofs_.reduce(pushed_, scaled);
    Eigen::VectorXd result(x.size());
    for (std::size_t i = 0; i < scaled.size(); ++i) result[static_cast<Eigen::Index>(i)] = scale_[i] * scaled[i];
    return result;
  }
  Eigen::VectorXd start() const { return startVector(scale_); }

private:
  DofMap dofs_;
  BlockMatrix K_;
  std::vector<double> scale_;
  mutable std::vector<Vec3> full_, pushed_;
};

}  // namespace

double assembledStableStep(Model& model, double accuracy) {
  requirePositive(accuracy, "accuracy");
  requireMass(model.nodes);
  return stepByLanczos(ScaledModel(model, {model.t, 0.0}), accuracy);
}

ModelStableStep stableStep(Model& model) {
  ModelStableStep limit{0.0, -1, {}};
  for (const auto& term : model.terms)
    if (auto* const solid = dynamic_cast<Solid*>(term.get())) {
      const StableStep own = solid->stableStep(model.nodes);
      if (limit.element < 0 || own.dt < limit.dt) limit = {own.dt, own.element, solid->name()};
    }
  if (limit.element < 0)
    throw InputError("the model has no solid", "stableStep", "add one with makeSolid, or ask assembledStableStep");
  return limit;
}

}  // namespace dovetail::fem
