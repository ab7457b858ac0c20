#include "reference/moving_force.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cantilever {

using Eigen::ArrayXd;

BeamHistory simulateMovingForce(const BeamModes& modes, const MovingForce& load, double observed) {
  const auto count = static_cast<Eigen::Index>(modes.omega.size());
  requirePositive(load.speed, "speed");
  if (!(load.dt > 0.0 && load.dt * modes.omega.back() < 2.0))
    throw InputError("dt = " + formatNumber(load.dt) + " s is unstable for the highest mode", "dt",
                     "use a positive step below " + formatNumber(2.0 / modes.omega.back()) + " s");
  const ArrayXd omegaSquared = Eigen::Map<const ArrayXd>(modes.omega.data(), count).square();
  const Eigen::VectorXd observer = evaluateModes(modes, observed).deflection.col(0);
  const auto steps = static_cast<long>(modes.length / (load.speed * load.dt));
  ArrayXd q = ArrayXd::Zero(count), p = q;
  const auto acceleration = [&](double s) -> ArrayXd {
    return -load.force * evaluateModes(modes, s).deflection.col(0).array() - omegaSquared * q;
  };
  BeamHistory history{{0.0}, {0.0}};
  ArrayXd a = acceleration(0.0);
  for (long step = 1; step <= steps; ++step) {
    const double time = static_cast<double>(step) * load.dt;
    p += 0.5 * load.dt * a;
    q += load.dt * p;
    a = acceleration(std::min(load.speed * time, modes.length));
    p += 0.5 * load.dt * a;
    history.time.push_back(time);
    history.deflection.push_back(observer.dot(q.matrix()));
  }
  return history;
}

}  // namespace dovetail::cantilever
