#include "dovetail/dem/setup/sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

namespace {

void checkBounds(double smallest, double largest) {
  requirePositive(smallest, "smallest radius");
  requirePositive(largest, "largest radius");
  if (smallest > largest)
    throw InputError("the smallest radius is above the largest", "sizes", "give the bounds in ascending order");
}

/// So that drawing again outside the bounds comes to an end.
void checkReach(double middle, double deviation, double low, double high) {
  if (!(middle + 4.0 * deviation >= low && middle - 4.0 * deviation <= high))
    throw InputError("the distribution has almost no sizes between the bounds", "sizes", "move the mean or the bounds");
}

void check(const UniformSizes& s) { checkBounds(s.smallest, s.largest); }
void check(const NormalSizes& s) {
  checkBounds(s.smallest, s.largest);
  requirePositive(s.mean, "mean radius");
  requireNonNegative(s.deviation, "deviation of the radius");
  checkReach(s.mean, s.deviation, s.smallest, s.largest);
}
void check(const LogNormalSizes& s) {
  checkBounds(s.smallest, s.largest);
  requirePositive(s.median, "median radius");
  requireNonNegative(s.logDeviation, "deviation of the radius' logarithm");
  checkReach(std::log(s.median), s.logDeviation, std::log(s.smallest), std::log(s.largest));
}
void check(const SizeClasses& s) {
  const std::size_t n = s.radius.size();
  if (n == 0 || s.number.size() != n)
    throw InputError("there are " + std::to_string(n) + " radii and " + std::to_string(s.number.size()) + " numbers",
                     "classes of sizes", "give one or more radii with one number each");
  for (std::size_t k = 0; k < n; ++k) {
    requirePositive(s.radius[k], "radius of class " + std::to_string(k));
    requirePositive(s.number[k], "number of class " + std::to_string(k));
  }
}
void check(const GradingCurve& s) {
  const std::size_t n = s.diameter.size();
  if (n < 2 || s.passing.size() != n)
    throw InputError(
        "there are " + std::to_string(n) + " sieves and " + std::to_string(s.passing.size()) + " fractions",
        "grading curve", "give two or more sieves with one fraction each");
  for (std::size_t k = 0; k < n; ++k) {
    requirePositive(s.diameter[k], "sieve " + std::to_string(k));
    if (k > 0 && !(s.diameter[k] > s.diameter[k - 1] && s.passing[k] >= s.passing[k - 1]))
      throw InputError("sieve " + std::to_string(k) + " is out of order", "grading curve", "sort the sieves by size");
  }
  if (!(s.passing.front() == 0.0 && s.passing.back() == 1.0))
    throw InputError(
        "the fractions run from " + formatNumber(s.passing.front()) + " to " + formatNumber(s.passing.back()),
        "grading curve", "let them run from 0 to 1");
}

template <class Value>
double drawWithin(double low, double high, Value&& value) {
  double drawn = value();
  while (!(drawn >= low && drawn <= high)) drawn = value();
  return drawn;
}

double draw(const UniformSizes& s, RandomStream& random) { return random.uniform(s.smallest, s.largest); }
double draw(const NormalSizes& s, RandomStream& random) {
  return drawWithin(s.smallest, s.largest, [&] { return s.mean + s.deviation * random.normal(); });
}
double draw(const LogNormalSizes& s, RandomStream& random) {
  return drawWithin(s.smallest, s.largest, [&] { return s.median * std::exp(s.logDeviation * random.normal()); });
}

double draw(const SizeClasses& s, RandomStream& random) {
  double left = random.uniform() * std::accumulate(s.number.begin(), s.number.end(), 0.0);
  std::size_t k = 0;
  while (k + 1 < s.number.size() && left >= s.number[k]) left -= s.number[k++];
  return s.radius[k];
}

/// Number of particles between two sieves, up to a factor of all: 1/m³.
double numberIn(const GradingCurve& s, std::size_t k) {
  const auto cube = [&](std::size_t n) { return 1.0 / (s.diameter[n] * s.diameter[n] * s.diameter[n]); };
  return (s.passing[k + 1] - s.passing[k]) * (cube(k) - cube(k + 1)) / std::log(s.diameter[k + 1] / s.diameter[k]);
}

/// In a class the mass is even in u = ln d, the number therefore goes with e^(−3u).
double draw(const GradingCurve& s, RandomStream& random) {
  const auto cubes = [&](std::size_t k) { return 1.0 / (s.diameter[k] * s.diameter[k] * s.diameter[k]); };
  const auto number = [&](std::size_t k) { return numberIn(s, k); };
  const std::size_t classes = s.diameter.size() - 1;
  double total = 0.0;
  for (std::size_t k = 0; k < classes; ++k) total += number(k);
  double left = total * random.uniform();
  std::size_t k = 0;
  while (k + 1 < classes && left >= number(k)) left -= number(k++);
  while (k > 0 && number(k) == 0.0) --k;  // round-off at the upper end
  const double cube = cubes(k) - random.uniform() * (cubes(k) - cubes(k + 1));
  return 0.5 / std::cbrt(cube);
}

double volumeOf(double radius) { return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius; }

/// Mean volume of radii(x) with x normal by number between two bounds, in deviations from the mean.
template <class Radii>
double meanOfNormal(double low, double high, const Radii& radii) {
  constexpr int parts = 2000;
  constexpr double far = 9.0;  // of which is less than rounding
  const double from = std::clamp(low, -far, far), to = std::clamp(high, -far, far), step = (to - from) / parts;
  if (!(step > 0.0)) return volumeOf(radii(from));
  double volume = 0.0, number = 0.0;
  for (int k = 0; k <= parts; ++k) {
    const double x = from + k * step,
                 weight = (k == 0 || k == parts ? 1.0 : 2.0 + 2.0 * (k % 2)) * std::exp(-0.5 * x * x);
    volume += weight * volumeOf(radii(x));
    number += weight;
  }
  return volume / number;
}

double mean(const UniformSizes& s) {
  return std::numbers::pi / 3.0 * (s.smallest + s.largest) * (s.smallest * s.smallest + s.largest * s.largest);
}
double mean(const NormalSizes& s) {
  if (s.deviation == 0.0) return volumeOf(s.mean);
  return meanOfNormal((s.smallest - s.mean) / s.deviation, (s.largest - s.mean) / s.deviation,
                      [&](double x) { return s.mean + x * s.deviation; });
}
double mean(const LogNormalSizes& s) {
  if (s.logDeviation == 0.0) return volumeOf(s.median);
  return meanOfNormal(std::log(s.smallest / s.median) / s.logDeviation, std::log(s.largest / s.median) / s.logDeviation,
                      [&](double x) { return s.median * std::exp(x * s.logDeviation); });
}
double mean(const SizeClasses& s) {
  double volume = 0.0;
  for (std::size_t k = 0; k < s.radius.size(); ++k) volume += s.number[k] * volumeOf(s.radius[k]);
  return volume / std::accumulate(s.number.begin(), s.number.end(), 0.0);
}
/// Of the volume 1 a class has (2/π) numberIn particles.
double mean(const GradingCurve& s) {
  double number = 0.0;
  for (std::size_t k = 0; k + 1 < s.diameter.size(); ++k) number += numberIn(s, k);
  return 0.5 * std::numbers::pi / number;
}

UniformSizes bounds(const SizeClasses& s) {
  const auto [least, most] = std::minmax_element(s.radius.begin(), s.radius.end());
  return {*least, *most};
}
UniformSizes bounds(const GradingCurve& s) { return {0.5 * s.diameter.front(), 0.5 * s.diameter.back()}; }
template <class Bounded>
UniformSizes bounds(const Bounded& s) {
  return {s.smallest, s.largest};
}

}  // namespace

void validate(const Sizes& sizes) {
  std::visit([](const auto& s) { check(s); }, sizes);
}

double drawRadius(const Sizes& sizes, RandomStream& random) {
  return std::visit([&](const auto& s) { return draw(s, random); }, sizes);
}

UniformSizes boundsOf(const Sizes& sizes) {
  return std::visit([](const auto& s) { return bounds(s); }, sizes);
}

double meanVolume(const Sizes& sizes) {
  return std::visit([](const auto& s) { return mean(s); }, sizes);
}

}  // namespace dovetail::dem
