// Overlaps from 1e4 grains and elements to 1e5: memory, time per step and of its tie, cost of a list update,
// exponents.
//
//     coupling_size [cells across …] [part of a coupling's name]     by default 17 30 54, and all of them
//     coupling_size flow [part of a coupling's name]                 what list updates take of a run in which a bed
//     slides
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "program/run.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace {

using namespace dovetail;

constexpr double edge = 0.1, modulus = 1e7, density = 2000.0;  // m, Pa, kg/m³
constexpr int grainLayers = 9, overlapLayers = 6, solidLayers = 34;

struct Way {
  const char* name;
  arlequin::ConstraintKind kind;
  double width;  // element sizes
};

constexpr Way ways[] = {
    {"penalty, c = 0", arlequin::ConstraintKind::penalty, 0.0},
    {"penalty, c = 1", arlequin::ConstraintKind::penalty, 1.0},
    {"penalty, c = 2.5", arlequin::ConstraintKind::penalty, 2.5},
    {"multipliers, c = 0", arlequin::ConstraintKind::multiplier, 0.0},
    {"multipliers, c = 1", arlequin::ConstraintKind::multiplier, 1.0},
    {"multipliers, c = 2.5", arlequin::ConstraintKind::multiplier, 2.5},
};

struct Measured {
  std::size_t grains = 0, elements = 0, rows = 0;
  double memory = 0.0;               // MB that the scene has taken
  double setUp = 0.0;                // s, of the tie
  double step = 0.0, stepTwo = 0.0;  // s, by one thread and by two
  double tie = 0.0, tieTwo = 0.0;    // s of it
  double all = 0.0, few = 0.0;       // s of a list update: all members move, one in a hundred does
};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Resident memory of the process, MB.
double resident() {
#ifdef __GLIBC__
  malloc_trim(0);  // what earlier scenes gave back
#endif
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmRSS:") {
      double kilobytes = 0.0;
      status >> kilobytes;
      return kilobytes / 1024.0;
    }
  return 0.0;
}

struct Scene {
  coupling::CoupledRun run;
  arlequin::ArlequinCoupling* tie = nullptr;
  std::size_t elements = 0;
};

/// A lattice of four grains per element on a block of bricks, `across` elements wide.
std::unique_ptr<Scene> makeScene(int across, const Way& way) {
  auto scene = std::make_unique<Scene>();
  dem::Model& grains = scene->run.grains;
  // One cell of the lattice more than elements: no particle lies like another in its element.
  const double cell = edge * across / (across + 1.0), distance = cell / std::sqrt(2.0);
  const int layers = static_cast<int>(std::lround(grainLayers * edge / cell));
  const dem::Packing lattice =
      dem::latticeBlock(dem::Lattice::faceCentred, {across + 1, across + 1, layers}, 0.5 * distance, distance);
  for (const Vec3& centre : lattice.centre)
    dem::addParticle(grains.particles, centre, {}, 0.5 * distance, dem::Mass{density * cell * cell * cell / 4.0});
  dem::ElasticLaw law;
  law.normal.stiffness = modulus * distance;
  law.normal.bonded = true;
  grains.laws = dem::makeContactLaws(law);
  grains.refusesUnstableSteps = false;

  const double top = overlapLayers * edge, width = across * edge;
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {across, across, solidLayers},
                                         {0.0, 0.0, top - solidLayers * edge}, {width, width, top});
  std::vector<double> s;
  for (const Vec3& X : mesh.X)
    s.push_back(X.z < -1e-9 ? arlequin::beyondOverlap : std::clamp(1.0 - X.z / top, 0.0, 1.0));
  const std::vector<double> weight = arlequin::nodalWeights(s, {});
  auto model = std::make_unique<fem::Model>(fem::makeModel(mesh));
  model->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{modulus, 0.0, density})),
                            {.fraction = arlequin::solidWeights(weight)}));
  fem::fix(model->nodes, fem::nodeSet(mesh, "z-"));
  scene->elements = mesh.elementCount();
  coupling::SolidSide& side = scene->run.addSolid(std::move(model));
  arlequin::CouplingOptions options;
  options.constraint = way.kind;
  options.projection.width = way.width * edge;
  auto tie = arlequin::makeArlequinCoupling(grains, mesh, weight, side, options);
  scene->tie = tie.get();
  grains.terms.add(std::unique_ptr<dem::Term>(std::move(tie)));
  return scene;
}

double secondsOf(const Profile& profile, const std::string& stage) {
  for (const Profile::Row& row : profile.rows())
    if (row.name == stage) return row.seconds;
  return 0.0;
}

/// Seconds per step and of its tie: the least of some groups of steps.
void timeSteps(Scene& scene, double& step, double& tie) {
  scene.run.advance(1, false);
  const double first = now();
  scene.run.advance(1, false);
  const double one = now() - first;
  const int steps = std::clamp(static_cast<int>(0.3 / one), 2, 50);
  step = tie = 1e30;
  for (int group = 0; group < 3; ++group) {
    Profile profile(true);
    scene.run.grains.profile = &profile;
    const double begin = now();
    scene.run.advance(steps);
    step = std::min(step, (now() - begin) / steps);
    tie = std::min(tie, secondsOf(profile, "overlap") / steps);
    scene.run.grains.profile = nullptr;
    if (one > 2.0) return;
  }
}

/// Seconds that a step takes longer when every `every`-th grain has slid through the solid; the least of a few.
double timeUpdate(Scene& scene, double step, std::size_t every) {
  dem::Particles& p = scene.run.grains.particles;
  const std::vector<Vec3> v = p.v;
  double least = 1e30;
  for (int time = 0; time < 3 && (time == 0 || least < 5.0); ++time) {
    for (std::size_t i = 0; i < p.size(); i += every)
      p.v[i] += ((time % 2 == 0 ? 0.15 : -0.15) * p.radius[0] / scene.run.dt()) * Vec3{1, 0, 0};
    const std::int64_t before = scene.tie->state().relocations;
    const double begin = now();
    scene.run.advance(1, false);
    least = std::min(least, now() - begin);
    p.v = v;
    if (scene.tie->state().relocations == before)
      throw NumericalError("no particle was located anew", "list update", "");
  }
  return least - step;
}

Measured measure(int across, const Way& way) {
  Measured m;
  const double before = resident();
  const auto scene = makeScene(across, way);
  coupling::CoupledRun& run = scene->run;
  m.grains = run.grains.particles.size();
  m.elements = scene->elements;
  const double begin = now();
  run.start(0.004 * edge / std::sqrt(modulus / density));
  m.setUp = now() - begin;
  m.rows = scene->tie->state().rows;
  for (std::size_t i = 0; i < run.grains.particles.size(); ++i)
    run.grains.particles.v[i].z = 0.01 * std::sin(40.0 * run.grains.particles.x[i].x);
  setThreads(1);
  timeSteps(*scene, m.step, m.tie);
  setThreads(2);
  timeSteps(*scene, m.stepTwo, m.tieTwo);
  m.few = timeUpdate(*scene, m.stepTwo, 100);
  m.all = timeUpdate(*scene, m.stepTwo, 1);
  m.memory = resident() - before;
  return m;
}

struct Flow {
  double between = 0.0;   // steps from one list update to the next
  double cost = 0.0;      // of a list update, in other steps
  double fraction = 0.0;  // of the run's time that list updates take
};

/// A bed that is pushed down through the overlap with a hundredth of the wave speed, past a solid that is held where it
/// is: over two periods from list update to list update, by two threads.
Flow measureFlow(Scene& scene, double dt) {
  coupling::CoupledRun& run = scene.run;
  run.start(dt);
  const Vec3 velocity{0.0, 0.0, -0.01 * std::sqrt(modulus / density)};
  double plain = 0.0, all = 0.0;
  int steps = 0, listUpdates = 0;
  for (bool counts = false; listUpdates < 2;) {
    std::ranges::fill(run.grains.particles.v, velocity);
    std::ranges::fill(run.solid(0).nodes().v, Vec3{});
    std::ranges::fill(run.solid(0).nodes().u, Vec3{});
    const std::int64_t before = scene.tie->state().relocations;
    const double begin = now();
    run.advance(1, false);
    const double took = now() - begin;
    const bool updates = scene.tie->state().relocations > before;
    if (counts) {
      all += took;
      ++steps;
      if (updates)
        ++listUpdates;
      else
        plain += took;
    }
    counts = counts || updates;
  }
  const double one = plain / (steps - listUpdates), ofUpdates = all - steps * one;
  return {static_cast<double>(steps) / listUpdates, ofUpdates / one / listUpdates, ofUpdates / all};
}

void printFlows(const std::string& only) {
  constexpr int across = 17;
  const double crossing = edge / std::sqrt(modulus / density);
  std::printf(
      "A bed slides at 0.01 c, %d cells across, 2 threads. Steps, in element sizes over c, are a fifth of the critical "
      "one.\n",
      across);
  std::printf("%-22s %8s %14s %15s %10s\n", "coupling", "step", "steps between", "cost in steps", "share / %");
  for (const Way& way : ways) {
    if (std::string(way.name).find(only) == std::string::npos) continue;
    const auto scene = makeScene(across, way);
    scene->run.start(0.004 * crossing);
    const double dt = 0.2 * scene->run.criticalStep().dt;
    const Flow flow = measureFlow(*scene, dt);
    std::printf("%-22s %8.4f %14.0f %15.1f %10.1f\n", way.name, dt / crossing, flow.between, flow.cost,
                100.0 * flow.fraction);
    std::fflush(stdout);
  }
}

void print(int across, const Way& way, const Measured& m) {
  std::printf("%-22s %4d %7zu %7zu %6zu %7.0f %8.2f %9.2f %9.2f %6.2f %9.2f %6.2f %8.1f %8.1f\n", way.name, across,
              m.grains, m.elements, m.rows, m.memory, m.setUp, 1e3 * m.step, 1e3 * m.tie, m.tie / m.tieTwo,
              1e3 * m.stepTwo, m.step / m.stepTwo, m.few / m.stepTwo, m.all / m.stepTwo);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes;
  std::string only;
  bool flows = false;
  dovetail::program::Options options("coupling_size",
                                     "Memory and time of overlaps over their size, by one and two threads.");
  options
      .add("--wide N", "grains across, one number a time; 17, 30 and 54 if not given",
           [&](const std::string& text) { sizes.push_back(program::numberFrom<int>(text, "--wide")); }, {})
      .many = true;
  options.text("--only TEXT", only, "couplings whose name holds this");
  options.flag("--flow", flows, "what is in flow instead");
  return dovetail::program::runProgram(options, argc, argv, [&] {
    if (flows) return printFlows(only), true;
    if (sizes.empty()) sizes = {17, 30, 54};
    std::printf("Threads: 2 unless told. List updates in steps by two threads.\n");
    std::printf("%-22s %4s %7s %7s %6s %7s %8s %9s %9s %6s %9s %6s %8s %8s\n", "coupling", "wide", "grains", "bricks",
                "rows", "MB", "start s", "1: step", "1: tie", "gain", "2: step", "gain", "few", "all");
    for (const Way& way : ways) {
      if (!only.empty() && std::string(way.name).find(only) == std::string::npos) continue;
      std::vector<Measured> all;
      for (const int across : sizes) {
        all.push_back(measure(across, way));
        print(across, way, all.back());
      }
      if (all.size() < 2) continue;
      const double decades = std::log(static_cast<double>(all.back().grains) / static_cast<double>(all.front().grains));
      const auto exponent = [&](double first, double last) { return std::log(last / first) / decades; };
      std::printf("%-22s exponents: memory %.2f, step %.2f, tie %.2f\n", way.name,
                  exponent(all.front().memory, all.back().memory), exponent(all.front().stepTwo, all.back().stepTwo),
                  exponent(all.front().tieTwo, all.back().tieTwo));
    }
    return true;
  });
}
