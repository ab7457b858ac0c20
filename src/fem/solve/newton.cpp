#include "newton.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/linalg/sparse.hpp"

namespace dovetail::fem::detail {

namespace {

/// Where the slope vanishes by the secant, kept between a tenth and eight tenths of the fraction tried; a quarter if
/// there is no slope.
double shorterFraction(double fraction, double slopeAtStart, double slope) {
  if (!std::isfinite(slope) || slope == slopeAtStart) return 0.25 * fraction;
  return std::clamp(-slopeAtStart * fraction / (slope - slopeAtStart), 0.1 * fraction, 0.8 * fraction);
}

/// Finds a fraction of the increment with a slope well below that at the start. The state is at the full increment with
/// the norm given. @return the norm at the fraction found
double search(NewtonProblem& problem, double norm, double slopeAtStart) {
  double fraction = 1.0;
  for (int trial = 0; trial < 8; ++trial) {
    const double slope = problem.slope();
    if (std::isfinite(norm) && (std::abs(slope) <= 0.8 * std::abs(slopeAtStart) || norm <= problem.tolerance()))
      return norm;
    if (std::isfinite(norm) && slope * slopeAtStart > 0.0) return norm;  // still downhill: a full step is as good
    fraction = shorterFraction(fraction, slopeAtStart, slope);
    problem.moveTo(fraction);
    norm = problem.evaluate();
  }
  return norm;
}

/// The reason why a term does not trust the state; empty if all do.
std::string complaint(const Model& model, double t) {
  try {
    for (const auto& term : model.terms)
      term->requireValid(model.nodes, "t = " + formatNumber(t) + " s", Scrutiny::all);
  } catch (const NumericalError& error) {
    return error.what();
  }
  return {};
}

NewtonResult solveAugmented(Model& model, const Instant& now, int maxAugmentations,
                            const std::function<NewtonResult()>& solve) {
  NewtonResult result = solve();
  for (int round = 0; result.failure.empty(); ++round) {
    bool again = false;
    for (const auto& term : model.terms) again = term->augment(model.nodes, now) || again;
    if (!again) break;
    if (round == maxAugmentations) {
      result.failure = "contact multipliers do not settle in " + std::to_string(round) + " rounds";
      break;
    }
    const int before = result.iterations;
    result = solve();
    result.iterations += before;
  }
  const std::string why = complaint(model, now.t);
  if (!why.empty()) result.failure += (result.failure.empty() ? "" : "; ") + why;
  return result;
}

/// Displacements and velocities as they were, and the terms' multipliers.
class StepStart {
public:
  explicit StepStart(Model& model) : model_(model), u_(model.nodes.u), v_(model.nodes.v) {}
  void restore() {
    model_.nodes.u = u_;
    model_.nodes.v = v_;
    for (const auto& term : model_.terms) term->revert();
  }

private:
  Model& model_;
  std::vector<Vec3> u_, v_;
};

/// How well the linear system of an iteration is to be solved: by as much as the iteration before it shrank the
/// residual, squared (Eisenstat & Walker 1996, SIAM J. Sci. Comput. 17, 16: choice 2), and not beyond what converges.
double forcingTerm(double norm, double before, double tolerance) {
  constexpr double most = 1e-2;
  const double shrunk = before > 0.0 ? norm / before : 1.0;
  return std::min(std::max(0.9 * shrunk * shrunk, 0.5 * tolerance / norm), most);
}

/// Whether the last iterations with the same factors shrank the residual to the fraction wanted.
bool shrinksEnough(double norm, const std::vector<double>& earlier, const NewtonPolicy& policy) {
  const std::size_t over = policy.keepOver;
  return earlier.size() < over || norm <= policy.keepContraction * earlier[earlier.size() - over];
}

}  // namespace

NewtonResult newton(NewtonProblem& problem, const NewtonPolicy& policy) {
  NewtonResult result;
  double norm = problem.evaluate(), before = 0.0;
  std::vector<double> judged;  // residuals that the factors are judged by, the newest last
  bool distrusted = false;     // the factors that are there
  const auto stop = [&](const std::string& failure) {
    result.failure = failure;
    return result;
  };
  for (int sinceFactor = 0;; ++result.iterations) {
    result.residual = norm;
    result.tolerance = problem.tolerance();
    if (!std::isfinite(norm)) return stop("the forces are not finite");
    if (norm <= result.tolerance && (result.iterations > 0 || (norm == 0.0 && problem.factored()))) return result;
    if (result.iterations == policy.maxIterations)
      return stop("Newton's method does not converge: " + formatNumber(norm) + " N out of balance after " +
                  std::to_string(result.iterations) + " iterations");
    const bool keep =
        !distrusted && problem.factored() && sinceFactor < policy.keepIterations && shrinksEnough(norm, judged, policy);
    if (!keep) {
      if (!problem.factor(distrusted)) return stop("the tangent is singular or not finite");
      sinceFactor = 0;
      judged.clear();
      distrusted = distrusted && policy.keepOver == 1;
    }
    ++sinceFactor;
    judged.push_back(norm);
    const double loosest = forcingTerm(norm, before, result.tolerance);
    before = norm;
    if (!problem.direct(loosest)) return stop("the arc does not intersect the path");
    const double slope = problem.slope();
    problem.moveTo(1.0);
    norm = problem.evaluate();
    if (!(norm <= before)) {
      if (problem.endMixing())
        judged.clear();
      else
        distrusted = true;
    }
    const bool searches = std::isfinite(norm) ? policy.lineSearch == LineSearch::always && result.iterations > 0
                                              : policy.lineSearch != LineSearch::never;
    if (searches) norm = search(problem, norm, slope);
  }
}

NewtonResult attemptStep(Model& model, const Instant& now, int maxAugmentations,
                         const std::function<NewtonResult()>& solve) {
  StepStart start(model);
  NewtonResult result;
  try {
    result = solveAugmented(model, now, maxAugmentations, solve);
  } catch (const InputError&) {
    start.restore();
    throw;
  } catch (const LostError&) {
    start.restore();
    throw;
  } catch (const linalg::FactorMemoryError&) {  // a shorter step needs as much
    start.restore();
    throw;
  } catch (const std::bad_alloc&) {
    start.restore();
    throw;
  } catch (const std::exception& error) {
    result.failure = error.what();
  }
  if (!result.failure.empty()) start.restore();
  return result;
}

}  // namespace dovetail::fem::detail
