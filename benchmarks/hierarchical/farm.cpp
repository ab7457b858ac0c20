// What ranks make of cells in solids: times of the cells, recorded on one rank or several, are replayed for more.
#include "dovetail/hierarchical/farm.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "biaxial_solid.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "farm/farm_plan.hpp"
#include "figure.hpp"

namespace dovetail::benchmark {

namespace {

using hierarchical::RecordedStep;
using hierarchical::Replay;

// Of a network: a letter to and from each rank, s; of a cell of 400 discs, bytes.
constexpr double letter = 4e-5, move = hierarchical::priceOfMove(100'000);

/// A field of cells that notes what they take.
class Recorded final : public fem::PointField {
public:
  explicit Recorded(std::shared_ptr<fem::PointField> inner) : inner_(std::move(inner)) {}
  std::string name() const override { return inner_->name(); }
  double density() const override { return inner_->density(); }
  void open(std::span<const fem::PointPlace> places) override { inner_->open(places); }
  void evaluate(const fem::FieldRequest& request) override {
    inner_->evaluate(request);
    if (request.moved || !request.tangent.empty()) step_.push_back(inner_->seconds());
  }
  void commit() override {
    inner_->commit();
    steps.push_back(std::exchange(step_, {}));
    std::fprintf(stderr, "step %zu: %.1f s in cells until now\n", steps.size(),
                 hierarchical::replay(steps, 1, 0.0, 0.0).alone);
  }
  void revert() override { inner_->revert(); }
  void save(ByteWriter& archive) const override { inner_->save(archive); }
  void load(ByteReader& archive) override { inner_->load(archive); }

  std::vector<RecordedStep> steps;

private:
  std::shared_ptr<fem::PointField> inner_;
  RecordedStep step_;
};

double wallSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Recording {
  std::vector<RecordedStep> steps;
  double wall = 0.0;
  std::int64_t iterations = 0;
  double axial = 0.0;  ///< Pa
};

/// To 1.2 % of strain in 30 steps, past the peak.
Recording record(std::array<int, 2> elements, int steps, int discs = 400) {
  std::vector<rve::Rve> samples;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) samples.push_back(sand(seed, discs));
  const auto field = std::make_shared<Recorded>(hierarchical::cellField(samples, hierarchical::QuasiStaticCells{}));
  BiaxialSolid body({.elements = elements,
                     .shape = fem::ElementShape::quad8,
                     .formulation = fem::Formulation::reduced,
                     .rough = true},
                    field, [](double t) { return 2.0 * 4e-4 * t; });
  fem::addMass(body.model);
  const double start = wallSeconds();
  const fem::StaticReport report = fem::solveStatics(
      body.model, steps,
      {.newton = {.relativeTolerance = 1e-3, .lineSearch = false, .reuseContraction = 0.5, .mixing = 5},
       .firstStep = 1.0,
       .largestStep = 1.0,
       .smallestStep = 0.1,
       .iterationTarget = 1000,  // steps stay as long
       .motionIterations = 2000});
  return {field->steps, wallSeconds() - start, report.iterations, body.axial()};
}

std::string noteOf(const Recording& run) {
  char note[80];
  std::snprintf(note, sizeof note, "%lld iterations, %.1f kPa", static_cast<long long>(run.iterations),
                1e-3 * run.axial);
  return note;
}

double cellSeconds(const Recording& run) { return hierarchical::replay(run.steps, 1, 0.0, 0.0).alone; }

FigureRow speedUp(const Recording& run, int ranks, double rest, double wanted, const std::string& what) {
  const Replay replay = hierarchical::replay(run.steps, ranks, letter, move);
  char note[120];
  std::snprintf(note, sizeof note, "%zu moves, %.2f s", replay.moves, replay.farm + rest);
  FigureRow row{what + ", " + std::to_string(ranks) + " ranks",
                (replay.alone + rest) / (replay.farm + rest),
                0.0,
                wanted,
                0.0,
                note};
  row.atLeast = true;
  return row;
}

}  // namespace

FigureRows farm(bool quick) {
  const Recording run = quick ? record({4, 8}, 4) : record({8, 16}, 30);
  const int ranks = hierarchical::ranksOfFarm();
  const double cells = cellSeconds(run);
  const double unjudged = std::nan("");
  FigureRows rows{{"wall clock on " + std::to_string(ranks) + " ranks, s", run.wall, 0.0, unjudged, 0.0, noteOf(run)},
                  {"in cells, s", cells, 0.0, unjudged}};
  if (ranks > 1) {
    rows.push_back({"replayed for these ranks, cells alone, s",
                    hierarchical::replay(run.steps, ranks, letter, move).farm, 0.0, unjudged});
    return rows;
  }
  const double rest = std::max(run.wall - cells, 0.0);  // on one thread
  rows.push_back({"outside cells, s", rest, 0.0, unjudged});
  rows.push_back(speedUp(run, 2, rest, unjudged, "times as fast as alone, replayed with the solver"));
  rows.push_back(speedUp(run, 10, 0.0, quick ? unjudged : 9.3, "times as fast as alone, replayed"));
  rows.push_back(speedUp(run, 50, 0.0, quick ? unjudged : 42.0, "times as fast as alone, replayed"));
  rows.push_back(speedUp(run, 50, rest, quick ? unjudged : 40.0, "times as fast as alone, replayed with the solver"));
  return rows;
}

FigureRows farmOfLargeCells(bool quick) {
  const Recording run = quick ? record({4, 8}, 2, 1600) : record({8, 16}, 30, 1600);
  const double rest = std::max(run.wall - cellSeconds(run), 0.0), unjudged = std::nan("");
  return {{"wall clock on " + std::to_string(hierarchical::ranksOfFarm()) + " ranks, min (3401 printed)",
           run.wall / 60.0, 0.0, unjudged, 0.0, noteOf(run)},
          speedUp(run, 50, 0.0, quick ? unjudged : 44.0, "times as fast as alone, replayed"),
          speedUp(run, 50, rest, unjudged, "times as fast as alone, replayed with the solver")};
}

}  // namespace dovetail::benchmark
