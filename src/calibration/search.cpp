#include "dovetail/calibration/search.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::calibration {

namespace {

constexpr int rounds = 4;

/// Samples of a measure along one parameter.
using Line = std::map<double, double>;

class LineSearch {
public:
  LineSearch(std::span<const FitParameter> parameters, const Measure& measure, const SearchOptions& settings)
      : parameters_(parameters), measure_(measure), settings_(settings) {
    for (const FitParameter& p : parameters) found_.value.push_back(p.start);
  }

  Optimum run() {
    bool better = true;
    for (int round = 0; round < rounds && better && !stopped(); ++round) {
      better = false;
      for (std::size_t k = 0; k < parameters_.size() && !stopped(); ++k) better = improve(k) || better;
      if (parameters_.size() == 1) break;
    }
    for (std::size_t k = 0; k < parameters_.size() && !stopped(); ++k)
      found_.profiles.push_back(curveThrough(sampled(k), parameters_[k].least, parameters_[k].most));
    found_.measure = best_.value_or(0.0);
    found_.stopped = stopped();
    if (!best_ && !found_.stopped)
      throw NumericalError("the measure could not be evaluated anywhere", "search",
                           "narrow the bounds to where the experiments can be done");
    return found_;
  }

private:
  bool stopped() const { return settings_.stop && settings_.stop(); }

  /// Moves one parameter to its best sample. Returns whether that is another one than before.
  bool improve(std::size_t k) {
    const Line line = sampled(k);
    if (line.empty()) return false;
    const auto least =
        std::min_element(line.begin(), line.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (best_ && !(least->second < *best_)) return false;
    best_ = least->second;
    const bool moved = found_.value[k] != least->first;
    found_.value[k] = least->first;
    return moved;
  }

  /// From bound to bound, then between the neighbours of the best sample.
  Line sampled(std::size_t k) {
    Line line;
    double low = parameters_[k].least, high = parameters_[k].most;
    for (int pass = 0; pass <= settings_.refinements && !stopped(); ++pass) {
      for (int s = 0; s < settings_.samples && !stopped(); ++s)
        sample(k, s + 1 == settings_.samples ? high : low + (high - low) * s / (settings_.samples - 1), line);
      if (pass == 0) sample(k, found_.value[k], line);
      if (line.empty()) break;
      const auto least =
          std::min_element(line.begin(), line.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
      low = least == line.begin() ? least->first : std::prev(least)->first;
      high = std::next(least) == line.end() ? least->first : std::next(least)->first;
    }
    return line;
  }

  void sample(std::size_t k, double at, Line& line) {
    if (line.contains(at)) return;
    std::vector<double> values = found_.value;
    values[k] = at;
    if (const auto value = measure_(values)) line[at] = *value;
  }

  std::span<const FitParameter> parameters_;
  const Measure& measure_;
  const SearchOptions& settings_;
  Optimum found_;
  std::optional<double> best_;
};

}  // namespace

Optimum searchOptimum(std::span<const FitParameter> parameters, const Measure& measure, const SearchOptions& settings) {
  if (settings.samples < 3)
    throw InputError(std::to_string(settings.samples) + " samples", "search", "give 3 at least");
  if (parameters.empty()) throw InputError("there are no parameters", "search", "give one at least");
  for (const FitParameter& p : parameters)
    if (!(p.least < p.most && p.least <= p.start && p.start <= p.most))
      throw InputError("the start " + formatNumber(p.start) + " does not lie between bounds in order", p.name,
                       "give least < most, and a start between them");
  return LineSearch(parameters, measure, settings).run();
}

}  // namespace dovetail::calibration
