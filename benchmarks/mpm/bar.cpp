// Axial vibration of a bar of points in its first mode.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "cases.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double length = 1.0, youngs = 1e6, poisson = 0.3, strain = 1e-4;
constexpr double modulus = youngs * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));  // sides are held
constexpr double periods = 5.5;

enum class Ends { held, free };

struct Setting {
  int cells = 32;
  Ends ends = Ends::held;
  mpm::Shape shape = mpm::Shape::quadratic;
  mpm::Transfer transfer = mpm::Transfer::flip;
  double renewal = 0.25;
};

struct Answer {
  double period = 0.0, lost = 0.0, residual = 0.0;  ///< over the exact one; over the energy at the start
  std::int64_t renewals = 0;
};

/// Half a wave along x between ends that symmetry holds, or that are free in the midst of cells.
double modeAt(Ends ends, double x) {
  const double k = std::numbers::pi / length;
  return ends == Ends::held ? std::sin(k * x) : std::cos(k * x);
}

/// Distance of the means of two upward passages of a sampled signal through 0 over the number of periods between.
double periodOf(const std::vector<double>& t, const std::vector<double>& q) {
  std::vector<double> passed;
  for (std::size_t k = 1; k < q.size(); ++k)
    if (q[k - 1] < 0.0 && q[k] >= 0.0) passed.push_back(t[k - 1] + (t[k] - t[k - 1]) * q[k - 1] / (q[k - 1] - q[k]));
  return (passed.back() - passed.front()) / (static_cast<double>(passed.size()) - 1.0);
}

Answer vibrate(const Setting& set) {
  const double h = length / set.cells, speed = std::sqrt(modulus / density), exact = 2.0 * length / speed;
  const double shift = set.ends == Ends::free ? 0.5 * h : 0.0;
  mpm::MaterialPoints points = box({shift, 0.0, 0.0}, length, 4.0 * h, 0.5 * h);
  for (std::size_t p = 0; p < points.x.size(); ++p)
    points.v[p] = {strain * speed * modeAt(set.ends, points.x[p].x - shift), 0.0, 0.0};
  std::vector<mpm::GridBorder> borders{{.axis = 1}, {.axis = 1, .above = true, .place = 4.0 * h}};
  if (set.ends == Ends::held) {
    borders.push_back({.axis = 0});
    borders.push_back({.axis = 0, .above = true, .place = length});
  }
  const auto solid = mpm::makePoints(points, neoHookeanField(youngs, poisson),
                                     {.grid = {.spacing = h, .shape = set.shape, .borders = borders},
                                      .transfer = set.transfer,
                                      .renewal = set.renewal});
  fem::Model model = mpm::makeModel(solid);
  fem::addMass(model);
  const double dt = std::min(0.5 * fem::stableStep(model).dt, 2e-3 * exact);
  fem::ExplicitIntegrator run(model, dt);
  const double energy = run.kineticEnergy();
  std::vector<double> t, q;
  while (model.t < periods * exact) {
    run.step();
    const std::vector<Vec3> x = solid->places(model.nodes);
    double sum = 0.0;
    for (std::size_t p = 0; p < x.size(); ++p)
      sum += (x[p].x - points.x[p].x) * modeAt(set.ends, points.x[p].x - shift);
    t.push_back(model.t), q.push_back(sum);
  }
  return {periodOf(t, q) / exact, run.ledger().joules("renewals of points") / energy,
          run.ledger().largestResidual() / energy, solid->renewals()};
}

}  // namespace

bool bar(bool quick) {
  bool holds = true;
  std::printf("Error of the period in %% at cells a bar; five periods, strains up to %.0e\n\n", strain);
  std::printf("| ends | shape | 8 | 16 | 32 | 64 | order | cells for 0.1 %% |\n|---|---|---|---|---|---|---|---|\n");
  for (const Ends ends : {Ends::held, Ends::free})
    for (const mpm::Shape shape : {mpm::Shape::quadratic, mpm::Shape::cubic, mpm::Shape::gimp}) {
      std::printf("| %s | %s |", ends == Ends::held ? "held" : "free", name(shape));
      std::vector<double> error;
      for (const int cells : {8, 16, 32, 64}) {
        if (quick && cells == 64) continue;
        error.push_back(vibrate({.cells = cells, .ends = ends, .shape = shape}).period - 1.0);
        std::printf(" %+.3f |", 100.0 * error.back());
        std::fflush(stdout);
      }
      const double order = std::log2(std::abs(error[error.size() - 2] / error.back()));
      const double finest = quick ? 32.0 : 64.0, needed = finest * std::sqrt(std::abs(error.back()) / 1e-3);
      if (quick) std::printf(" |");
      std::printf(" %.2f | %.0f |\n", order, std::ceil(needed));
      if (!quick) holds = holds && std::abs(error.back()) < 1e-3;
    }
  std::printf("\n%d cells, renewed at a travel of that part of a cell\n\n", quick ? 16 : 32);
  std::printf(
      "| transfer | shape | renewal | renewals | period, %% | lost by renewals, %% | residual |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const mpm::Transfer transfer : {mpm::Transfer::flip, mpm::Transfer::apic})
    for (const mpm::Shape shape : {mpm::Shape::quadratic, mpm::Shape::cubic})
      for (const double renewal : {1e-3, 2.5e-4}) {
        const Setting set{quick ? 16 : 32, Ends::held, shape, transfer, renewal};
        const Answer answer = vibrate(set);
        std::printf("| %s | %s | %.0e | %ld | %+.3f | %.3f | %.1e |\n", nameOf(transfer), name(shape), renewal,
                    static_cast<long>(answer.renewals), 100.0 * (answer.period - 1.0), 100.0 * answer.lost,
                    answer.residual);
        std::fflush(stdout);
      }
  return holds;
}

}  // namespace dovetail::benchmark
