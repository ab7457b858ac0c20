// A measure of error along one parameter: where it is least, and how flat it is there.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

namespace dovetail {

struct MeasureCurve {
  std::vector<double> at, measure;  ///< of the samples, ascending
  double best = 0.0;                ///< sample of the parameter with the least measure
  /// ∂²m/∂p² over m, times p²: a relative change ε of p raises m by the fraction ½ × curvature × ε². 0 where the least
  /// lies at an end.
  double curvature = 0.0;
  double lower = 0.0, upper = 0.0;            ///< between which the measure is within 5 % of the least
  bool lowerOpen = false, upperOpen = false;  ///< whether that goes on beyond the bound
};

/// @param samples  measures ≥ 0 by parameter; without any, all of the curve is empty or zero
/// @param least, most  bounds between which was sampled, in the unit of the parameter
MeasureCurve curveThrough(const std::map<double, double>& samples, double least, double most);

/// A table with a row for each parameter: its best value, the range within 5 % of the least measure, the curvature.
/// @param names  one per curve, with their units
std::string optimaText(std::span<const std::string> names, std::span<const MeasureCurve> curves);

}  // namespace dovetail
