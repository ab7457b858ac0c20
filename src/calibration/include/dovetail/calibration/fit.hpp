// Bounded least squares where each residual is a simulation (Ceres: Levenberg and Marquardt in a trust region).
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace dovetail::calibration {

/// A parameter sought, in units of its own.
struct FitParameter {
  std::string name;
  double start, least, most;
  double step = 0.02;  ///< of differences, over most − least
};

/// (model − target)/standard deviation of the target, one per target. Returns whether the model could be evaluated.
/// What it throws ends the fit and comes out of it.
using Residuals = std::function<bool(std::span<const double> parameters, std::span<double> residuals)>;

struct FitOptions {
  double tolerance = 1e-3;  ///< ends when the parameters, over most − least, or χ² change by less, relatively
  int iterations = 50;
  std::function<bool()> stop{};  ///< called between evaluations: whether to end here
};

struct FitResult {
  std::vector<double> value;        ///< of the parameters
  std::vector<double> uncertainty;  ///< standard; ∞ if the targets do not determine the parameter
  /// Of estimates, −1 to 1, row by row; empty where there is no covariance.
  std::vector<std::vector<double>> correlation;
  std::vector<double> residual;  ///< at the estimate, in standard deviations
  std::vector<bool> atBound;     ///< whether a parameter lies at one of its bounds
  double chiSquared = 0.0;       ///< Σ residual²
  int freedom = 0;               ///< targets − parameters
  int iterations = 0;
  bool converged = false, stopped = false;
  std::string message;  ///< why it ended

  /// χ² per degree of freedom; about 1 if model and uncertainties are right. 0 without freedom.
  double reducedChiSquared() const { return freedom > 0 ? chiSquared / freedom : 0.0; }
};

/// Derivatives are central differences with the parameters' own steps, one-sided at bounds; they are kept until a
/// parameter has moved by more than half its step. Uncertainties are those of
/// (JᵀJ)⁻¹, times √(χ²/freedom) where that is above 1: if the fit is worse than the targets' uncertainties allow, these
/// are taken to be too small.
/// @throws InputError for parameters without a range, or fewer residuals than parameters; NumericalError if the model
///   cannot be evaluated at the start
FitResult fit(std::span<const FitParameter> parameters, int residuals, const Residuals& evaluate,
              const FitOptions& settings = {});

}  // namespace dovetail::calibration
