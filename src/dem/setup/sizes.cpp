#include "dovetail/dem/setup/sizes.hpp"

#include <cmath>
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

/// In a class the mass is even in u = ln d, the number therefore goes with e^(−3u).
double draw(const GradingCurve& s, RandomStream& random) {
  const auto cubes = [&](std::size_t k) { return 1.0 / (s.diameter[k] * s.diameter[k] * s.diameter[k]); };
  const auto number = [&](std::size_t k) {
    return (s.passing[k + 1] - s.passing[k]) * (cubes(k) - cubes(k + 1)) / std::log(s.diameter[k + 1] / s.diameter[k]);
  };
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

}  // namespace

void validate(const Sizes& sizes) {
  std::visit([](const auto& s) { check(s); }, sizes);
}

double drawRadius(const Sizes& sizes, RandomStream& random) {
  return std::visit([&](const auto& s) { return draw(s, random); }, sizes);
}

}  // namespace dovetail::dem
