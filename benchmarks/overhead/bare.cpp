// The barest scene beside a loop written by hand, and what single features cost beside it.
#include <algorithm>
#include <iostream>

#include "common/outputs.hpp"
#include "dem/scenes.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/report/summary.hpp"
#include "dovetail/report/text.hpp"
#include "features.hpp"
#include "hand_loop.hpp"
#include "program/options.hpp"
#include "program/run.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::overhead;
using report::format, report::Json;

struct Settings {
  std::string summary;
  int edge = 46, turns = 41;
};

constexpr int stepsPerTurn = 10;

/// The wave lattice in the engine and in the hand-written loop, turn by turn, and how far they come apart.
Json besideHandLoop(const Settings& s) {
  auto model = dem_benchmark::waveLattice(s.edge, s.edge, s.edge);
  findForces(model);
  constexpr double dt = dem_benchmark::timeStep;
  HandLoop loop(model, dem_benchmark::stiffness);
  const Duel time = duel(
      s.turns,
      [&] {
        for (int k = 0; k < stepsPerTurn; ++k) loop.step(dt);
      },
      [&] {
        for (int k = 0; k < stepsPerTurn; ++k) advance(model, dt);
      });
  double apart = 0.0;
  for (std::size_t i = 0; i < loop.x.size(); ++i) apart = std::max(apart, norm(model.particles.x[i] - loop.x[i]));
  const double grains = static_cast<double>(loop.x.size()), each = 1e9 / stepsPerTurn / grains;
  std::cout << format(
      "%.0f spheres, frictionless lattice: by hand %.2f ns per grain step, Dovetail %.2f (ratio %.3f, quartiles %.3f "
      "and %.3f); positions differ by %.1e m after %d steps; list %s\n",
      grains, each * time.first, each * time.second, time.ratio, time.lower, time.upper, apart, stepsPerTurn * s.turns,
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

/// Turns of different features lie minutes apart, so a feature's time is the least of the barest scene, of all turns,
/// times the ratio.
Json besideBare(const Settings& s) {
  const std::vector<Feature> features = featuresOf(s.edge, stepsPerTurn, s.turns);
  const auto bare = [](const Feature& f) { return f.time.first; };
  const double each = 1e9 / stepsPerTurn / (static_cast<double>(s.edge) * s.edge * s.edge) *
                      bare(*std::ranges::min_element(features, {}, bare));
  Json rows = Json::array();
  for (const Feature& f : features) {
    std::cout << format("%-44s %7.1f ns per grain step, %+6.2f %% (quartiles %+.2f, %+.2f), %+.3f bytes per grain\n",
                        f.name.c_str(), each * f.time.ratio, 100.0 * (f.time.ratio - 1.0), 100.0 * (f.time.lower - 1.0),
                        100.0 * (f.time.upper - 1.0), f.bytesPerGrain);
    rows.push_back({{"feature", f.name},
                    {"used", f.used},
                    {"ns", each * f.time.ratio},
                    {"cost_fraction", f.time.ratio - 1.0},
                    {"lower_quartile", f.time.lower - 1.0},
                    {"upper_quartile", f.time.upper - 1.0},
                    {"bytes_per_grain", f.bytesPerGrain}});
  }
  return rows;
}

bool parse(int argc, char** argv, Settings& s) {
  program::Options o("overhead_bare",
                     "Cost of the barest grains against a loop written by hand, and of single features. One thread.");
  o.text("--summary FILE", s.summary, "write the figures as JSON");
  o.integer("--edge N", s.edge, 12, 200, "spheres along each edge of the cube");
  o.integer("--turns N", s.turns, 4, 10000, "number of alternations between the compared cases");
  return o.parse(argc, argv);
}

}  // namespace

/// Exit code 0: done; 2: the request was refused.
int main(int argc, char** argv) {
  return program::runProgram("overhead_bare", [&] {
    Settings s;
    if (!parse(argc, argv, s)) return true;
    setThreads(1);
    if (!s.summary.empty()) benchmark::prepareSummary(s.summary);
    const Json byHand = besideHandLoop(s), features = besideBare(s);
    if (!s.summary.empty())
      report::writeSummary(s.summary, io::provenance(), {{"by_hand", byHand}, {"features", features}});
    return true;
  });
}
