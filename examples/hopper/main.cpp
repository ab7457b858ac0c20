// Beads run out of a flat-bottomed silo through a round hole, for several holes. Beverloo's law says how fast.
#include <cstdio>
#include <iostream>

#include "common/beads.hpp"
#include "common/options.hpp"
#include "common/report.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/dem/model/snapshot.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/io/time_series.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::example;
using Scene = dem::Model;

const Beads beads;
const double d = beads.diameter, tau = beads.fallTime(), dt = beads.step();

struct Size {
  double radius, height;  // of the silo and of its filling, m
};

/// Beverloo, Leniger & van de Velde, Chem. Eng. Sci. 15, 1961: W = C ρ_b √g (D − k d)^(5/2).
constexpr double lawC = 0.58, lawK = 1.4;

/// A bottom with a round hole, as a net of triangles between the hole and the wall of the silo. The hole is a polygon
/// of the area of the circle.
dem::MeshWall bottomWithHole(double holeDiameter, double siloRadius) {
  constexpr int corners = 48;
  const double turn = 2.0 * std::numbers::pi / corners;
  const double inner = 0.5 * holeDiameter * std::sqrt(turn / std::sin(turn)), outer = siloRadius + d;
  std::vector<Vec3> x;
  std::vector<geometry::Facet> facets;
  for (const double r : {inner, 0.5 * (inner + outer), outer})
    for (int k = 0; k < corners; ++k) x.push_back({r * std::cos(turn * k), r * std::sin(turn * k), 0.0});
  for (int ring = 0; ring < 2; ++ring)
    for (int k = 0; k < corners; ++k) {
      const int a = ring * corners + k, b = ring * corners + (k + 1) % corners;
      facets.push_back({a, a + corners, b});
      facets.push_back({b, a + corners, b + corners});
    }
  dem::MeshWall bottom;
  bottom.wall = dem::makeWall(std::move(x), std::move(facets));
  bottom.candidates.skin = 0.2 * d;
  return bottom;
}

/// Beads at rest in the closed silo: its first wall is the side, its second the bottom.
Scene filledSilo(const Size& size, Profile& profile) {
  const double r = size.radius;
  Scene silo = emptyModel(beads, SlidingLaw{beads.normal(), beads.tangential()}, profile);
  const double loose = 1.17 * size.height;  // settles to about size.height
  const dem::Packing block = looseBeads(beads, {{{-r, -r, 0.0}, {r, r, loose}}}, 1);
  for (std::size_t i = 0; i < block.centre.size(); ++i)
    if (std::hypot(block.centre[i].x, block.centre[i].y) + block.radius[i] < r)
      dem::addParticle(silo.particles, block.centre[i], {}, block.radius[i], dem::Density{beads.density});
  dem::switchOnRotation(silo.particles);
  for (const auto& wall : {dem::makeCylinder({}, {0, 0, 1}, r), dem::makePlane({}, {0, 0, 1})})
    dem::addWall(silo, wall).skin = 0.2 * d;
  silo.domain = dem::Domain{{{-2 * r, -2 * r, -2 * d}, {2 * r, 2 * r, 2 * loose}}, dem::EscapePolicy::remove};
  dem::run(silo, dt, static_cast<std::int64_t>((4.0 + 0.375 * size.height / d) * tau / dt));
  return silo;
}

/// Mass in the lower half of the filling over its volume, kg/m³.
double bulkDensity(const Scene& silo, const Size& size) {
  double mass = 0.0;
  for (std::size_t i = 0; i < silo.particles.size(); ++i)
    if (const double z = silo.particles.x[i].z; z > 2.0 * d && z < 0.6 * size.height) mass += silo.particles.mass[i];
  return mass / (std::numbers::pi * size.radius * size.radius * (0.6 * size.height - 2.0 * d));
}

/// kg below the bottom, those that have left the scene included.
double discharged(const Scene& silo) {
  double mass = silo.left.mass;
  for (std::size_t i = 0; i < silo.particles.size(); ++i)
    if (silo.particles.x[i].z < 0.0) mass += silo.particles.mass[i];
  return mass;
}

struct Line {
  double slope, offset;
};
Line fitLine(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    n += 1, sx += x[i], sy += y[i], sxx += x[i] * x[i], sxy += x[i] * y[i];
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return {slope, (sy - slope * sx) / n};
}

struct Outflow {
  double hole;                     // m
  double rate = 0.0;               // kg/s, steady
  std::vector<double> time, mass;  // s, kg since the hole was opened
};

/// Continuum fields on the middle plane of the silo, averaged over the steady flow.
struct FlowFields {
  std::vector<Vec3> points;
  cg::TimeMean flow;
  void add(const Scene& now, double duration) {
    const cg::Kernel kernel{cg::KernelShape::lucy, 3, 1.5 * d};
    addFrame(flow, cg::sample(kernel, points, cg::viewOf(dem::takeSnapshot(now))), duration);
  }
};

std::vector<Vec3> middlePlane(const Size& size) {
  const int across = static_cast<int>(2.0 * size.radius / d), up = static_cast<int>(size.height / d);
  return cg::gridPoints({{-0.5 * (across - 1) * d, 0.0, 0.5 * d}, {d, d, d}, {across, 1, up}});
}

/// Opens a hole in a copy of the filled silo and weighs what comes out; `silo` is then as it was at the end.
Outflow openHole(Scene& silo, double hole, double duration, FlowFields& fields, Progress& progress, double& done) {
  dem::removeWall(silo, dem::primitiveWall(silo, 1));  // the closed bottom
  dem::addWall(silo, bottomWithHole(hole, dem::primitiveWall(silo, 0).radius));
  Outflow flow{.hole = hole, .time = {}, .mass = {}};
  const double start = silo.time;
  std::vector<double> steadyTime, steadyMass;
  runAndWatch(silo, dt, duration, 60, [&](const Scene& now) {
    flow.time.push_back(now.time - start);
    flow.mass.push_back(discharged(now));
    if (flow.time.back() > 0.25 * duration) {
      steadyTime.push_back(flow.time.back());
      steadyMass.push_back(flow.mass.back());
      if (!fields.points.empty()) fields.add(now, duration / 60.0);
    }
    progress.update(++done, "hole " + std::to_string(hole / d).substr(0, 3) + " d");
  });
  flow.rate = fitLine(steadyTime, steadyMass).slope;
  return flow;
}

void write(const Options& options, const std::vector<Outflow>& flows, const FlowFields& fields, const Scene& last) {
  const io::KeyValues origin = io::provenance({{"quick", options.quick ? "yes" : "no"}});
  io::TimeSeries series({"hole_m", "time_s", "discharged_kg"}), rates({"hole_m", "rate_kg_per_s"});
  for (const Outflow& flow : flows) {
    rates.append({flow.hole, flow.rate});
    for (std::size_t k = 0; k < flow.time.size(); ++k) series.append({flow.hole, flow.time[k], flow.mass[k]});
  }
  io::writeCsv(options.out / "hopper.csv", series, origin);
  io::writeCsv(options.out / "hopper_rates.csv", rates, origin);
  writeParticles(options.out, "hopper_particles", last.time, last.particles, origin);
  writeFields(options.out, "hopper_fields", fields.points, fields.flow.mean, origin);
}

/// Prints rates beside the law, fits C and k, and says whether all are within their tolerance. The short form weighs
/// too few beads for a fit: there the rates alone count.
bool compare(const std::vector<Outflow>& flows, double density, bool quick) {
  std::vector<double> hole, root;
  double offLaw = 0.0;
  std::printf("\n  hole D/d   rate (g/s)   law, C = %.2f, k = %.1f   ratio\n", lawC, lawK);
  for (const Outflow& flow : flows) {
    const double law = lawC * density * std::sqrt(beads.gravity) * std::pow(flow.hole - lawK * d, 2.5);
    std::printf("  %8.1f %12.3f %24.3f %7.3f\n", flow.hole / d, 1e3 * flow.rate, 1e3 * law, flow.rate / law);
    offLaw = std::max(offLaw, std::abs(flow.rate / law - 1.0));
    hole.push_back(flow.hole);
    root.push_back(std::pow(flow.rate, 0.4));
  }
  const Line line = fitLine(hole, root);
  const double c = std::pow(line.slope, 2.5) / (density * std::sqrt(beads.gravity));
  const double k = -line.offset / line.slope / d;
  double worst = 0.0;  // of the fit, relative
  for (std::size_t i = 0; i < hole.size(); ++i)
    worst = std::max(worst, std::abs(std::pow((line.slope * hole[i] + line.offset) / root[i], 2.5) - 1.0));
  constexpr double toleranceC = 0.08, toleranceK = 0.4, toleranceRate = 0.3;
  const bool good =
      offLaw < toleranceRate && (quick || (std::abs(c - lawC) < toleranceC && std::abs(k - lawK) < toleranceK));
  std::printf("\nfit of rate^(2/5): C = %.3f (law %.2f +- %.2f), k = %.2f (law %.1f +- %.1f)%s\n", c, lawC, toleranceC,
              k, lawK, toleranceK, quick ? ", not asserted" : "");
  std::printf("rates off the fit by up to %.1f %%, off the law by up to %.1f %% (tolerance %.0f %%)\n", 100.0 * worst,
              100.0 * offLaw, 100.0 * toleranceRate);
  std::printf("%s\n", good ? "within the tolerance" : "NOT within the tolerance");
  return good;
}

bool run(const Options& options) {
  if (!options.out.empty())
    io::prepareOutputFolder(options.out,
                            {"hopper.csv", "hopper_rates.csv", "hopper_particles.csv", "hopper_fields.csv"});
  const std::vector<double> holes = options.quick ? std::vector{6.0, 8.0} : std::vector{5.0, 6.0, 7.0, 8.0};
  const Size size = options.quick ? Size{8.0 * d, 9.0 * d} : Size{9.0 * d, 16.0 * d};
  const double duration = (options.quick ? 6.0 : 15.0) * tau;
  Profile profile(true);
  Progress progress("hopper", 60.0 * static_cast<double>(holes.size()));
  progress.update(0.0, "filling");
  const Scene filled = filledSilo(size, profile);
  const double density = bulkDensity(filled, size);
  std::cout << filled.particles.size() << " beads of " << d << " m in a silo of " << 2 * size.radius
            << " m, bulk density " << density << " kg/m3\n";

  std::vector<Outflow> flows;
  std::vector<ModelLedger> ledgers;
  Scene silo;
  FlowFields fields;
  double done = 0.0, residual = 0.0;
  for (const double hole : holes) {
    silo = filled;
    if (!options.out.empty() && hole == holes.back()) fields.points = middlePlane(size);
    ledgers.emplace_back(dem::energies(silo));
    flows.push_back(openHole(silo, hole * d, duration, fields, progress, done));
    ledgers.back().set(dem::energies(silo));
    residual = std::max(residual, ledgers.back().relativeResidual());
  }
  progress.finish();
  printStep(std::cout, dt, dem::criticalStep(silo), silo.particles);
  std::cout << "\nenergy of the last run\n"
            << ledgers.back().ledger() << "  largest residual of all runs: " << residual << " of what was lost\n\n"
            << profile;
  const bool good = compare(flows, density, options.quick);
  if (!options.out.empty()) write(options, flows, fields, silo);
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  return runExample(argc, argv, "hopper", "Beads run out of a silo; the rate is compared with Beverloo's law.", run);
}
