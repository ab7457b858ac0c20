#include "sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dovetail::scene {

namespace {

dem::Sizes made(const SizeRange& s) { return dem::UniformSizes{s.smallest, s.largest}; }
dem::Sizes made(const NormalSizes& s) { return dem::NormalSizes{s.mean, s.deviation, s.smallest, s.largest}; }
dem::Sizes made(const LogNormalSizes& s) {
  return dem::LogNormalSizes{s.median, s.logDeviation, s.smallest, s.largest};
}
dem::Sizes made(const SizeClasses& s) {
  dem::SizeClasses sizes;
  for (const SizeClass& one : s.classes) {
    sizes.radius.push_back(one.radius);
    sizes.number.push_back(one.number);
  }
  return sizes;
}
dem::Sizes made(const SieveCurve& s) {
  dem::GradingCurve curve;
  for (const Sieve& sieve : s.sieves) {
    curve.diameter.push_back(sieve.opening);
    curve.passing.push_back(sieve.passing);
  }
  return curve;
}

double sphereMass(double density, double radius) {
  return density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

Entering ofShapes(const std::vector<dem::ClumpShape>& shapes) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Entering found{infinity, 0.0, infinity, 0.0};
  for (const dem::ClumpShape& shape : shapes) {
    const auto [least, most] = std::ranges::minmax_element(shape.radius);
    found.smallest = std::min(found.smallest, *least);
    found.largest = std::max(found.largest, *most);
    found.lightest = std::min(found.lightest, shape.properties.mass);
    found.meanMass += shape.properties.mass / static_cast<double>(shapes.size());
  }
  return found;
}

}  // namespace

dem::Sizes sizesOf(const Sizes& sizes) {
  return std::visit([](const auto& s) { return made(s); }, sizes.distribution);
}

std::vector<dem::ClumpShape> shapesOf(const Insertion& insertion) {
  std::vector<dem::ClumpShape> shapes;
  for (const ClumpKind& kind : insertion.clumps) {
    std::vector<Vec3> centres;
    std::vector<double> radii;
    for (const Sphere& sphere : kind.spheres) {
      centres.push_back(sphere.at);
      radii.push_back(sphere.radius);
    }
    shapes.push_back(dem::makeClumpShape(centres, radii, {insertion.density}));
  }
  return shapes;
}

Entering enteringOf(const Insertion& insertion) {
  if (!insertion.radius) return ofShapes(shapesOf(insertion));
  const dem::Sizes sizes = sizesOf(*insertion.radius);
  const auto [smallest, largest] = dem::boundsOf(sizes);
  return {smallest, largest, sphereMass(insertion.density, smallest), insertion.density * dem::meanVolume(sizes)};
}

double totalOf(const Insertion& insertion) {
  double total = std::numeric_limits<double>::infinity();
  if (insertion.totalNumber > 0) total = static_cast<double>(insertion.totalNumber);
  if (insertion.totalMass) total = std::min(total, *insertion.totalMass / enteringOf(insertion).meanMass);
  return total;
}

double expectedIn(const Insertion& insertion, double time) {
  const double lasts = std::max(0.0, std::min(time, insertion.until.value_or(time)) - insertion.from);
  const double rate =
      insertion.numberPerSecond.value_or(insertion.massPerSecond.value_or(0.0) / enteringOf(insertion).meanMass);
  return std::min(lasts * rate, totalOf(insertion));
}

}  // namespace dovetail::scene
