// All of a scene short of running it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <ostream>

#include "build/parts.hpp"
#include "cell_fields.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/memory.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/mpm/point_solid.hpp"
#include "dovetail/scene/execute.hpp"
#include "output_cost.hpp"
#include "plan.hpp"
#include "series.hpp"

namespace dovetail::scene {

namespace {

constexpr double longestMeasured = 0.5;  // s of a macro step, by the size of its linear systems

/// Of a scene that cannot start, as far as they can be told.
void reportWarnings(const Built& built, const Scene& scene, bool starts, std::ostream& log) {
  for (const std::string& note : built.notes) log << note << '\n';
  Lines lines;
  try {
    lines = warnings(built, scene, starts);
  } catch (const std::exception&) {
    if (starts) throw;
  }
  for (const std::string& warning : lines) log << "WARNING: " << warning << '\n';
}

/// A point reaches the nodes around the cell that it is in: points of one cell reach the same ones.
std::string pointsTold(const mpm::PointSolid& body) {
  const mpm::GridRows& rows = body.rows();
  int fewest = std::numeric_limits<int>::max(), most = 0;
  for (std::size_t c = 0; c < rows.cells(); ++c) {
    const int own = rows.firstOfCell[c + 1] - rows.firstOfCell[c];
    fewest = std::min(fewest, own), most = std::max(most, own);
  }
  return std::to_string(rows.points()) + " points on " + std::to_string(rows.nodes()) + " nodes of a grid, " +
         std::to_string(fewest) + (most > fewest ? " to " + std::to_string(most) : "") + " a cell, " +
         formatNumber(std::round(10.0 * static_cast<double>(body.memory()) / 1048576.0) / 10.0) + " MiB";
}

void reportParts(Built& built, const Scene& scene, std::ostream& log) {
  const coupling::CoupledRun& run = *built.run;
  reportWarnings(built, scene, true, log);
  log << countOfGrains(run.grains.particles) << " particles, contacts: " << run.grains.laws->name() << '\n';
  for (std::size_t s = 0; s < run.solids(); ++s) {
    log << "solid \"" << run.solid(s).name << "\": ";
    if (const auto* const body = materialPoints(*run.solid(s).model))
      log << pointsTold(*body) << '\n';
    else
      log << built.meshes[s].X.size() << " nodes, " << built.meshes[s].elementCount() << " elements\n";
  }
  for (const std::string& line : linesOnCells(built)) log << line << '\n';
  log << "step " << run.dt() << " s\n";
  for (const StepLimit& limit : limits(built, scene))
    if (std::isfinite(limit.dt))
      log << "  at most " << limit.dt << " s: " << limit.owner << (run.dt() > limit.dt ? "  EXCEEDED" : "") << '\n';
}

double solverMemory(const Built& built) {
  double bytes = 0.0;
  for (const linalg::LinearForecast& forecast : built.forecasts) bytes += forecast.bytes;
  return bytes;
}

/// Of a macro step: one factorisation of every solid, or a hundred iterations, at rates of one core. s
double solverTime(const Built& built) {
  double seconds = 0.0;
  for (const linalg::LinearForecast& forecast : built.forecasts)
    seconds += forecast.operations / (forecast.method == linalg::LinearMethod::direct ? 1e10 : 1e9);
  return seconds;
}

/// Seconds that a macro step takes: of ten if these take no longer than three seconds, of more for up to a second.
double secondsPerMacroStep(coupling::CoupledRun& run) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begun = Clock::now();
  double seconds = 0.0;
  int macroSteps = 0;
  while (macroSteps == 0 || (macroSteps < 10 && seconds < 3.0) || (seconds < 1.0 && macroSteps < 1000)) {
    run.advance();
    ++macroSteps;
    seconds = std::chrono::duration<double>(Clock::now() - begun).count();
  }
  return seconds / macroSteps;
}

void reportTime(Built& built, const Scene& scene, const Plan& plan, std::ostream& log) {
  std::int64_t wanted = 0, atMost = 0;
  double time = 0.0;
  for (std::size_t k = 0; k < plan.stages.size(); ++k)
    if (const auto* const run = std::get_if<RunFor>(&scene.stages[k].kind)) {
      wanted += plan.stages[k];
      time += run->time;
    } else if (std::holds_alternative<Statics>(scene.stages[k].kind)) {
      log << "stage " << k + 1 << ": " << plan.stages[k] << " load steps of the solids\n";
    } else if (const auto* const modes = std::get_if<FindModes>(&scene.stages[k].kind)) {
      log << "stage " << k + 1 << ": " << modes->count << " modes of each solid\n";
    } else {
      atMost += plan.stages[k];
    }
  const double foreseen = solverTime(built);
  const bool isMeasured = foreseen < longestMeasured;
  const double each = isMeasured ? secondsPerMacroStep(*built.run) : foreseen;
  log << "stages run for " << time << " s: " << wanted << " macro steps of " << scene.steps.stepsPerMacroStep
      << " steps, " << formatDuration(each * static_cast<double>(wanted)) << " at " << 1e3 * each << " ms each "
      << (isMeasured ? "as it is now" : "or more, by the size of the linear systems") << '\n';
  constexpr double month = 30.0 * 86400.0;
  if (each * static_cast<double>(wanted) > month)
    log << "WARNING: The stages take more than a month: take a shorter time, look at its unit, or take larger grains "
           "and elements, or softer ones.\n";
  if (atMost > 0)
    log << "stages relax in at most " << atMost << " macro steps, "
        << formatDuration(each * static_cast<double>(atMost)) << '\n';
}

double mebibytes(double bytes) { return std::round(bytes / 1048576.0); }

void reportMemory(const Built& built, std::ostream& log) {
  const double solvers = solverMemory(built), now = residentMemory();
  log << "memory " << mebibytes(now + solvers) << " MiB";
  if (solvers > 0.1 * now) log << ", " << mebibytes(solvers) << " MiB of them for linear systems";
  if (const double left = availableMemory(); std::isfinite(left)) log << "; " << mebibytes(left) << " MiB are free";
  log << '\n';
}

}  // namespace

std::vector<std::string> seriesColumns(const Scene& scene) {
  Built built = build(scene);
  start(built, scene);
  return SeriesRow(built, scene).names();
}

void check(const Scene& scene, std::ostream& log) {
  Built built = build(scene);
  Plan plan;
  try {
    start(built, scene);
    plan = planOf(built, scene);
  } catch (const std::exception&) {
    reportWarnings(built, scene, false, log);
    throw;
  }
  if (plan.series > 0) const SeriesRow columns(built, scene);
  reportParts(built, scene, log);
  reportTime(built, scene, plan, log);
  reportOutput(built, scene, plan, log);
  reportMemory(built, log);
}

}  // namespace dovetail::scene
