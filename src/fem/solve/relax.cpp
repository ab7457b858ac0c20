#include "dovetail/fem/solve/relax.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "equilibrium.hpp"

namespace dovetail::fem {

namespace {

using detail::innerProduct;
using detail::NewtonResult;

void validate(const RelaxOptions& options) {
  requirePositive(options.relativeTolerance, "relativeTolerance");
  requireNonNegative(options.absoluteTolerance, "absoluteTolerance");
  requireNonNegative(options.iterationStep, "iterationStep");
  if (options.maxIterations < 1)
    throw InputError("no iterations are allowed", "RelaxOptions", "give maxIterations of 1 or more");
}

class Relaxation : public detail::Balance {
public:
  Relaxation(Model& model, const RelaxOptions& options)
      : Balance(model, options.relativeTolerance, options.absoluteTolerance),
        options_(options),
        mass_(model, dofs(), 0.0),
        h_(options.iterationStep),
        velocity_(model.nodes.u.size()),
        acceleration_(velocity_.size()),
        momentum_(velocity_.size()) {}

  void describe(StaticReport& report) const override {
    Balance::describe(report);
    report.solver = "dynamic relaxation";
  }

  /// From rest to rest at the instant.
  NewtonResult settle(const Instant& end, bool comesOn) {
    if (options_.iterationStep == 0.0) h_ = 0.9 * stableStep(model()).dt;
    const std::vector<Vec3> u0 = model().nodes.u;
    std::vector<Vec3> f0;
    std::fill(velocity_.begin(), velocity_.end(), Vec3{});
    NewtonResult result;
    for (;; ++result.iterations) {
      const double share = comesOn ? std::min(1.0, (result.iterations + 1.0) / comingOn) : 1.0;
      const double from = end.t - end.dt;
      aim({share < 1.0 ? from + share * end.dt : end.t, share * end.dt});
      dofs().apply(now().t, model().nodes.u);
      result.residual = findForces();
      result.tolerance = zero();
      if (!std::isfinite(result.residual)) return result.failure = "the forces are not finite", result;
      if (share == 1.0 && result.residual <= result.tolerance) return result;
      if (result.iterations == options_.maxIterations) {
        result.failure = "the motion does not come to rest: " + formatNumber(result.residual) +
                         " N out of balance after " + std::to_string(result.iterations) + " iterations";
        return result;
      }
      if (share == 1.0 && f0.empty()) {
        f0.assign(forces().begin(), forces().end());
        reference_ = model().nodes.u;
      }
      swing(share == 1.0 ? frequency(f0) : 0.0);
    }
  }

private:
  static constexpr double comingOn = 100.0;  // iterations: so that moved supports send no shock

  /// ω of the displacement since the whole load acts; 0 if it costs no force.
  double frequency(std::span<const Vec3> f0) {
    std::vector<Vec3> way = model().nodes.u;
    double work = 0.0;
    for (std::size_t n = 0; n < way.size(); ++n) {
      way[n] -= reference_[n];
      work += dot(way[n], f0[n] - forces()[n]);
    }
    mass_.multiply(way, momentum_);
    const double inertia = innerProduct(way, momentum_);
    return work > 0.0 && inertia > 0.0 ? std::min(std::sqrt(work / inertia), 1.0 / h_) : 0.0;
  }
  /// Half a step on with damping 2 ω, and the displacement a whole one.
  void swing(double omega) {
    std::fill(acceleration_.begin(), acceleration_.end(), Vec3{});
    mass_.accelerate(forces(), acceleration_);
    const double damping = omega * h_;
    for (std::size_t n = 0; n < velocity_.size(); ++n) {
      velocity_[n] = ((1.0 - damping) * velocity_[n] + h_ * acceleration_[n]) / (1.0 + damping);
      model().nodes.u[n] += h_ * velocity_[n];
    }
  }

  RelaxOptions options_;
  ModelMass mass_;
  double h_;
  std::vector<Vec3> velocity_, acceleration_, momentum_, reference_;
};

}  // namespace

StaticReport relax(Model& model, double tEnd, const RelaxOptions& options, const StaticObserver& observer) {
  validate(options);
  const detail::LoadSteps steps{options.firstStep, options.largestStep, options.smallestStep, options.maxIterations};
  detail::validate(steps);
  detail::requireLater(tEnd, model, "relax");
  Relaxation relaxation(model, options);
  const auto attempt = [&](const Instant& now) {
    bool comesOn = true;
    return detail::attemptStep(model, now, options.maxAugmentations, [&] {
      const NewtonResult result = relaxation.settle(now, comesOn);
      comesOn = false;
      return result;
    });
  };
  return detail::takeSteps(relaxation, tEnd, steps, observer, attempt, "relax",
                           "give smaller steps, a smaller iterationStep or more iterations");
}

}  // namespace dovetail::fem
