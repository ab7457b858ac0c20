// Operators of cells in Newton's method: iterations, answers of cells and seconds of the processor for 32 or 128 quad8
// with 2 × 2 points, before the peak. Also one element against the cell alone, and what an answer costs.
#include "dovetail/rve/operators.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "biaxial_solid.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

using hierarchical::Operator;
using hierarchical::QuasiStaticCells;

constexpr double strainOfStep = 1e-3;

double sinks(double t) { return 2.0 * strainOfStep * t; }

fem::StaticOptions options(double reuse, int mixing) {
  return {.newton = {.relativeTolerance = 1e-4, .lineSearch = false, .reuseContraction = reuse, .mixing = mixing},
          .firstStep = 1.0,
          .largestStep = 1.0,
          .smallestStep = 0.2,
          .iterationTarget = 1000};  // steps are the same for all
}

/// −P₂₂ of the cell alone at F₂₂ = 1 − strain under the side pressure, Pa: Newton's method for F₁₁.
double axialAlone(rve::Rve& cell, double strain, const QuasiStaticCells& settings) {
  constexpr double pressure = 1e5;
  Eigen::Matrix3d F = cell.state.F;
  F(1, 1) = 1.0 - strain;
  rve::CellState committed;
  rve::save(cell, committed);
  for (int iteration = 0; iteration < 30; ++iteration) {
    rve::restore(cell, committed);
    hierarchical::relax(cell, F, settings);
    const Eigen::Matrix3d P = rve::nominalStress(cell);
    const double excess = P(0, 0) + pressure * F(1, 1);
    if (std::abs(excess) < 1e-5 * pressure) return -P(1, 1);
    F(0, 0) -= excess / rve::elasticTangent(cell)(0, 0);
  }
  return std::nan("");
}

FigureRow oneElementAgainstTheCell() {
  const QuasiStaticCells settings;
  rve::Rve cell = sand(1);
  BiaxialSolid body({.straight = true}, hierarchical::cellField({cell}, settings), sinks);
  fem::StaticOptions fine = options(0.0, 0);
  fine.newton.relativeTolerance = 1e-6;
  double worst = 0.0;
  for (int k = 1; k <= 3; ++k) {
    fem::solveStatics(body.model, k, fine);
    worst = std::max(worst, std::abs(body.axial() - axialAlone(cell, strainOfStep * k, settings)));
  }
  return {"one quad4 less the cell alone to 0.3 %, largest, Pa", worst, 0.0, 0.0, 1.0, "of 170 kPa"};
}

double secondsOf(int times, const std::function<void()>& act) {
  const double start = processorSeconds();
  for (int k = 0; k < times; ++k) act();
  return (processorSeconds() - start) / times;
}

/// What an answer is made of: the state taken back, the path with its rest, the operators.
void addCosts(FigureRows& rows) {
  const rve::Rve start = sand(1);
  rve::Rve cell = start;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(1, 1) -= strainOfStep;
  const auto answer = [&](double first) {
    const QuasiStaticCells settings{.path = {.rest = {.tolerance = first}}, .unbalanced = 1e-6};
    return secondsOf(5, [&] {
      rve::restore(cell, start.state);
      hierarchical::relax(cell, F, settings);
    });
  };
  const auto add = [&](const std::string& what, double seconds) {
    rows.push_back({what + ", ms", 1e3 * seconds, 0.0, std::nan("")});
  };
  add("answer to 0.1 % of strain, rest by FIRE", answer(1e-6));
  add("the same, rest ended by Newton's method", answer(1e-4));
  add("state taken back", secondsOf(200, [&] { rve::restore(cell, start.state); }));
  add("elastic tangent of a cell", secondsOf(5, [&] { rve::elasticTangent(cell); }));
  add("voigtTangent of a cell", secondsOf(5, [&] { rve::voigtTangent(cell); }));
}

struct Way {
  std::string name;
  Operator tangent;
  double reuse;
  int mixing = 0;
  int paths = 0;  ///< of cells, for a tangent
};

struct Size {
  std::array<int, 2> elements;
  int steps;
};

/// Iterations of a step, mean.
double study(const Way& way, const std::vector<rve::Rve>& samples, const Size& size, FigureRows& rows) {
  BiaxialSolid body(
      {.elements = size.elements, .shape = fem::ElementShape::quad8, .formulation = fem::Formulation::reduced},
      hierarchical::cellField(samples, QuasiStaticCells{.tangent = way.tangent}), sinks);
  int most = 0;
  const auto look = [&](const fem::Model&, const fem::StaticStep& step) {
    most = std::max(most, step.iterations);
    return true;
  };
  const double start = processorSeconds();
  const fem::StaticReport report = fem::solveStatics(body.model, size.steps, options(way.reuse, way.mixing), look);
  const double seconds = processorSeconds() - start, accepted = static_cast<double>(report.steps.size());
  const double mean = static_cast<double>(report.iterations) / accepted;
  const int cells = 4 * size.elements[0] * size.elements[1];
  char note[200];
  std::snprintf(note, sizeof note, "most %d, cuts %d, %d paths of cells, %lld factorisations, %.1f s, %.1f kPa", most,
                report.cuts,
                static_cast<int>(cells * (report.iterations + size.steps + way.paths * report.factorisations)),
                static_cast<long long>(report.factorisations), seconds, 1e-3 * body.axial());
  rows.push_back({"iterations a step, " + way.name, mean, 0.0, std::nan(""), 0.0, note});
  return mean;
}

/// Nodes that move to rest, damped by their lowest frequency and stepped by their highest one, as Liu 2018, sec. 3.2.4,
/// does with the lowest for both.
void addRelaxation(const std::vector<rve::Rve>& samples, FigureRows& rows) {
  const auto evaluations = [&](bool moves) {
    BiaxialSolid body({.elements = {1, 2}, .shape = fem::ElementShape::quad8, .formulation = fem::Formulation::reduced},
                      hierarchical::cellField(samples, QuasiStaticCells{}), sinks);
    fem::addMass(body.model);
    fem::StaticOptions way = options(0.0, 0);
    if (moves) {
      way.newton.maxIterations = 1;
      way.smallestStep = 1.0;
      way.motionIterations = 4000;
    }
    constexpr int steps = 2;
    const fem::StaticReport report = fem::solveStatics(body.model, steps, way);
    return static_cast<double>(report.iterations + report.motionIterations) / steps;
  };
  const double newton = evaluations(false), motion = evaluations(true);
  rows.push_back({"evaluations of a step, dynamic relaxation over Newton's method, 1 × 2 quad8", motion / newton, 0.0,
                  std::nan("")});
}

}  // namespace

FigureRows operators(bool quick) {
  FigureRows rows;
  addCosts(rows);
  rows.push_back(oneElementAgainstTheCell());
  std::vector<rve::Rve> samples;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) samples.push_back(sand(seed));
  addRelaxation(samples, rows);
  const Size size = quick ? Size{{4, 8}, 4} : Size{{8, 16}, 10};
  const auto iterations = [&](const Way& way) { return study(way, samples, size, rows); };
  const double elastic = iterations({"elastic tangent", Operator::elasticTangent, 0.0});
  iterations({"elastic tangent, frozen", Operator::elasticTangent, 0.5});
  iterations({"elastic tangent, frozen and mixed", Operator::elasticTangent, 0.5, 5});
  iterations({"frictionalTangent", Operator::frictionalTangent, 0.0});
  const double uniform = iterations({"voigtTangent", Operator::voigtTangent, 0.0});
  const double frozen = iterations({"voigtTangent, frozen", Operator::voigtTangent, 0.9});
  const double mixed = iterations({"voigtTangent, frozen and mixed", Operator::voigtTangent, 0.9, 5});
  iterations({"numericalTangent", Operator::numericalTangent, 0.0, 0, 5});
  rows.push_back({"iterations, Voigt over elastic tangent", uniform / elastic, 0.0, 2.0, 0.6, "1.4 or more is wanted"});
  rows.push_back({"iterations saved by mixing, %", 100.0 * (1.0 - mixed / frozen), 0.0, std::nan(""), 0.0});
  return rows;
}

}  // namespace dovetail::benchmark
