// Simple shear of framed packings at constant volume: how the stress depends on the condition and on the size.
#include <array>
#include <string>

#include "figure.hpp"
#include "liu_packings.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double stiffness = 1e4;  // N/m (Liu, thesis TU Eindhoven 2018, Table 2.4)

struct Answer {
  double norm = 0.0;  ///< (∫ σ̃ : σ̃ dF₁₂)^½ to F₁₂ = 0.5, σ̃ = σ/k_n
  int restless = 0;   ///< steps that did not come to rest
};

Answer sheared(const rve::Cell& packing, rve::Condition condition) {
  rve::Cell cell = rve::framed(packing, rve::everywhere(condition));
  constexpr int steps = 100;
  Answer answer;
  double squares = 0.0;
  for (int k = 1; k <= steps; ++k) {
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 1) = 0.5 * k / steps;
    const rve::PathReport report =
        rve::followPath(cell, F, {.inertialNumber = 3e-3, .rest = {.unbalanced = 1e-2, .steps = 3000}});
    answer.restless += report.rest.atRest ? 0 : 1;
    squares += (cauchyOf(cell) / stiffness).squaredNorm() * 0.5 / steps;
  }
  answer.norm = std::sqrt(squares);
  return answer;
}

}  // namespace

FigureRows simpleShear(bool quick) {
  const std::vector<int> before = quick ? std::vector{25, 200, 600} : std::vector{25, 100, 200, 400, 600};
  const int packings = quick ? 2 : 5;
  const std::array<std::pair<const char*, rve::Condition>, 3> conditions{
      {{"D", rve::Condition::displacement}, {"P", rve::Condition::periodic}, {"T", rve::Condition::traction}}};
  FigureRows rows;
  std::array<std::vector<double>, 3> means;
  for (const int count : before) {
    std::array<std::vector<double>, 3> norms;
    std::vector<double> fractions, sizes;
    std::array<int, 3> restless{};
    std::uint64_t seed = 1;
    for (int k = 0; k < packings; ++k, ++seed) {
      const rve::Cell packing = densePacking(
          {count, 0.67e-3, 1.34e-3, 2e3, {.stiffness = stiffness, .tangential = 0.2, .friction = 0.4}}, seed);
      fractions.push_back(rve::solidFraction(packing));
      sizes.push_back(static_cast<double>(rve::framed(packing, {}).size()));
      for (std::size_t c = 0; c < 3; ++c) {
        const Answer answer = sheared(packing, conditions[c].second);
        norms[c].push_back(answer.norm);
        restless[c] += answer.restless;
      }
    }
    const std::string discs = std::to_string(static_cast<int>(std::lround(meanOf(sizes).mean))) + " discs";
    for (std::size_t c = 0; c < 3; ++c) {
      const Mean mean = meanOf(norms[c]);
      means[c].push_back(mean.mean);
      const bool judged = count == 200 && c == 1;
      rows.push_back({std::string("‖σ/k_n‖, ") + conditions[c].first + ", " + discs, mean.mean, mean.scatter,
                      judged ? 0.011 : std::nan(""), judged ? 0.0011 : 0.0,
                      std::to_string(restless[c]) + " of " + std::to_string(100 * packings) +
                          " steps not at rest to 1e-2; solid fraction " +
                          std::to_string(meanOf(fractions).mean).substr(0, 5)});
    }
  }
  const auto holds = [](bool yes) { return yes ? 1.0 : 0.0; };
  rows.push_back({"D falls with size (1: yes)", holds(means[0].back() < means[0].front()), 0.0, 1.0, 0.0});
  rows.push_back({"T rises with size (1: yes)", holds(means[2].back() > means[2].front()), 0.0, 1.0, 0.0});
  return rows;
}

}  // namespace dovetail::benchmark
