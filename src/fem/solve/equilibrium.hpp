// Out-of-balance forces and tangent of a model for the implicit solvers.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/fem/solve/statics.hpp"
#include "mixing.hpp"
#include "newton.hpp"
#include "newton_tools.hpp"

namespace dovetail::fem::detail {

/// Forces of a model, whose state is the model's own, and what is out of balance.
class Balance {
public:
  /// Forces count as balanced at `relative` of the largest norm of a term's forces, plus `absolute`, N.
  Balance(Model& model, double relative, double absolute);
  virtual ~Balance() = default;
  Balance(const Balance&) = delete;
  Balance& operator=(const Balance&) = delete;

  /// Forces are asked for at this instant from now on.
  void aim(const Instant& now) { now_ = now; }
  const Instant& now() const { return now_; }
  /// Σ forces into forces(), its free part into residual(). @return the norm of that, NaN included
  double findForces();
  /// What counts as zero, after findForces().
  double zero() const { return zero_; }

  Model& model() const { return model_; }
  const DofMap& dofs() const { return dofs_; }
  std::span<const double> residual() const { return residual_; }
  std::span<const Vec3> forces() const { return forces_; }
  /// Of the terms without energy alone.
  std::span<const Vec3> loads() const { return loads_; }

  /// A step was given up: what was kept from it is not to be trusted.
  virtual void forget() {}
  virtual int negativePivots() const { return -1; }
  /// Fills in what the solver has to say.
  virtual void describe(StaticReport& report) const { report.assemblySeconds = assemblySeconds_; }

protected:
  ForceResolution resolution_;
  double assemblySeconds_ = 0.0;

private:
  Model& model_;
  double relative_, absolute_, zero_ = 0.0;
  double far_ = 0.0;  // a thousand times the extent, as a norm of displacements, m
  Instant now_;
  DofMap dofs_;
  std::vector<Vec3> forces_, loads_, scratch_;
  std::vector<double> residual_;
};

/// Σ forces = 0 at a fixed time, by Newton's method.
class Equilibrium : public Balance, public NewtonProblem {
public:
  Equilibrium(Model& model, const NewtonOptions& options);

  double evaluate() override { return findForces(); }
  double tolerance() const override { return zero(); }
  bool factored() const override { return solver_.factored(); }
  bool factor(bool exact = true) override;
  bool direct(double loosest) override;
  double slope() const override { return innerProduct(residual(), increment_); }
  bool endMixing() override { return std::exchange(mixes_, false); }
  void moveTo(double fraction) override;

  /// Moves prescribed components to the time aimed at and the free ones with them, by the tangent of the old state.
  /// @return false if that is singular
  bool predict();
  void solve(std::span<const double> r, std::span<double> x, double loosest = 0.0);
  const linalg::BlockMatrix& stiffness() const { return K_; }

  void forget() override { solver_.drop(); }
  /// A new step begins.
  void beginStep() {
    if (mixing_) mixing_->clear();
    mixes_ = mixing_.has_value();
    solvesBefore_ = std::exchange(solves_, 0);
  }
  int negativePivots() const override { return solver_.negativePivots(); }
  void describe(StaticReport& report) const override;

private:
  LinearSolver solver_;
  linalg::BlockMatrix K_;
  std::vector<Vec3> start_;
  std::vector<double> increment_, part_;
  std::optional<Mixing> mixing_;
  bool mixes_ = false;
  std::size_t solves_ = 0, solvesBefore_ = 0;  // increments in this step and the one before
  double solverSeconds_ = 0.0;
};

void validate(const NewtonOptions& options);
/// @throws InputError unless tEnd is later than the model
void requireLater(double tEnd, const Model& model, const char* where);
NewtonPolicy policyOf(const NewtonOptions& options);

/// Books the work of loads and supports in a step from (f0, u0) to the present forces and displacement by the
/// trapezoidal rule. @return J that was done by what was out of balance along the free components, which is not booked
double bookWork(const Balance& balance, std::span<const Vec3> f0, std::span<const Vec3> loads0,
                std::span<const Vec3> u0, StaticReport& report);

/// The terms adopt their history; books what they dissipated and what their own motion did.
void acceptTerms(Model& model, const Instant& now, StaticReport& report);

/// Fills in what a report says at the end of a solution.
void finishReport(const Balance& balance, std::chrono::steady_clock::time_point start, StaticReport& report);

/// Steps of model time that grow and shrink with the iterations they need.
struct LoadSteps {
  double first, largest, smallest;  // s
  int iterationTarget;
};
/// @throws InputError for lengths ≤ 0
void validate(const LoadSteps& steps);
/// How a step is made.
struct StepWays {
  std::function<NewtonResult(const Instant&)> attempt;  ///< leaves the model as it was if it fails; is cut then
  /// Where the smallest fails: accepts histories and books what it does; empty: none.
  std::function<NewtonResult(const Instant&, StaticReport&)> motion;
};
/// For errors.
struct StepWords {
  std::string name;    ///< of the caller
  std::string remedy;  ///< if the smallest step fails
};
/// Takes the model from model.t to tEnd.
StaticReport takeSteps(Balance& balance, double tEnd, LoadSteps steps, const StaticObserver& observer,
                       const StepWays& ways, const StepWords& words);

}  // namespace dovetail::fem::detail
