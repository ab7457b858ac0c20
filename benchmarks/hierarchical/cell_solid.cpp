// Biaxial compression of solids whose points own cells of 400 discs: one element against the cell alone, and how many
// iterations and seconds of the processor the operators take for 2 × 4 quad8 with 2 × 2 points. Desrues et al. 2019,
// Table 1, print twice as many iterations with the operator of uniform strain as with that of the network.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/operators.hpp"
#include "dovetail/rve/packing.hpp"

using namespace dovetail;

namespace {

constexpr double pressure = 1e5;  // Pa
constexpr double strainOfStep = 1e-3;

rve::Cell sand(std::uint64_t seed) {
  rve::Cell cell =
      rve::randomCell({.count = 400, .seed = seed}, {.modulus = 6e8, .tangential = 0.8, .friction = std::tan(0.5)});
  rve::compress(cell, {.pressure = {pressure, pressure, 0.0}, .friction = 0.0, .rest = {.unbalanced = 1e-6}});
  return cell;
}

/// 1 m × 2 m, shortened along y between smooth plates by strainOfStep in a second; the side stays straight if asked.
struct Body {
  fem::SolidMesh mesh;
  fem::Model model;
  std::shared_ptr<fem::Solid> solid;

  Body(fem::CellShape shape, std::array<int, 2> elements, fem::Formulation formulation, bool straight,
       const std::vector<rve::Cell>& bank, const hierarchical::RestingCells& settings)
      : mesh(fem::boxOf(shape, {elements[0], elements[1], 1}, {}, {1.0, 2.0, 1.0})),
        model(fem::makeModel(mesh)),
        solid(fem::makeSolid(mesh, hierarchical::cellField(bank, settings), {.formulation = formulation})) {
    model.add(solid);
    model.add(fem::followingPressure(mesh, fem::faceSet(mesh, "x+"), pressure));
    model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
    model.constraints.hold(fem::nodeSet(mesh, "y-"), fem::componentY);
    model.constraints.prescribe(fem::nodeSet(mesh, "y+"), 1, [](double t) { return -2.0 * strainOfStep * t; });
    const std::vector<int>& side = fem::nodeSet(mesh, "x+");
    for (std::size_t k = 1; straight && k < side.size(); ++k)
      model.constraints.ties.push_back({side[k], 0, {{side[0], 0, 1.0}}, 0.0, {}});
  }

  /// Mean of −P₂₂ over the points, Pa.
  double axial() {
    const fem::Solid::Sample sample = solid->sample(model.nodes, {model.t, 0.0});
    double sum = 0.0, volume = 0.0;
    for (std::size_t p = 0; p < sample.volume.size(); ++p) {
      sum -= sample.volume[p] * sample.P[9 * p + 4];
      volume += sample.volume[p];
    }
    return sum / volume;
  }
};

/// −P₂₂ of the cell alone at F₂₂ = 1 − strain under the side pressure, Pa: Newton's method for F₁₁.
double axialAlone(rve::Cell& cell, double strain, const hierarchical::RestingCells& settings) {
  Eigen::Matrix3d F = cell.state.F;
  F(1, 1) = 1.0 - strain;
  rve::CellState committed;
  rve::save(cell, committed);
  for (int iteration = 0; iteration < 30; ++iteration) {
    rve::restore(cell, committed);
    hierarchical::settle(cell, F, settings);
    const Eigen::Matrix3d P = rve::nominalStress(cell);
    const double excess = P(0, 0) + pressure * F(1, 1);
    if (std::abs(excess) < 1e-5 * pressure) return -P(1, 1);
    F(0, 0) -= excess / rve::network(cell)(0, 0);
  }
  return std::nan("");
}

fem::StaticOptions options(double reuse) {
  return {.newton = {.relativeTolerance = 1e-4, .lineSearch = false, .reuseContraction = reuse},
          .firstStep = 1.0,
          .largestStep = 1.0,
          .smallestStep = 0.2,
          .iterationTarget = 1000};  // steps are the same for all
}

void compareWithCell(int steps) {
  const hierarchical::RestingCells settings;
  rve::Cell cell = sand(1);
  Body body(fem::CellShape::quad4, {1, 1}, fem::Formulation::standard, true, {cell}, settings);
  std::printf("one quad4 and the cell alone\n%10s %14s %14s\n", "strain %", "quad4 kPa", "cell kPa");
  fem::StaticOptions fine = options(0.0);
  fine.newton.relativeTolerance = 1e-6;
  for (int k = 1; k <= steps; ++k) {
    fem::solveStatics(body.model, k, fine);
    std::printf("%10.2f %14.3f %14.3f\n", 100.0 * strainOfStep * k, 1e-3 * body.axial(),
                1e-3 * axialAlone(cell, strainOfStep * k, settings));
  }
}

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double secondsOf(int times, const std::function<void()>& act) {
  const double start = processorSeconds();
  for (int k = 0; k < times; ++k) act();
  return (processorSeconds() - start) / times;
}

/// What an answer is made of: the state taken back, the path with its rest, the operators.
void pricesOfACell() {
  const rve::Cell start = sand(1);
  rve::Cell cell = start;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(1, 1) -= strainOfStep;
  const auto answer = [&](double first) {
    const hierarchical::RestingCells settings{.path = {.rest = {.unbalanced = first}}, .unbalanced = 1e-6};
    return secondsOf(5, [&] {
      rve::restore(cell, start.state);
      hierarchical::settle(cell, F, settings);
    });
  };
  const double polished = answer(1e-4), relaxed = answer(1e-6);
  const double back = secondsOf(200, [&] { rve::restore(cell, start.state); });
  const double network = secondsOf(5, [&] { rve::network(cell); });
  const double uniform = secondsOf(5, [&] { rve::uniformStrain(cell); });
  std::printf(
      "a cell of 400 discs, ms: answer to 0.1 %% of strain at rest to 1e-6 by Newton's method %.1f, by FIRE alone "
      "%.1f; "
      "state taken back %.4f; network %.1f, uniformStrain %.2f\n\n",
      1e3 * polished, 1e3 * relaxed, 1e3 * back, 1e3 * network, 1e3 * uniform);
}

void study(const char* name, hierarchical::Operator tangent, double reuse, const std::vector<rve::Cell>& bank,
           int steps) {
  Body body(fem::CellShape::quad8, {2, 4}, fem::Formulation::reduced, false, bank, {.tangent = tangent});
  int accepted = 0, iterations = 0, most = 0, cuts = 0;
  const auto count = [&](const fem::Model&, const fem::StaticStep& step) {
    ++accepted;
    iterations += step.iterations;
    most = std::max(most, step.iterations);
    return true;
  };
  const double start = processorSeconds();
  std::string end = "all steps";
  try {
    cuts = fem::solveStatics(body.model, steps, options(reuse), count).cuts;
  } catch (const NumericalError& error) {
    end = error.what();
  }
  const double seconds = processorSeconds() - start;
  std::printf("%-24s %6d %6.1f %6d %6d %9.2f %10.1f %8.1f  %s\n", name, accepted, double(iterations) / accepted, most,
              cuts, 100.0 * strainOfStep * body.model.t, 1e-3 * body.axial(), seconds, end.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 5;
  if (steps < 1) {
    std::fprintf(stderr, "give the number of steps of 0.1 %% of strain, 1 or more\n");
    return 2;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  pricesOfACell();
  compareWithCell(steps);
  std::vector<rve::Cell> bank;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) bank.push_back(sand(seed));
  std::printf(
      "\n2 x 4 quad8 with 2 x 2 points, 32 cells of 400 discs, to 1e-4 of the forces\n%-24s %6s %6s %6s %6s %9s %10s "
      "%8s\n",
      "operator", "steps", "mean", "most", "cuts", "strain %", "axial kPa", "seconds");
  study("network", hierarchical::Operator::network, 0.0, bank, steps);
  study("network, frozen", hierarchical::Operator::network, 0.5, bank, steps);
  study("uniformStrain", hierarchical::Operator::uniformStrain, 0.0, bank, steps);
  study("uniformStrain, frozen", hierarchical::Operator::uniformStrain, 0.9, bank, steps);
}
