#include "dynamic_relaxation.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/checkpoint.hpp"
#include "dovetail/fem/motion/stable_step.hpp"

namespace dovetail::fem::detail {

namespace {

constexpr int comingOn = 100;  // iterations: so that moved supports send no shock

/// Work over the way from the state that was booked last to the present one, by the trapezoidal rule, and histories.
class MotionLedger {
public:
  MotionLedger(const Balance& balance, StaticReport& report) : balance_(balance), report_(report) {}

  void take(double kinetic) {
    if (!u_.empty()) book();
    acceptTerms(balance_.model(), balance_.now(), report_);
    report_.largestKinetic = std::max(report_.largestKinetic, kinetic);
    remember();
  }
  /// Forces at the last equilibrium.
  void remember() {
    u_ = balance_.model().nodes.u;
    f_.assign(balance_.forces().begin(), balance_.forces().end());
    loads_.assign(balance_.loads().begin(), balance_.loads().end());
  }

private:
  /// What is out of balance along the free components goes into motion, and is damped by the end.
  void book() { report_.damped += bookWork(balance_, f_, loads_, u_, report_); }

  const Balance& balance_;
  StaticReport& report_;
  std::vector<Vec3> u_, f_, loads_;
};

}  // namespace

DynamicRelaxation::DynamicRelaxation(Balance& balance, double step)
    : balance_(balance),
      mass_(balance.model(), balance.dofs(), 0.0),
      step_(step),
      h_(step),
      velocity_(balance.model().nodes.u.size()),
      acceleration_(velocity_.size()),
      momentum_(velocity_.size()) {}

Instant DynamicRelaxation::instantOf(const Instant& end, bool comesOn, int iteration, bool remembers) const {
  const auto fractionAt = [&](int k) { return comesOn ? std::min(1.0, (k + 1.0) / comingOn) : 1.0; };
  const double fraction = fractionAt(iteration), from = end.t - end.dt;
  const double before = !remembers ? 0.0 : iteration > 0 ? fractionAt(iteration - 1) : comesOn ? 0.0 : 1.0;
  return {fraction < 1.0 ? from + fraction * end.dt : end.t, (fraction - before) * end.dt};
}

NewtonResult DynamicRelaxation::relax(const Instant& end, bool comesOn, int maxIterations, const Visitor& visitor) {
  if (step_ == 0.0) h_ = 0.9 * stableStep(balance_.model()).dt;
  std::vector<Vec3> f0;
  std::fill(velocity_.begin(), velocity_.end(), Vec3{});
  NewtonResult result;
  for (;; ++result.iterations) {
    const bool whole = !comesOn || result.iterations + 1 >= comingOn;
    balance_.aim(instantOf(end, comesOn, result.iterations, static_cast<bool>(visitor)));
    balance_.dofs().apply(balance_.now().t, balance_.model().nodes.u);
    result.residual = balance_.findForces();
    result.tolerance = balance_.zero();
    if (!std::isfinite(result.residual)) return result.failure = "the forces are not finite", result;
    if (visitor) visitor();
    if (whole && result.residual <= result.tolerance) return result;
    if (result.iterations == maxIterations) {
      result.failure = "the motion does not come to rest: " + formatNumber(result.residual) +
                       " N out of balance after " + std::to_string(result.iterations) + " iterations";
      return result;
    }
    if (whole && f0.empty()) {
      f0.assign(balance_.forces().begin(), balance_.forces().end());
      reference_ = balance_.model().nodes.u;
    }
    if (whole) findFrequency(f0);
    oscillate(whole ? omega_ : 0.0);
  }
}

void DynamicRelaxation::findFrequency(std::span<const Vec3> f0) {
  std::vector<Vec3> way = balance_.model().nodes.u;
  double work = 0.0;
  for (std::size_t n = 0; n < way.size(); ++n) {
    way[n] -= reference_[n];
    work += dot(way[n], f0[n] - balance_.forces()[n]);
  }
  mass_.multiply(way, momentum_);
  const double inertia = innerProduct(way, momentum_);
  if (work > 0.0 && inertia > 0.0) omega_ = std::min(std::sqrt(work / inertia), 1.0 / h_);
}

/// Half a step on with damping 2 ω, and the displacement a whole one.
void DynamicRelaxation::oscillate(double omega) {
  std::fill(acceleration_.begin(), acceleration_.end(), Vec3{});
  mass_.accelerate(balance_.forces(), acceleration_);
  const double damping = omega * h_;
  for (std::size_t n = 0; n < velocity_.size(); ++n) {
    velocity_[n] = ((1.0 - damping) * velocity_[n] + h_ * acceleration_[n]) / (1.0 + damping);
    balance_.model().nodes.u[n] += h_ * velocity_[n];
  }
}

NewtonResult moveToRest(Balance& balance, DynamicRelaxation& relaxation, const Instant& end, int maxIterations,
                        int maxAugmentations, StaticReport& report) {
  ByteWriter before;
  save(balance.model(), before);
  StaticReport moved = report;
  MotionLedger book(balance, moved);
  bool comesOn = true;
  balance.aim({end.t - end.dt, 0.0});
  balance.findForces();
  book.remember();
  const NewtonResult result = attemptStep(balance.model(), end, maxAugmentations, [&] {
    const NewtonResult trial =
        relaxation.relax(end, comesOn, maxIterations, [&] { book.take(relaxation.kineticEnergy()); });
    comesOn = false;
    return trial;
  });
  if (!result.failure.empty()) {
    ByteReader bytes(before.bytes());
    load(balance.model(), bytes);
    return result;
  }
  moved.motionIterations += result.iterations;
  ++moved.motions;
  report = std::move(moved);
  return result;
}

}  // namespace dovetail::fem::detail
