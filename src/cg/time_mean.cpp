#include <string>

#include "checks.hpp"
#include "dovetail/cg/fields.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cg {

void addFrame(TimeMean& mean, const Fields& frame, double duration) {
  requirePositive(duration, "time that a frame stands for");
  if (mean.time == 0.0) {
    mean = {frame, duration};
    return;
  }
  Fields& all = mean.mean;
  requireSameLength(all.size(), frame.size(), "points of the frames of a mean");
  requireSameLength(all.solidFraction.size(), frame.solidFraction.size(), "solid fractions of the frames of a mean");
  const double time = mean.time + duration, before = mean.time / time, now = duration / time;
  const auto blend = [&](auto& a, const auto& b) {
    for (std::size_t p = 0; p < a.size(); ++p) a[p] = before * a[p] + now * b[p];
  };
  for (std::size_t p = 0; p < frame.size(); ++p) {
    // What the means of two sets differ by is fluctuation about the mean of both (Chan, Golub & LeVeque 1979).
    const double m = before * all.density[p], n = now * frame.density[p], density = m + n;
    const Vec3 d = frame.velocity[p] - all.velocity[p];
    const Eigen::Vector3d apart(d.x, d.y, d.z);
    const double reduced = density > 0.0 ? m * (n / density) : 0.0;
    all.kineticStress[p] =
        before * all.kineticStress[p] + now * frame.kineticStress[p] - reduced * apart * apart.transpose();
    all.velocity[p] = density > 0.0 ? (m * all.velocity[p] + n * frame.velocity[p]) / density : Vec3{};
    all.temperature[p] = density > 0.0 ? -all.kineticStress[p].trace() / (3.0 * density) : 0.0;
  }
  blend(all.density, frame.density);
  blend(all.solidFraction, frame.solidFraction);
  blend(all.momentum, frame.momentum);
  blend(all.contactStress, frame.contactStress);
  blend(all.wallForce, frame.wallForce);
  mean.time = time;
}

}  // namespace dovetail::cg
