// Random numbers that are the same on every machine.
#pragma once

#include <random>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::cg::testing {

class RandomState {
public:
  explicit RandomState(unsigned seed) : engine_(seed) {}
  double number(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_()) / 4294967295.0;
  }
  Vec3 vector(double lower, double upper) {
    const double x = number(lower, upper), y = number(lower, upper), z = number(lower, upper);
    return {x, y, z};
  }
  std::vector<Vec3> vectors(int n, double lower, double upper) {
    std::vector<Vec3> result;
    for (int i = 0; i < n; ++i) result.push_back(vector(lower, upper));
    return result;
  }

private:
  std::mt19937 engine_;
};

/// ∫ f from a to b by n pieces of three Gauss points.
template <class Function>
double integrate(double a, double b, int n, Function&& f) {
  const double offset = 0.5 * std::sqrt(0.6), h = (b - a) / n;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double middle = a + (i + 0.5) * h;
    sum += h / 18.0 * (5.0 * f(middle - offset * h) + 8.0 * f(middle) + 5.0 * f(middle + offset * h));
  }
  return sum;
}

}  // namespace dovetail::cg::testing
