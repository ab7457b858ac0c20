#include "dovetail/fem/model/time_functions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

TimeFunction constant(double value) {
  return [value](double) { return value; };
}

TimeFunction ramp(double duration, double value) {
  requirePositive(duration, "duration of the ramp");
  return [=](double t) { return value * std::clamp(t / duration, 0.0, 1.0); };
}

TimeFunction smoothRamp(double duration, double value) {
  requirePositive(duration, "duration of the ramp");
  return [=](double t) {
    const double s = std::clamp(t / duration, 0.0, 1.0);
    return value * s * s * s * (10.0 + s * (6.0 * s - 15.0));
  };
}

TimeFunction halfSine(double duration, double value) {
  requirePositive(duration, "duration of the half sine");
  return [=](double t) { return t >= 0.0 && t <= duration ? value * std::sin(std::numbers::pi * t / duration) : 0.0; };
}

TimeFunction sine(double frequency, double value, double phase) {
  return [=](double t) { return value * std::sin(2.0 * std::numbers::pi * frequency * t + phase); };
}

TimeFunction table(std::vector<std::pair<double, double>> entries) {
  if (entries.empty()) throw InputError("there are no entries", "table", "give at least one pair of time and value");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (!std::isfinite(entries[i].first) || !std::isfinite(entries[i].second))
      throw InputError("entry " + std::to_string(i) + " is not finite", "table", "give numbers");
    if (i > 0 && !(entries[i].first > entries[i - 1].first))
      throw InputError("entry " + std::to_string(i) + ", t = " + formatNumber(entries[i].first) +
                           " s, does not come after t = " + formatNumber(entries[i - 1].first) + " s",
                       "table", "let the times ascend");
  }
  return [entries = std::move(entries)](double t) {
    const auto after = std::upper_bound(entries.begin(), entries.end(), t,
                                        [](double time, const auto& entry) { return time < entry.first; });
    if (after == entries.begin()) return after->second;
    const auto before = after - 1;
    if (after == entries.end()) return before->second;
    const double fraction = (t - before->first) / (after->first - before->first);
    return before->second + fraction * (after->second - before->second);
  };
}

Amplitude::Amplitude(TimeFunction function) : function_(std::move(function)) {
  if (!function_) throw InputError("there is no function", "Amplitude", "give one, or a number");
}

}  // namespace dovetail::fem
