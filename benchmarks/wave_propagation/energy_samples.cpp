#include <algorithm>
#include <limits>

#include "run.hpp"

namespace dovetail::wave {

double energyAt(const std::vector<EnergySample>& energy, double t) {
  const auto after =
      std::lower_bound(energy.begin(), energy.end(), t, [](const EnergySample& s, double time) { return s.t < time; });
  if (after == energy.end() || after == energy.begin()) return std::numeric_limits<double>::quiet_NaN();
  const EnergySample &a = *(after - 1), &b = *after;
  return a.joules + (b.joules - a.joules) * (t - a.t) / (b.t - a.t);
}

double dissipatedShare(const std::vector<EnergySample>& energy, int particlesPerEdge) {
  const bool one = particlesPerEdge == 1;
  return 1.0 - energyAt(energy, one ? 60.8e-3 : 81.7e-3) / energyAt(energy, one ? 19.3e-3 : 19.9e-3);
}

}  // namespace dovetail::wave
