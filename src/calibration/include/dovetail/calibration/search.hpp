// Where a measure of error is least, and how flat it is there.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "dovetail/calibration/fit.hpp"

namespace dovetail::calibration {

/// ≥ 0; none where the model could not be evaluated.
using Measure = std::function<std::optional<double>(std::span<const double> parameters)>;

struct SearchSettings {
  int samples = 9;      ///< along each parameter, from least to most
  int refinements = 2;  ///< times that the neighbours of the best sample become the bounds of as many samples
  std::function<bool()> stop{};
};

/// The measure along one parameter, the others at their best.
struct Profile {
  std::vector<double> at, measure;  ///< ascending; what could not be evaluated is left out
  double best = 0.0;                ///< of the parameter
  double curvature =
      0.0;  ///< ∂²m/∂p² over m, times p²: by how many times m a change of p by itself would raise it, twice
  double lower = 0.0, upper = 0.0;            ///< between which the measure is within 5 % of the least
  bool lowerOpen = false, upperOpen = false;  ///< whether that goes on beyond the bound
};

struct Optimum {
  std::vector<double> value;  ///< of the parameters
  double measure = 0.0;
  std::vector<Profile> profiles;  ///< one per parameter
  bool stopped = false;
};

/// Samples each parameter in turn, the others at the best found so far, and goes round again until nothing gets better;
/// no derivative is taken, so a measure may have steps (lengths count in whole elements).
/// @throws InputError for parameters without a range or samples < 3; NumericalError if no sample could be evaluated
Optimum searchOptimum(std::span<const FitParameter> parameters, const Measure& measure,
                      const SearchSettings& settings = {});

}  // namespace dovetail::calibration
