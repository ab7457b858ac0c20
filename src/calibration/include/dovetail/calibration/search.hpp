// Where a measure of error is least, and how flat it is there.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/calibration/fit.hpp"
#include "dovetail/core/measure_curve.hpp"

namespace dovetail::calibration {

/// ≥ 0; none where the model could not be evaluated.
using Measure = std::function<std::optional<double>(std::span<const double> parameters)>;

struct SearchOptions {
  int samples = 9;      ///< along each parameter, from least to most
  int refinements = 2;  ///< times that the neighbours of the best sample become the bounds of as many samples
  std::function<bool()> stop{};
};

struct Optimum {
  std::vector<double> value;  ///< of the parameters
  double measure = 0.0;
  std::vector<MeasureCurve>
      profiles;  ///< one per parameter, the others at their best; without what could not be evaluated
  bool stopped = false;
};

/// Samples each parameter in turn, the others at the best found so far, and goes round again until nothing gets better;
/// no derivative is taken, so a measure may have steps (lengths count in whole elements).
/// @throws InputError for parameters without a range or samples < 3; NumericalError if no sample could be evaluated
Optimum searchOptimum(std::span<const FitParameter> parameters, const Measure& measure,
                      const SearchOptions& settings = {});

}  // namespace dovetail::calibration
