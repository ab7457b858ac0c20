#include "dovetail/calibration/fit.hpp"

#include <ceres/ceres.h>
#include <glog/logging.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::calibration {

namespace {

/// Residuals and their derivatives by u, the parameters over their range: 0 at the lower bound, 1 at the upper one.
class Model final : public ceres::CostFunction {
public:
  Model(std::span<const FitParameter> parameters, int residuals, const Residuals& evaluate,
        const std::function<bool()>& stop)
      : parameters_(parameters), evaluate_(evaluate), stop_(stop) {
    set_num_residuals(residuals);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters.size()));
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const std::vector<double> u(blocks[0], blocks[0] + parameters_.size());
    const auto n = static_cast<std::size_t>(num_residuals());
    std::vector<double> here(n);
    if (!at(u, here)) return false;
    std::copy(here.begin(), here.end(), residuals);
    if (!jacobians || !jacobians[0]) return true;
    if (!isNear(u)) {
      std::vector<double> made(n * u.size());
      for (std::size_t k = 0; k < u.size(); ++k)
        if (!differentiate(u, k, here, made.data())) return false;
      derivativesAt_ = u;
      derivatives_ = std::move(made);
    }
    std::copy(derivatives_.begin(), derivatives_.end(), jacobians[0]);
    return true;
  }

  std::vector<double> valuesAt(const std::vector<double>& u) const {
    std::vector<double> values;
    for (std::size_t k = 0; k < u.size(); ++k)
      values.push_back(parameters_[k].least + u[k] * (parameters_[k].most - parameters_[k].least));
    return values;
  }
  /// What an evaluation has thrown: Ceres knows no exceptions.
  std::exception_ptr thrown() const { return thrown_; }

private:
  /// Whether the derivatives that were taken last serve here: differences say nothing about less than their steps.
  bool isNear(const std::vector<double>& u) const {
    for (std::size_t k = 0; k < u.size(); ++k)
      if (derivativesAt_.empty() || std::abs(u[k] - derivativesAt_[k]) > 0.5 * parameters_[k].step) return false;
    return true;
  }
  bool at(const std::vector<double>& u, std::vector<double>& residuals) const {
    if (thrown_ || (stop_ && stop_())) return false;
    try {
      return evaluate_(valuesAt(u), residuals);
    } catch (...) {
      thrown_ = std::current_exception();
      return false;
    }
  }
  bool differentiate(const std::vector<double>& u, std::size_t k, const std::vector<double>& here,
                     double* jacobian) const {
    const std::size_t n = here.size();
    const double step = parameters_[k].step;
    std::vector<double> low = here, high = here, below = u, above = u;
    below[k] = std::max(0.0, u[k] - step);
    above[k] = std::min(1.0, u[k] + step);
    if (below[k] < u[k] && !at(below, low)) low = here, below = u;
    if (above[k] > u[k] && !at(above, high)) high = here, above = u;
    if (!(above[k] > below[k])) return false;
    for (std::size_t r = 0; r < n; ++r) jacobian[r * u.size() + k] = (high[r] - low[r]) / (above[k] - below[k]);
    return true;
  }

  std::span<const FitParameter> parameters_;
  const Residuals& evaluate_;
  const std::function<bool()>& stop_;
  mutable std::exception_ptr thrown_;
  mutable std::vector<double> derivativesAt_, derivatives_;  // by u, row by row
};

void check(std::span<const FitParameter> parameters, int residuals) {
  for (const FitParameter& p : parameters) {
    if (!(p.least < p.most && p.least <= p.start && p.start <= p.most))
      throw InputError("the start " + formatNumber(p.start) + " does not lie between the bounds " +
                           formatNumber(p.least) + " and " + formatNumber(p.most),
                       p.name, "give least < most, and a start between them");
    if (!(p.step > 0.0 && p.step <= 0.25))
      throw InputError("the step of differences is " + formatNumber(p.step), p.name, "give one in (0, 0.25]");
  }
  if (parameters.empty() || residuals < static_cast<int>(parameters.size()))
    throw InputError(std::to_string(residuals) + " targets for " + std::to_string(parameters.size()) + " parameters",
                     "fit", "give as many targets as parameters at least");
}

/// Uncertainties in units of the parameters, and correlation.
void addCovariance(ceres::Problem& problem, const double* u, std::span<const FitParameter> parameters,
                   FitResult& result) {
  const std::size_t n = parameters.size();
  result.uncertainty.assign(n, std::numeric_limits<double>::infinity());
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.min_reciprocal_condition_number = 1e-12;
  ceres::Covariance covariance(options);
  const std::vector<std::pair<const double*, const double*>> blocks{{u, u}};
  if (!covariance.Compute(blocks, &problem)) return;
  std::vector<double> c(n * n);
  covariance.GetCovarianceBlock(u, u, c.data());
  const double worse = std::max(1.0, std::sqrt(result.reducedChiSquared()));
  result.correlation.assign(n, std::vector<double>(n, 0.0));
  for (std::size_t a = 0; a < n; ++a) {
    result.uncertainty[a] = worse * std::sqrt(c[a * n + a]) * (parameters[a].most - parameters[a].least);
    for (std::size_t b = 0; b < n; ++b)
      result.correlation[a][b] = c[a * n + b] / std::sqrt(c[a * n + a] * c[b * n + b]);
  }
}

ceres::Solver::Options optionsOf(const FitOptions& settings) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = settings.iterations;
  options.parameter_tolerance = settings.tolerance;
  options.function_tolerance = settings.tolerance;
  options.gradient_tolerance = 1e-14;
  options.max_num_consecutive_invalid_steps = 10;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  return options;
}

/// Ceres tells of evaluations that fail on the standard error stream; here they are part of the way.
struct QuietLog {
  QuietLog() : before(std::exchange(FLAGS_minloglevel, google::GLOG_FATAL)) {}
  ~QuietLog() { FLAGS_minloglevel = before; }
  QuietLog(const QuietLog&) = delete;
  QuietLog& operator=(const QuietLog&) = delete;
  google::int32 before;
};

}  // namespace

FitResult fit(std::span<const FitParameter> parameters, int residuals, const Residuals& evaluate,
              const FitOptions& settings) {
  check(parameters, residuals);
  const std::size_t n = parameters.size();
  std::vector<double> u;
  for (const FitParameter& p : parameters) u.push_back((p.start - p.least) / (p.most - p.least));
  Model* const model = new Model(parameters, residuals, evaluate, settings.stop);  // the problem's
  ceres::Problem problem;
  problem.AddResidualBlock(model, nullptr, u.data());
  for (int k = 0; k < static_cast<int>(n); ++k) {
    problem.SetParameterLowerBound(u.data(), k, 0.0);
    problem.SetParameterUpperBound(u.data(), k, 1.0);
  }
  const QuietLog quiet;
  ceres::Solver::Summary summary;
  ceres::Solve(optionsOf(settings), &problem, &summary);
  if (model->thrown()) std::rethrow_exception(model->thrown());

  FitResult result;
  result.value = model->valuesAt(u);
  result.stopped = settings.stop && settings.stop();
  if (result.stopped) return result;
  if (summary.termination_type == ceres::FAILURE)
    throw NumericalError("the fit broke down: " + summary.message, "calibration",
                         "begin where the experiments can be done, or narrow the bounds");
  result.residual.resize(static_cast<std::size_t>(residuals));
  problem.Evaluate({}, nullptr, &result.residual, nullptr, nullptr);
  for (const double r : result.residual) result.chiSquared += r * r;
  result.freedom = residuals - static_cast<int>(n);
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  result.message = summary.message;
  for (const double at : u) result.atBound.push_back(at <= 1e-9 || at >= 1.0 - 1e-9);
  addCovariance(problem, u.data(), parameters, result);
  if (model->thrown()) std::rethrow_exception(model->thrown());
  return result;
}

}  // namespace dovetail::calibration
