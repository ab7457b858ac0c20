// The iterations of an implicit step.
#include <algorithm>
#include <cmath>

#include "../solve/newton_tools.hpp"
#include "dovetail/core/finite.hpp"
#include "implicit_step.hpp"

namespace dovetail::fem::detail {

/// The state that the correction says, its forces and their balance; returns the norm.
double ImplicitStep::trial(double h) {
  applyCorrection(h);
  evaluate(h);
  return balance();
}

/// Shortens an increment that went too far: looks for a share of it with r · increment well below its value at the
/// start (Matthies & Strang 1979). The state is at the full increment, with the norm given; returns that of the share
/// found.
double ImplicitStep::search(double h, double norm, double slopeAtStart) {
  double share = 1.0;
  for (int round = 0; round < 8; ++round) {
    const double slope = product(residual_, increment_);
    const bool finite = std::isfinite(norm);
    if (finite && (std::abs(slope) <= 0.8 * std::abs(slopeAtStart) || slope * slopeAtStart > 0.0)) return norm;
    const double next = shorterShare(share, slopeAtStart, slope);
    part_ = increment_;
    for (double& value : part_) value *= next - share;
    dofs_.addIncrement(part_, correction_);
    share = next;
    norm = trial(h);
  }
  return norm;
}

ImplicitStep::Result ImplicitStep::newton(double h) {
  Result result;
  double before = 0.0, norm = trial(h);
  bool hard = false;  // once an iteration has gone the wrong way, old factors are not trusted in this step
  for (int sinceFactor = 0;; ++result.iterations) {
    result.residual = tolerance_ > 0.0 ? norm / tolerance_ : 0.0;
    if (!std::isfinite(norm)) return result.failure = "the forces are not finite", result;
    if (result.iterations > 0 && norm <= tolerance_) return result;
    if (result.iterations == options_.maxIterations) {
      result.failure = "Newton's method does not converge: " + formatNumber(norm) + " N out of balance after " +
                       std::to_string(result.iterations) + " iterations";
      return result;
    }
    const bool stale = hard || !solver_.factored() || factoredStep_ != h || sinceFactor >= options_.refactorAfter ||
                       (sinceFactor > 0 && norm > options_.refactorContraction * before);
    if (stale) {
      if (!factor(h, hard)) return result.failure = "the matrix of the step is singular or not finite", result;
      sinceFactor = 0;
    }
    ++sinceFactor;
    before = norm;
    {
      const Profile::Stage stage(profile_, "solution");
      solver_.solve(residual_, increment_);
      dofs_.addIncrement(increment_, correction_);
    }
    const double slope = product(residual_, increment_);
    norm = trial(h);
    hard = hard || !(norm <= before);
    if (!std::isfinite(norm)) norm = search(h, norm, slope);
  }
}

}  // namespace dovetail::fem::detail
