#include "dovetail/linalg/largest_eigenvalue.hpp"

#include <Spectra/SymGEigsSolver.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::linalg {

namespace {

/// What Spectra asks of the stiffness and of the mass.
class View {
public:
  using Scalar = double;
  View(const StiffnessAndMass& pair, const StiffnessAndMass::Operator& product) : pair_(pair), product_(product) {}
  Eigen::Index rows() const { return static_cast<Eigen::Index>(pair_.size); }
  Eigen::Index cols() const { return rows(); }
  void perform_op(const double* x, double* y) const { apply(product_, x, y); }
  void solve(const double* x, double* y) const { apply(pair_.inverseMass, x, y); }

private:
  void apply(const StiffnessAndMass::Operator& f, const double* x, double* y) const {
    const std::span<double> result(y, pair_.size);
    f({x, pair_.size}, result);
    if (!std::ranges::all_of(result, [](double value) { return std::isfinite(value); }))
      throw NumericalError("stiffness or mass are not finite", "largest frequency of a solid",
                           "check the masses, and that no element is inverted");
  }
  const StiffnessAndMass& pair_;
  const StiffnessAndMass::Operator& product_;
};

/// No symmetry of a mesh is orthogonal to it.
Eigen::VectorXd startVector(std::size_t size) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(size));
  for (std::size_t i = 0; i < size; ++i)
    x[static_cast<Eigen::Index>(i)] = std::sin(1.0 + 1.7 * static_cast<double>(i * i % 10007));
  return x;
}

}  // namespace

double largestEigenvalue(const StiffnessAndMass& pair, double accuracy) {
  requirePositive(accuracy, "accuracy");
  if (pair.size == 0) return 0.0;
  View K(pair, pair.stiffness), M(pair, pair.mass);
  Eigen::VectorXd start = startVector(pair.size), first(start.size());
  K.perform_op(start.data(), first.data());
  if (pair.size == 1) {
    double mass = 0.0;
    M.perform_op(start.data(), &mass);
    return first[0] / mass;
  }
  if (first.isZero(0.0)) return 0.0;
  M.solve(first.data(), start.data());  // within what the operators can reach
  constexpr std::size_t mostVectors = 40;
  constexpr Eigen::Index mostRestarts = 300;
  Spectra::SymGEigsSolver<View, View, Spectra::GEigsMode::RegularInverse> solver(
      K, M, 1, static_cast<Eigen::Index>(std::min(mostVectors, pair.size)));
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestAlge, mostRestarts, accuracy);
  if (solver.info() != Spectra::CompInfo::Successful)
    throw NumericalError("the Lanczos iteration did not converge", "largest frequency of a solid",
                         "request less accuracy");
  return solver.eigenvalues()[0] * (1.0 + accuracy);
}

}  // namespace dovetail::linalg
