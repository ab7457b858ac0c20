// One implicit step of a model: Newton's method for the displacement at its end.
#pragma once

#include <string>
#include <vector>

#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "force_sum.hpp"
#include "run_state.hpp"
#include "solve/newton.hpp"

namespace dovetail::fem::detail {

void validate(const ImplicitOptions& options);

/// Work space of a step from (u₀, v₀, a₀) at model.t to the end of the step. Displacement is u₁ = base + c, and
/// acceleration a multiple of the correction c, so that what changes by little is known well.
class ImplicitStep : private NewtonProblem {
public:
  ImplicitStep(Model& model, const DofMap& dofs, ModelMass& mass, const ImplicitOptions& options, Profile& profile);

  /// Takes forces and accelerations of the present state as those of the start of a step h.
  void begin(double h);
  /// Moves the model by h (time is left alone). On failure u and v are as before; so they are if an error passes
  /// through.
  enum class Guess { coast, rest };  ///< start from u₀ + h v₀, or from u₀
  NewtonResult attempt(double h, Guess guess);
  /// Makes the end the start of the next step. Call after booking.
  void accept();
  /// What the linear systems of the steps are going to take.
  linalg::LinearForecast forecast() { return solver_.forecast(matrix_, isSymmetric()); }
  void use(const Scheme& scheme) {
    options_.scheme = scheme;
    solver_.drop();
  }

  // Of the accepted step, for the ledger:
  const std::vector<Vec3>& startDisplacement() const { return u0_; }
  const std::vector<Vec3>& startVelocity() const { return v0_; }
  /// Mean total force of the step (conserving: the force of the step).
  std::vector<Vec3> meanForce() const;
  /// What gave the step its momentum, in total and by a term that is kept apart: with the weights 1 − γ and γ of both
  /// ends by which Newmark's velocities change; means for schemes of two instants.
  std::vector<Vec3> givenForce() const { return weighted(end_.total, start_.total); }
  std::vector<Vec3> givenLoad(std::size_t term) const { return weighted(end_.loads[term], start_.loads[term]); }
  double loadWork(std::size_t term, const std::vector<Vec3>& motion) const;
  const LinearSolver& solver() const { return solver_; }
  /// Names of the terms with an energy that a conserving step does not keep.
  std::vector<std::string> termsAtMeanState() const;
  /// At the end of the last accepted step (conserving: of that step).
  const std::vector<Vec3>& forces() const { return conserving() ? end_.total : start_.total; }

  /// What the next step begins with. Factors serve many steps: they are those of the matrix that goes along, or else
  /// what follows would have other digits.
  struct State {
    StepStart start;
    double factoredStep = 0.0;
    ForceResolution resolution;
    LinearSolver::Factored factored;
  };
  void save(ByteWriter& archive) const;
  /// @throws InputError as readStart and LinearSolver::read
  State read(ByteReader& archive) const;
  void restart(State state);

private:
  bool conserving() const { return options_.scheme.conserving; }
  Instant atEnd() const { return {model_.t + h_, h_, &mass_, !conserving()}; }
  Instant inMiddle() const { return {model_.t + 0.5 * h_, 0.5 * h_, &mass_}; }
  std::vector<Vec3> weighted(std::vector<Vec3> end, const std::vector<Vec3>& start) const;
  void addStartRates(double h);
  void setBase();
  void makeGuess(Guess guess);
  void applyCorrection();
  void findForces();
  void findConservingForces();
  double balance();
  void addMeanTangents();
  bool isSymmetric() const;

  double evaluate() override;
  double tolerance() const override { return tolerance_; }
  bool factored() const override { return solver_.factored() && factoredStep_ == h_; }
  bool factor(bool exact) override;
  bool direct(double loosest) override;
  double slope() const override { return innerProduct(residual_, increment_); }
  void moveTo(double fraction) override;

  Model& model_;
  const DofMap& dofs_;
  ModelMass& mass_;
  ImplicitOptions options_;
  Profile& profile_;
  LinearSolver solver_;
  linalg::BlockMatrix matrix_;
  Nodes mean_;  // state in the middle of a conserving step
  struct Forces : ForceSum {
    using ForceSum::ForceSum;
    std::vector<Vec3> total;
  };
  Forces start_, end_;
  std::vector<char> conserves_;  // per term, of the last evaluation
  ForceResolution resolution_;
  std::vector<Vec3> u0_, v0_, a0_, a1_, base_, correction_, startCorrection_, inertia_, work_;
  std::vector<double> residual_, increment_, part_;
  double h_ = 0.0, tolerance_ = 0.0, factoredStep_ = 0.0;
};

}  // namespace dovetail::fem::detail
