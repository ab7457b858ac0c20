// Out-of-balance forces and tangent of a model for the implicit solvers.
#pragma once

#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::fem::detail {

/// Work space of a static solution; `model` is the state.
class Equilibrium {
public:
  Equilibrium(Model& model, const NewtonOptions& options);

  /// f = Σ forces at time t into forces(), its free part into residual(); @return norm of the residual, NaN included
  double evaluate(double t);
  /// What counts as zero, after evaluate().
  double tolerance() const { return tolerance_; }
  /// K at the present state, factorised. @return false if it is singular
  bool factor(double t);
  void solve(std::span<const double> r, std::span<double> x);

  Model& model() { return model_; }
  const DofMap& dofs() const { return dofs_; }
  LinearSolver& solver() { return solver_; }
  const BlockMatrix& stiffness() const { return K_; }
  std::span<const double> residual() const { return residual_; }
  std::span<const Vec3> forces() const { return forces_; }
  /// Of the terms without energy alone.
  std::span<const Vec3> loads() const { return loads_; }
  bool symmetric() const;
  double assemblySeconds() const { return assemblySeconds_; }
  double solverSeconds() const { return solverSeconds_; }

private:
  Model& model_;
  NewtonOptions options_;
  DofMap dofs_;
  LinearSolver solver_;
  BlockMatrix K_;
  std::vector<Vec3> forces_, loads_, scratch_;
  std::vector<double> residual_;
  double tolerance_ = 0.0, ofStrain_ = 0.0, assemblySeconds_ = 0.0, solverSeconds_ = 0.0;
};

void validate(const NewtonOptions& options);

/// Newton iterations at fixed t from the present displacement; prescribed components move first, with what the tangent
/// says of the rest.
/// @return iterations, or −1 with the reason
struct NewtonResult {
  int iterations;
  double residual;
  std::string failure;
};
NewtonResult iterate(Equilibrium& equilibrium, double t, const NewtonOptions& options);

/// Books the work of a step from (f0, u0) to the present forces and displacement by the trapezoidal rule.
void bookWork(const Equilibrium& equilibrium, const Model& model, std::span<const Vec3> f0,
              std::span<const Vec3> loads0, std::span<const Vec3> u0, StaticReport& report);

/// The terms adopt their history at time t; books what they dissipated and what their own motion did.
void acceptTerms(Model& model, double t, StaticReport& report);

/// Fills in what a report says at the end of a solution, and leaves the forces in nodes.f.
void finishReport(Equilibrium& equilibrium, std::chrono::steady_clock::time_point start, StaticReport& report);

}  // namespace dovetail::fem::detail
