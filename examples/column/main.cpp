// A cylinder of beads loses its wall and collapses. How far it spreads depends on its shape alone.
#include <cstdio>
#include <iostream>

#include "common/beads.hpp"
#include "common/options.hpp"
#include "common/report.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::example;
using Scene = dem::Model;

/// Sand, salt and rice do not roll as spheres do; a little resistance stands for that. Its size is tuned: see README.
const Beads beads{.rolling = 0.03};
const double d = beads.diameter, tau = beads.fallTime(), dt = beads.step();

/// Lube, Huppert, Sparks & Hallworth, J. Fluid Mech. 508, 2004: (r∞ − r0)/r0 of a column of height a r0.
double lawOfLube(double a) { return a < 1.7 ? 1.24 * a : 1.6 * std::sqrt(a); }

/// A column at rest: its first wall is the ground, its second the cylinder around it.
Scene standingColumn(double r, double aspect, Profile& profile) {
  Scene column = emptyModel(beads, RollingLaw{beads.normal(), beads.tangential(), beads.rollingResistance()}, profile);
  const double loose = 1.2 * aspect * r;  // settles to about aspect r
  const dem::Packing block = looseBeads(beads, {{{-r, -r, 0.0}, {r, r, loose}}}, 1);
  for (std::size_t i = 0; i < block.centre.size(); ++i)
    if (std::hypot(block.centre[i].x, block.centre[i].y) + block.radius[i] < r)
      dem::addParticle(column.particles, block.centre[i], {}, block.radius[i], dem::Density{beads.density});
  dem::switchOnRotation(column.particles);
  for (const auto& wall : {dem::makePlane({}, {0, 0, 1}), dem::makeCylinder({}, {0, 0, 1}, r)})
    dem::addWall(column, wall).skin = 0.2 * d;
  dem::run(column, dt, static_cast<std::int64_t>(8.0 * tau / dt));
  return column;
}

/// Twice the height of the centre of mass, m.
double heightOf(const dem::Particles& particles) {
  double mass = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    mass += particles.mass[i];
    moment += particles.mass[i] * particles.x[i].z;
  }
  return 2.0 * moment / mass;
}

/// Radius of the deposit, m: within it the beads cover at least half of the ground, in rings one bead wide. Beads that
/// have rolled away on their own are no part of it.
double deposit(const dem::Particles& particles) {
  std::vector<double> covered;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto ring = static_cast<std::size_t>(std::hypot(particles.x[i].x, particles.x[i].y) / d);
    if (ring >= covered.size()) covered.resize(ring + 1);
    covered[ring] += particles.radius[i] * particles.radius[i] / (d * d * (2.0 * static_cast<double>(ring) + 1.0));
  }
  covered.push_back(0.0);
  std::size_t ring = 1;
  while (covered[ring] >= 0.5) ++ring;
  const double before = covered[ring - 1], after = covered[ring];  // at ring − 1/2 and ring + 1/2
  return d * (static_cast<double>(ring) - 0.5 + (before - 0.5) / (before - after));
}

struct Collapse {
  double aspect = 0.0, height = 0.0, runout = 0.0;  // a; final height at the axis over r0; (r∞ − r0)/r0
  double kinetic = 0.0;                             // J at the end, over the energy lost
  std::vector<double> time, radius, energy;         // s, m, J kinetic
};

/// Height of the highest bead near the axis, m.
double heightAtAxis(const dem::Particles& particles) {
  double height = 0.0;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (std::hypot(particles.x[i].x, particles.x[i].y) < 2.0 * d)
      height = std::max(height, particles.x[i].z + particles.radius[i]);
  return height;
}

/// Takes the cylinder away and waits until the beads have come to rest.
Collapse collapse(Scene& column, Progress& progress, double& done) {
  const dem::PrimitiveWall& cylinder = dem::primitiveWall(column, 1);
  const double r = cylinder.radius;
  dem::removeWall(column, cylinder);
  Collapse result;
  const double start = column.time, height = heightOf(column.particles);
  result.aspect = height / r;
  const double duration = 4.5 * std::sqrt(r / beads.gravity) + 2.0 * std::sqrt(2.0 * height / beads.gravity);
  const double before = done, fraction = static_cast<double>(column.particles.size()) * duration / tau / 50.0;
  runAndWatch(column, dt, duration, 50, [&](const Scene& now) {
    result.time.push_back(now.time - start);
    result.radius.push_back(deposit(now.particles));
    result.energy.push_back(dem::kineticEnergy(now.particles));
    progress.update(done += fraction);
  });
  done = before + 50.0 * fraction;
  result.runout = result.radius.back() / r - 1.0;
  result.height = heightAtAxis(column.particles) / r;
  result.kinetic = result.energy.back() / column.booked.lost.lostPower();
  return result;
}

void write(const Options& options, const std::vector<Collapse>& collapses) {
  io::TimeSeries series({"aspect", "time_s", "radius_m", "kinetic_J"}), table({"aspect", "runout", "height"});
  for (const Collapse& c : collapses) {
    table.append({c.aspect, c.runout, c.height});
    for (std::size_t k = 0; k < c.time.size(); ++k) series.append({c.aspect, c.time[k], c.radius[k], c.energy[k]});
  }
  const io::KeyValues origin = io::provenance({{"quick", options.quick ? "yes" : "no"}});
  io::writeCsv(options.out / "column.csv", series, origin);
  io::writeCsv(options.out / "column_runout.csv", table, origin);
}

bool compare(const std::vector<Collapse>& collapses, double tolerance) {
  double worst = 0.0;
  std::printf("\n       a   run-out   law of Lube et al.   off law   final height/r0   still moving\n");
  for (const Collapse& c : collapses) {
    const double law = lawOfLube(c.aspect), off = c.runout / law - 1.0;
    worst = std::max(worst, std::abs(off));
    std::printf("  %6.3f %9.3f %20.3f %8.1f %% %17.3f %14.1e\n", c.aspect, c.runout, law, 100.0 * off, c.height,
                c.kinetic);
  }
  std::printf("\nlargest distance from the law: %.1f %% (tolerance %.0f %%)\n%s\n", 100.0 * worst, 100.0 * tolerance,
              worst < tolerance ? "within the tolerance" : "NOT within the tolerance");
  return worst < tolerance;
}

bool run(const Options& options) {
  if (!options.out.empty()) io::prepareOutputFolder(options.out, {"column.csv", "column_runout.csv"});
  const std::vector<double> aspects = options.quick ? std::vector{0.6} : std::vector{0.5, 1.0, 1.5, 2.0};
  const double radius = (options.quick ? 8.0 : 10.0) * d;
  Profile profile(true);
  double total = 0.0, done = 0.0, residual = 0.0;
  for (const double a : aspects) total += 3500.0 * a * (14.0 + 9.0 * std::sqrt(a));
  Progress progress("column", total);
  progress.update(0.0);
  std::vector<Collapse> collapses;
  std::vector<ModelLedger> ledgers;
  for (const double aspect : aspects) {
    Scene column = standingColumn(radius, aspect, profile);
    const auto safe = dem::criticalStep(column);
    const std::string name = "column_" + std::to_string(aspect).substr(0, 3);
    if (!options.out.empty()) writeParticles(options.out, name + "_start", column.time, column.particles, {});
    ledgers.emplace_back(dem::energies(column));
    collapses.push_back(collapse(column, progress, done));
    ledgers.back().set(dem::energies(column));
    residual = std::max(residual, ledgers.back().relativeResidual());
    std::cout << "a = " << collapses.back().aspect << ": " << column.particles.size() << " beads of " << d << " m; ";
    printStep(std::cout, dt, safe, column.particles);
    if (!options.out.empty()) writeParticles(options.out, name, column.time, column.particles, {});
  }
  progress.finish();
  std::cout << "\nenergy of the last run\n"
            << ledgers.back().ledger() << "  largest residual of all runs: " << residual << " of what was lost\n\n"
            << profile;
  const bool good = compare(collapses, options.quick ? 0.30 : 0.20);
  if (!options.out.empty()) write(options, collapses);
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  return runExample(argc, argv, "column",
                    "A column of beads collapses; the run-out is compared with the law of Lube et al.", run);
}
