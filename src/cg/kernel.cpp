#include "dovetail/cg/kernel.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "segment_mean.hpp"

namespace dovetail::cg {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double sigma = 1.0 / 3.0;  ///< of the Gaussian, over its width (Eq. 9)

/// ∫ exp(−q²/(2σ²)) over the unit ball, as a fraction of the whole space.
std::array<double, 3> gaussFractions() {
  const double line = std::erf(3.0 / std::numbers::sqrt2);
  return {line, -std::expm1(-4.5), line - 3.0 * std::sqrt(2.0 / pi) * std::exp(-4.5)};
}

const std::array<double, 3>& gaussFractionsTable() {
  static const std::array<double, 3> fractions = gaussFractions();
  return fractions;
}

const std::array<double, 3>& gaussPeakTable() {
  static const std::array<double, 3> peaks = [] {
    std::array<double, 3> result{};
    for (int d = 1; d <= 3; ++d)
      result[d - 1] = 1.0 / (std::pow(2.0 * pi * sigma * sigma, 0.5 * d) * gaussFractionsTable()[d - 1]);
    return result;
  }();
  return peaks;
}

void requireDimension(int dimension) {
  if (dimension < 1 || dimension > 3)
    throw InputError("the kernel's dimension is " + std::to_string(dimension), "kernel dimension", "give 1, 2 or 3");
}

/// ∫ profile(√(p² + s²)) ds from 0 to s, lengths over the width; √(p² + s²) ≤ 1.
double lineIntegral(KernelShape shape, double p, double s) {
  if (shape == KernelShape::gauss)
    return std::exp(-4.5 * p * p) * sigma * std::sqrt(0.5 * pi) * std::erf(s / (sigma * std::numbers::sqrt2));
  const double p2 = p * p, s2 = s * s, r = std::sqrt(p2 + s2);
  const double fourth = s * (p2 * p2 + s2 * (2.0 / 3.0 * p2 + 0.2 * s2));
  // p⁴ asinh(s/p) vanishes with p, and is below round-off here.
  const double logarithm = p > 1e-6 ? p2 * p2 * std::asinh(s / p) : 0.0;
  const double third = 0.25 * s * r * r * r + 0.375 * (p2 * s * r + logarithm);
  return -3.0 * fourth + 8.0 * third - 6.0 * s * (p2 + s2 / 3.0) + s;
}

}  // namespace

double peakNumber(KernelShape shape, int dimension) {
  requireDimension(dimension);
  if (shape == KernelShape::gauss) return gaussPeakTable()[dimension - 1];
  constexpr std::array<double, 3> lucy{5.0 / 4.0, 5.0 / pi, 105.0 / (16.0 * pi)};  // Eq. 10
  return lucy[dimension - 1];
}

double gaussTailMass(int dimension) {
  requireDimension(dimension);
  return 1.0 - gaussFractionsTable()[dimension - 1];
}

void requireValid(const Kernel& kernel, bool allowZeroWidth) {
  requireDimension(kernel.dimension);
  if (allowZeroWidth)
    requireNonNegative(kernel.width, "kernel width");
  else
    requirePositive(kernel.width, "kernel width");
}

double Kernel::peak() const {
  requireValid(*this);
  double volume = width;
  for (int d = 1; d < dimension; ++d) volume *= width;
  return peakNumber(shape, dimension) / volume;
}

double Kernel::operator()(double distance) const { return peak() * profile(shape, distance / width); }

double Kernel::derivative(double distance) const { return peak() / width * profileDerivative(shape, distance / width); }

Vec3 Kernel::gradient(const Vec3& offset) const {
  const double distance = norm(offset);
  const double slope = derivative(distance);
  return distance > 0.0 ? (slope / distance) * offset : Vec3{};
}

double Kernel::segmentMean(const Vec3& from, const Vec3& to) const {
  const double height = peak();
  return height * profileMean(shape, width, from, to);
}

double profileMean(KernelShape shape, double width, const Vec3& from, const Vec3& to) {
  const Vec3 branch = (to - from) / width;
  const double length = norm(branch);
  if (length < 1e-4) {
    // The closed form below would lose digits by cancellation; three Gauss points are exact to round-off here.
    const auto at = [&](double s) { return profile(shape, norm(from + s * (to - from)) / width); };
    const double offset = 0.5 * std::sqrt(0.6);
    return (5.0 * at(0.5 - offset) + 8.0 * at(0.5) + 5.0 * at(0.5 + offset)) / 18.0;
  }
  const Vec3 direction = branch / length;
  const double start = dot(from, direction) / width;
  const double p = norm(from / width - start * direction);
  if (!(p < 1.0)) return 0.0;
  const double half = std::sqrt((1.0 - p) * (1.0 + p));
  const double lower = std::max(start, -half), upper = std::min(start + length, half);
  if (!(upper > lower)) return 0.0;
  return (lineIntegral(shape, p, upper) - lineIntegral(shape, p, lower)) / length;
}

}  // namespace dovetail::cg
