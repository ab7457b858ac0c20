// What scenes pay: the barest one beside a loop written by hand, features that are there and not used, and a ladder of
// scenes up to everything.
#include <cmath>
#include <iostream>

#include "common/outputs.hpp"
#include "dem/scenes.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/table.hpp"
#include "dovetail/report/text.hpp"
#include "hand_loop.hpp"
#include "idle_features.hpp"
#include "price.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "rungs.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::atlas;
using report::format, report::Json;

struct Settings {
  std::string summary;
  int edge = 46, turns = 41;
  bool quick = false;
};

/// The wave lattice in the engine and in the hand-written loop, turn by turn, and how far they come apart.
Json besideHandLoop(const Settings& s) {
  auto model = dem_benchmark::waveLattice(s.edge, s.edge, s.edge);
  findForces(model);
  constexpr double dt = dem_benchmark::timeStep;
  HandLoop loop(model, dem_benchmark::stiffness);
  constexpr int steps = 10;
  const Duel time = duel(
      s.turns,
      [&] {
        for (int k = 0; k < steps; ++k) loop.step(dt);
      },
      [&] {
        for (int k = 0; k < steps; ++k) advance(model, dt);
      });
  double apart = 0.0;
  for (std::size_t i = 0; i < loop.x.size(); ++i) apart = std::max(apart, norm(model.particles.x[i] - loop.x[i]));
  const double grains = static_cast<double>(loop.x.size()), each = 1e9 / steps / grains;
  std::cout << format(
      "%.0f spheres, frictionless lattice: by hand %.2f ns per grain step, Dovetail %.2f (ratio %.3f, quartiles %.3f "
      "and %.3f); positions differ by %.1e m after %d steps; list %s\n",
      grains, each * time.first, each * time.second, time.ratio, time.lower, time.upper, apart, steps * s.turns,
      loop.listIsGood() ? "good to the end" : "OUTLIVED");
  return {{"grains", grains},
          {"hand_ns", each * time.first},
          {"ns", each * time.second},
          {"ratio", time.ratio},
          {"ratio_lower_quartile", time.lower},
          {"ratio_upper_quartile", time.upper},
          {"largest_difference_m", apart},
          {"list_is_good", loop.listIsGood()}};
}

Json idle(const Settings& s) {
  Json rows = Json::array();
  for (const IdleFeature& f : idleFeatures(s.edge, 10, s.turns)) {
    std::cout << format("%-44s %+6.2f %% (quartiles %+.2f, %+.2f), %+.3f bytes per grain\n", f.name.c_str(),
                        100.0 * (f.time.ratio - 1.0), 100.0 * (f.time.lower - 1.0), 100.0 * (f.time.upper - 1.0),
                        f.bytesPerGrain);
    rows.push_back({{"feature", f.name},
                    {"cost_share", f.time.ratio - 1.0},
                    {"lower_quartile", f.time.lower - 1.0},
                    {"upper_quartile", f.time.upper - 1.0},
                    {"bytes_per_grain", f.bytesPerGrain}});
  }
  return rows;
}

Json climb(const Settings& s) {
  Json rows = Json::array();
  const int edge = s.quick ? 18 : 30;
  for (std::size_t rung = 0; rung < ladder().size(); ++rung) {
    const double before = allocated();
    const auto run = makeRung(rung, edge);
    run->start(dem_benchmark::timeStep);
    run->advance(20);
    const double bytes = allocated() - before, grains = static_cast<double>(run->grains.particles.size());
    constexpr int steps = 10;
    double least = INFINITY;
    for (int turn = 0; turn < s.turns / 2; ++turn) {
      const double start = processorTime();
      run->advance(steps);
      least = std::min(least, processorTime() - start);
    }
    const double each = 1e9 * least / steps / grains;
    const double residual = std::abs(run->ledger().residual());
    std::cout << format("%-44s %8.0f grains %8.1f ns per grain step %8.0f bytes per grain, residual %.1e J\n",
                        ladder()[rung].name.c_str(), grains, each, bytes / grains, residual);
    rows.push_back({{"rung", ladder()[rung].name},
                    {"components", ladder()[rung].components},
                    {"grains", grains},
                    {"ns_per_grain_step", each},
                    {"bytes_per_grain", bytes / grains}});
  }
  return rows;
}

bool parse(int argc, char** argv, Settings& s) {
  program::Options o("atlas_ladder", "What scenes pay in time and memory, from bare grains to everything. One thread.");
  o.text("--summary FILE", s.summary, "write the figures as JSON");
  o.integer("--edge N", s.edge, 12, 200, "spheres along each edge of the cube of the barest scenes");
  o.integer("--turns N", s.turns, 4, 10000, "how often what is compared takes turns");
  o.flag("--quick", s.quick, "smaller scenes on the ladder");
  return o.parse(argc, argv);
}

}  // namespace

/// Exit code 0: done; 2: the request was refused.
int main(int argc, char** argv) {
  return program::runProgram("atlas_ladder", [&] {
    Settings s;
    if (!parse(argc, argv, s)) return true;
    setThreads(1);
    if (!s.summary.empty()) benchmark::prepareSummary(s.summary);
    Json json{{"study", "ladder"}, {"provenance", report::objectOf(io::provenance())}};
    json["by_hand"] = besideHandLoop(s);
    json["idle"] = idle(s);
    json["ladder"] = climb(s);
    if (!s.summary.empty()) io::writeFileAtomically(s.summary, json.dump(2) + "\n");
    return true;
  });
}
