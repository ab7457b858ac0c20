#include "figure.hpp"

namespace dovetail::benchmark {

FigureRow rowOf(const std::string& what, const std::vector<double>& values, double printed, double allowed,
                const std::string& note) {
  const double n = static_cast<double>(values.size());
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / n;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const double scatter = n > 1.0 ? std::sqrt(squares / (n - 1.0)) : 0.0;
  return {what, mean, scatter, printed, allowed, note, false, values.size()};
}

}  // namespace dovetail::benchmark
