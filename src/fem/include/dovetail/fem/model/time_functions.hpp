// Functions of time for loads and motions.
#pragma once

#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

namespace dovetail::fem {

/// A number as a function of time, s.
using TimeFunction = std::function<double(double)>;

/// value at all times.
TimeFunction constant(double value);
/// From 0 at t = 0 linearly to value at t = duration, which stays.
/// @throws InputError for duration ≤ 0
TimeFunction ramp(double duration, double value);
/// The same with vanishing first and second derivatives at both ends: value (10 s³ − 15 s⁴ + 6 s⁵), s = t / duration.
/// @throws InputError for duration ≤ 0
TimeFunction smoothRamp(double duration, double value);
/// value sin(π t / duration) for 0 ≤ t ≤ duration, else 0.
/// @throws InputError for duration ≤ 0
TimeFunction halfSine(double duration, double value);
/// value sin(2 π frequency t + phase), frequency in Hz, phase in rad.
TimeFunction sine(double frequency, double value, double phase = 0.0);
/// Linear between (time, value) pairs; the first value before, the last after.
/// @throws InputError if there are none, a number is not finite, or the times do not ascend strictly (the entry is
/// named)
TimeFunction table(std::vector<std::pair<double, double>> entries);

/// How strong a load is over time: a number, which never changes (its load then stores energy), or a function.
class Amplitude {
public:
  Amplitude(double value) : value_(value) {}
  /// @throws InputError for an empty function
  Amplitude(TimeFunction function);
  template <class F>
  requires(std::is_invocable_r_v<double, F, double> && !std::is_convertible_v<F, double>) Amplitude(F function)
      : Amplitude(TimeFunction(std::move(function))) {}

  bool isConstant() const { return !function_; }
  double operator()(double t) const { return function_ ? function_(t) : value_; }

private:
  double value_ = 0.0;
  TimeFunction function_;
};

}  // namespace dovetail::fem
