#include "dovetail/mpm/shapes.hpp"

#include <cmath>

namespace dovetail::mpm {

namespace {

// Of the nodes that s0 reaches.
LineWeights linearAt(double s, double s0) {
  const double first = std::floor(s0), t = s - first;
  return {static_cast<int>(first), {1.0 - t, t}, {-1.0, 1.0}};
}

/// A hat averaged over a box of 2 half, at the distance d from its node.
std::array<double, 2> averagedHat(double d, double half) {
  const double far = std::abs(d), sign = d < 0.0 ? -1.0 : 1.0;
  if (far <= half) return {1.0 - (d * d + half * half) / (2.0 * half), -d / half};
  if (far <= 1.0 - half) return {1.0 - far, -sign};
  if (far >= 1.0 + half) return {0.0, 0.0};
  const double rest = 1.0 + half - far;
  return {rest * rest / (4.0 * half), -sign * rest / (2.0 * half)};
}

LineWeights gimpAt(double s, double half) {
  LineWeights weights{static_cast<int>(std::ceil(s - 1.0 - half)), {}, {}};
  for (int k = 0; k < 3; ++k) {
    const auto [value, slope] = averagedHat(s - (weights.first + k), half);
    weights.value[static_cast<std::size_t>(k)] = value;
    weights.slope[static_cast<std::size_t>(k)] = slope;
  }
  return weights;
}

LineWeights quadraticAt(double s, double s0) {
  const double nearest = std::floor(s0 + 0.5), t = s - nearest;
  return {static_cast<int>(nearest) - 1,
          {0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)},
          {t - 0.5, -2.0 * t, t + 0.5}};
}

LineWeights cubicAt(double s, double s0) {
  const double below = std::floor(s0), t = s - below, r = 1.0 - t;
  return {static_cast<int>(below) - 1,
          {r * r * r / 6.0, 2.0 / 3.0 - t * t + 0.5 * t * t * t, 2.0 / 3.0 - r * r + 0.5 * r * r * r, t * t * t / 6.0},
          {-0.5 * r * r, -2.0 * t + 1.5 * t * t, 2.0 * r - 1.5 * r * r, 0.5 * t * t}};
}

}  // namespace

const char* name(Shape shape) {
  switch (shape) {
    case Shape::linear:
      return "linear";
    case Shape::gimp:
      return "gimp";
    case Shape::quadratic:
      return "quadratic";
    case Shape::cubic:
      return "cubic";
  }
  return "";
}

int reachOf(Shape shape) {
  switch (shape) {
    case Shape::linear:
      return 2;
    case Shape::gimp:
    case Shape::quadratic:
      return 3;
    case Shape::cubic:
      return 4;
  }
  return 0;
}

LineWeights weightsAt(Shape shape, double s, double half) { return weightsBeside(shape, s, s, half); }

LineWeights weightsBeside(Shape shape, double s, double s0, double half) {
  switch (shape) {
    case Shape::linear:
      return linearAt(s, s0);
    case Shape::gimp: {
      LineWeights weights = gimpAt(s0, half);
      for (std::size_t k = 0; k < 3; ++k) weights.value[k] += weights.slope[k] * (s - s0);
      return weights;
    }
    case Shape::quadratic:
      return quadraticAt(s, s0);
    case Shape::cubic:
      return cubicAt(s, s0);
  }
  return {};
}

double secondMoment(Shape shape) { return shape == Shape::quadratic ? 0.25 : shape == Shape::cubic ? 1.0 / 3.0 : 0.0; }

}  // namespace dovetail::mpm
