// Newton's method and the trial of a step, for equilibria, paths and implicit steps alike.
#pragma once

#include <functional>
#include <string>

#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem::detail {

/// A state with a residual, and a way to better it.
class NewtonProblem {
public:
  NewtonProblem() = default;
  virtual ~NewtonProblem() = default;
  NewtonProblem(const NewtonProblem&) = delete;
  NewtonProblem& operator=(const NewtonProblem&) = delete;

  /// Residual at the present state. @return its norm, NaN included
  virtual double evaluate() = 0;
  /// What counts as zero, after evaluate().
  virtual double tolerance() const = 0;
  /// Whether there are factors that may serve at the present state.
  virtual bool factored() const = 0;
  /// @param exact  even if the iteration would be cheaper with an approximation
  /// @return false if the matrix is singular or not finite
  virtual bool factor(bool exact) = 0;
  /// Finds the increment from the present state. @param loosest  relative residual of the linear system that is enough
  /// @return false if there is none
  virtual bool direct(double loosest) = 0;
  /// residual · increment at the present state.
  virtual double slope() const = 0;
  /// From now on increments are those of the factors alone. @return whether they were mixed with earlier ones until now
  virtual bool endMixing() { return false; }
  /// To the fraction of the increment, from the state that direct() met.
  virtual void moveTo(double fraction) = 0;
};

/// When an increment is shortened. Where the matrix is not the derivative of the residual, or that is not a gradient,
/// the slope is a poor guide: then only if the forces break down.
enum class LineSearch { never, afterBreakdown, always };

struct NewtonPolicy {
  int maxIterations;
  LineSearch lineSearch = LineSearch::always;
  /// Factors are kept for so many iterations, while `keepOver` of them together shrink the residual to this fraction.
  int keepIterations = 0;
  double keepContraction = 0.0;
  std::size_t keepOver = 1;
};

struct NewtonResult {
  int iterations = 0;
  double residual = 0.0, tolerance = 0.0;
  std::string failure;  ///< empty if it converged
};

/// Full steps, shortened where they overshoot (Matthies & Strang 1979; not the first one, which finds its way back from
/// large strains of a mere prediction better than a short one). An iteration after which the residual is larger ends
/// the mixing of increments; if they are not mixed, the factors are made anew, and never kept again where each
/// iteration judges them (keepOver = 1).
NewtonResult newton(NewtonProblem& problem, const NewtonPolicy& policy);

/// Solves a step and lets the terms augment their multipliers and judge the state; whatever they or the solvers throw
/// is a failure. After a failure u, v and multipliers are as before; so they are if InputError or lack of memory pass
/// through.
/// @param now  of the end of the step, read after each solve()
NewtonResult attemptStep(Model& model, const Instant& now, int maxAugmentations,
                         const std::function<NewtonResult()>& solve);

}  // namespace dovetail::fem::detail
