// Simple shear of framed packings at constant volume: how the stress depends on the condition and on the size.
#include <array>
#include <string>

#include "dovetail/core/parallel.hpp"
#include "figure.hpp"
#include "liu_packings.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double stiffness = 1e4;  // N/m (Liu, thesis TU Eindhoven 2018, Table 2.4)

constexpr int steps = 100;
constexpr std::array<std::pair<const char*, rve::Condition>, 3> conditions{
    {{"D", rve::Condition::displacement}, {"P", rve::Condition::periodic}, {"T", rve::Condition::traction}}};

/// Of one packing, by conditions.
struct Answer {
  std::array<double, 3> norm{};     ///< (∫ σ̃ : σ̃ dF₁₂)^½ to F₁₂ = 0.5, σ̃ = σ/k_n
  std::array<int, 3> restless{};    ///< steps that did not come to rest
  double discs = 0.0, solid = 0.0;  ///< number with the border, and solid fraction
};

void shear(const rve::Rve& packing, std::size_t condition, Answer& answer) {
  rve::Rve cell = rve::framed(packing, rve::everywhere(conditions[condition].second));
  answer.discs = static_cast<double>(cell.size());
  double squares = 0.0;
  for (int k = 1; k <= steps; ++k) {
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 1) = 0.5 * k / steps;
    const rve::PathReport report =
        rve::followPath(cell, F, {.inertialNumber = 3e-3, .rest = {.tolerance = 1e-2, .steps = 3000}});
    answer.restless[condition] += report.rest.atRest ? 0 : 1;
    squares += (cauchyOf(cell) / stiffness).squaredNorm() * 0.5 / steps;
  }
  answer.norm[condition] = std::sqrt(squares);
}

/// Printed: 0.833 of the smallest, 37 discs, 0.850 of the largest, 650; between them in proportion to n^-½.
double printedFraction(int count) {
  const double x = 1.0 / std::sqrt(count), small = 1.0 / std::sqrt(25.0), large = 1.0 / std::sqrt(600.0);
  return 0.850 + (x - large) / (small - large) * (0.833 - 0.850);
}

std::vector<Answer> sheared(int count, std::size_t packings) {
  std::vector<Answer> answers(packings);
  parallelTasks(packings, [&](std::size_t k) {
    const rve::Springs springs{.stiffness = stiffness, .tangential = 0.2, .friction = 0.4};
    const rve::Rve packing =
        densePacking({count, 0.67e-3, 1.34e-3, 2e3, springs, printedFraction(count)}, 1 + 1000 * k);
    answers[k].solid = rve::solidFraction(packing);
    for (std::size_t c = 0; c < 3; ++c) shear(packing, c, answers[k]);
  });
  return answers;
}

/// One row for each condition.
FigureRows rowsOf(int count, const std::vector<Answer>& answers) {
  FigureRows rows;
  double discs = 0.0, solid = 0.0;
  for (const Answer& answer : answers) {
    discs += answer.discs / static_cast<double>(answers.size());
    solid += answer.solid / static_cast<double>(answers.size());
  }
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> norms;
    int restless = 0;
    for (const Answer& answer : answers) {
      norms.push_back(answer.norm[c]);
      restless += answer.restless[c];
    }
    const bool judged = count == 200 && c == 1;
    rows.push_back(
        rowOf(std::string("‖σ/k_n‖, ") + conditions[c].first + ", " + std::to_string(std::lround(discs)) + " discs",
              norms, judged ? 0.011 : std::nan(""), judged ? 0.0011 : 0.0,
              std::to_string(restless) + " of " + std::to_string(steps * static_cast<int>(answers.size())) +
                  " steps not at rest to 1e-2; solid fraction " + std::to_string(solid).substr(0, 5)));
  }
  return rows;
}

}  // namespace

FigureRows simpleShear(bool quick) {
  const std::vector<int> counts = quick ? std::vector{25, 200, 600} : std::vector{25, 100, 200, 400, 600};
  FigureRows rows;
  for (const int count : counts)
    for (const FigureRow& row : rowsOf(count, sheared(count, quick ? 2 : 5))) rows.push_back(row);
  const auto changes = [&](std::size_t c) { return rows[3 * (counts.size() - 1) + c].here - rows[c].here; };
  const double falls = changes(0) < 0.0 ? 1.0 : 0.0, rises = changes(2) > 0.0 ? 1.0 : 0.0;
  rows.push_back({"D falls with size (1: yes)", falls, 0.0, 1.0, 0.0});
  rows.push_back({"T rises with size (1: yes)", rises, 0.0, 1.0, 0.0});
  return rows;
}

}  // namespace dovetail::benchmark
