#include "matrix_figures.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "matrix_scene.hpp"

namespace dovetail::coupling_matrix {

namespace {

constexpr int samples = 10;

/// Half of what all channels have gained and lost together, J.
double turnedOver(const EnergyLedger& ledger) {
  double sum = 0.0;
  for (const EnergyLedger::Channel& channel : ledger.channels())
    sum += 0.5 * std::abs(channel.joules - channel.joulesAtOpening);
  return sum;
}

std::unique_ptr<coupling::CoupledRun> started(const Case& c, double fraction) {
  auto run = makeScene(c);
  startAt(*run, c, fraction);
  return run;
}

/// The same time for every fraction.
int macroStepsOf(const Case& c, double fraction, int steps) {
  return static_cast<int>(std::lround(steps * fractions[1] / fraction / c.stepsPerMacroStep()));
}

void measureFraction(const Case& c, std::size_t k, int steps, Figures& figures) {
  const auto run = started(c, fractions[k]);
  std::vector<double> residuals;
  double turned = 0.0;
  for (int sample = 0; sample < samples; ++sample) {
    run->advance(macroStepsOf(c, fractions[k], steps) / samples);
    const EnergyLedger& ledger = run->ledger();
    residuals.push_back(std::abs(ledger.residual()));
    turned = std::max(turned, turnedOver(ledger));
  }
  std::ranges::sort(residuals);
  figures.energy[k] = residuals[samples / 2] / turned;
  const coupling::Totals totals = run->totals();
  figures.angular[k] = norm(totals.residual.angular) / totals.turnedOverAngular;
  if (k != 1) return;
  figures.largestEnergy = residuals.back() / turned;
  figures.dt = run->dt();
  figures.momentum = norm(totals.residual.linear) / totals.turnedOver;
  figures.mass = std::abs(totals.massResidual) / totals.mass;
  figures.friction = run->ledger().joules("particles: friction") / turned;
}

std::vector<char> stateAfter(const Case& c, int macroSteps, int threads) {
  const int before = dovetail::threads();
  setThreads(threads);
  const auto run = started(c, fractions[1]);
  run->advance(macroSteps);
  setThreads(before);
  return run->save();
}

double orderOf(const std::array<double, 3>& errors) {
  return std::log(errors.front() / errors.back()) / std::log(fractions.front() / fractions.back());
}

}  // namespace

double Figures::energyOrder() const { return orderOf(energy); }
double Figures::angularOrder() const { return orderOf(angular); }

namespace {
void measureAll(const Case& c, int steps, Figures& figures) {
  for (std::size_t k = 0; k < fractions.size(); ++k) measureFraction(c, k, steps, figures);
  const int half = macroStepsOf(c, fractions[1], steps) / 2;
  const std::vector<char> one = stateAfter(c, half, 1);
  figures.threads = one == stateAfter(c, half, 2);
  const auto first = started(c, fractions[1]), second = started(c, fractions[1]);
  first->advance(half);
  second->load(first->save());
  for (const auto& run : {first.get(), second.get()}) run->advance(half / 2);
  figures.restart = first->save() == second->save();
}
}  // namespace

Figures measure(const Case& c, int steps) {
  // Whole macro steps of four steps between looks, at the coarsest fraction too.
  const int unit = samples * 4 * static_cast<int>(std::lround(fractions[0] / fractions[1]));
  if (steps < unit || steps % unit != 0)
    throw InputError("the number of steps is " + std::to_string(steps), "measure",
                     "give a multiple of " + std::to_string(unit));
  const auto start = std::chrono::steady_clock::now();
  Figures figures;
  try {
    makeScene(c);
  } catch (const InputError& error) {
    figures.refused = error.what();
    return figures;
  }
  try {
    measureAll(c, steps, figures);
  } catch (const NumericalError& error) {
    figures.broke = error.what();
  }
  figures.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return figures;
}

std::string shortfall(const Case& c, const Figures& figures) {
  if (!figures.refused.empty()) return {};
  if (!figures.broke.empty()) return "breaks down: " + figures.broke;
  std::string text;
  const auto ask = [&](bool holds, const char* what) {
    if (!holds) text += (text.empty() ? "" : ", ") + std::string(what);
  };
  ask(figures.momentum <= 1e-10, "momentum");
  // Newmark's steps keep angular momentum to second order.
  ask(figures.angular[1] <= 1e-10 || (c.isImplicit() && figures.angularOrder() > 1.5 && figures.angular[1] <= 1e-6),
      "angular momentum");
  ask(figures.mass <= 1e-13, "mass");
  ask(figures.largestEnergy <= 1e-3, "energy");
  // A twentieth of that need not fall: parts of first order (dashpots) and of second have either sign.
  ask(figures.energyOrder() > 0.7 || figures.energy[2] <= 5e-5, "order of the energy");
  ask(figures.friction > 0.0, "friction");
  ask(figures.threads, "threads");
  ask(figures.restart, "restart");
  return text;
}

}  // namespace dovetail::coupling_matrix
