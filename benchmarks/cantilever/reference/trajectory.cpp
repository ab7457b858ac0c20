#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "reference/moving_mass.hpp"

namespace dovetail::cantilever {
namespace {

struct HermiteValue {
  double value, slope;
};

// Cubic through value and slope at both ends of an interval of width h, at fraction u.
HermiteValue hermite(double f0, double d0, double f1, double d1, double h, double u) {
  const double chord = f1 - f0, a = h * d0 - chord, b = chord - h * d1;
  return {f0 + u * (chord + (1.0 - u) * (a * (1.0 - u) + b * u)),
          (chord + (1.0 - 2.0 * u) * (a * (1.0 - u) + b * u) + u * (1.0 - u) * (b - a)) / h};
}

// Interval of the ascending samples that holds the value.
std::size_t intervalOf(const std::vector<double>& samples, double value, const char* field) {
  if (samples.size() < 2 || !(value >= samples.front() && value <= samples.back()))
    throw InputError("no reference at " + std::string(field) + " = " + formatNumber(value), field,
                     "stay inside the simulated range");
  const auto after = std::upper_bound(samples.begin() + 1, samples.end() - 1, value);
  return static_cast<std::size_t>(after - samples.begin()) - 1;
}

}  // namespace

BeamPosition DynamicReference::at(double t) const {
  const std::size_t i = intervalOf(time, t, "time");
  const double h = time[i + 1] - time[i], u = (t - time[i]) / h;
  const HermiteValue alongY = hermite(y[i], vy[i], y[i + 1], vy[i + 1], h, u);
  const HermiteValue alongZ = hermite(z[i], vz[i], z[i + 1], vz[i + 1], h, u);
  return {alongY.value, alongZ.value, alongY.slope, alongZ.slope};
}

double DynamicReference::timeAtY(double position) const {
  const std::size_t i = intervalOf(y, position, "y");
  double lower = time[i], upper = time[i + 1];
  while (true) {
    const double middle = 0.5 * (lower + upper);
    if (middle <= lower || middle >= upper) return middle;
    (at(middle).y < position ? lower : upper) = middle;
  }
}

BeamPosition DynamicReference::atY(double position) const { return at(timeAtY(position)); }

}  // namespace dovetail::cantilever
