// Random numbers that are the same with every standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

/// std::mt19937_64, whose output the C++ standard fixes, with distributions of our own: those of the standard library
/// differ from one to the next.
class RandomStream {
public:
  explicit RandomStream(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1): the upper 53 bits over 2⁵³.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in the box; x first, then y, z.
  Vec3 point(const Vec3& lower, const Vec3& upper) {
    const double x = uniform(lower.x, upper.x), y = uniform(lower.y, upper.y);
    return {x, y, uniform(lower.z, upper.z)};
  }
  /// Mean 0, variance 1 (Box & Muller 1958; the second number is thrown away).
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(2.0 * std::numbers::pi * uniform());
  }

private:
  std::mt19937_64 engine_;
};

}  // namespace dovetail::dem
