// Throughput, scaling, threads and leaving out.
#include <cmath>
#include <functional>
#include <ostream>

#include "common/outputs.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/report/text.hpp"
#include "measure.hpp"
#include "scenes.hpp"
#include "studies.hpp"
#include "tables.hpp"

namespace dovetail::dem_benchmark {

namespace {

using report::format;

Spheres bedOf(const Settings& s) {
  if (!s.bed.empty()) return readSpheres(s.bed);
  return settledBed(20, s.quick ? 4 : 50);
}

Spheres polydisperse(const Settings& s) {
  return s.quick ? bigAmongSmall(24.0, 4, 10.0, 1) : bigAmongSmall(44.0, 50, 10.0, 1);
}

geometry::Periodicity cube(double edge) { return {{{0, 0, 0}, {edge, edge, edge}}, {true, true, true}}; }

/// The bed in an open box a little wider than itself; let fall against the walls first.
template <class Walls>
dem::Model boxModel(const Settings& s, const Spheres& bed, const Walls& walls) {
  constexpr double edge = 21.0;
  Spheres inside = bed;
  for (Vec3& x : inside.x) x += Vec3{0.5, 0.5, 0.0};
  auto model = makeModel(inside, frictionalLaw(), {}, {0, 0, -1});
  walls(model, edge);
  auto& damping = dem::damping(model);
  damping.viscousRate = 2.0;
  run(model, timeStep, s.quick ? 100 : 4000);
  model.terms.remove(damping);
  return model;
}

/// Planes and triangles turn by turn; cost of the latter over the former, median of the turns.
double compareBoxes(const Settings& s, const Spheres& bed, Table& table) {
  auto planes = boxModel(s, bed, [](auto& m, double edge) {
    for (auto& wall : boxOfPlanes(edge, listSkin)) dem::addWall(m, wall);
  });
  auto triangles =
      boxModel(s, bed, [](auto& m, double edge) { dem::addWall(m, boxOfTriangles(edge, 50.0, 23, listSkin)); });
  std::vector<double> costs;
  Figures first, second;
  std::vector<double> ratesFirst, ratesSecond;
  for (int turn = 0; turn < 2 * s.repeats + 1; ++turn) {
    first = measure("box of 5 planes", planes, timeStep, 0, s.steps, 1);
    second = measure("box of 11 000 triangles", triangles, timeStep, 0, s.steps, 1);
    ratesFirst.push_back(first.rates.median);
    ratesSecond.push_back(second.rates.median);
    costs.push_back(first.rates.median / second.rates.median - 1.0);
  }
  first.rates = ratesOf(ratesFirst);
  second.rates = ratesOf(ratesSecond);
  table.add(first);
  table.add(second);
  std::sort(costs.begin(), costs.end());
  return costs[costs.size() / 2];
}

}  // namespace

void studyThroughput(const Settings& s, std::ostream& out) {
  setThreads(s.threads);
  Table table{out, {}};
  table.header();
  const Spheres bed = bedOf(s), wide = s.quick ? bed : repeated(bed, 5, 20.0);
  const double width = s.quick ? 20.0 : 100.0;
  {
    auto model = bedModel(wide, frictionalLaw(), width);
    table.add(measure("bed, linear + friction", model, timeStep, 3 * s.warmUp, s.steps, s.repeats));
    model.booking = dem::Booking::on;
    table.add(measure("the same, energies booked", model, timeStep, 10, s.steps, s.repeats));
  }
  {
    auto model = bedModel(wide, hertzLaw(), width);
    table.add(measure("bed, Hertz-Mindlin", model, timeStep, 3 * s.warmUp, s.steps, s.repeats));
  }
  {
    auto model = waveLattice(50, 50, s.quick ? 4 : 40);
    table.add(measure("lattice, frictionless", model, timeStep, s.warmUp, s.steps, s.repeats));
  }
  {
    auto model = makeModel(polydisperse(s), frictionalLaw(), cube(s.quick ? 24.0 : 44.0), {});
    table.add(measure("1:10, list made every 50 steps", model, timeStep, 100, s.steps, s.repeats, 50));
  }
  out << format("\ntriangles instead of planes, turn by turn: %+.1f %% per step\n",
                100.0 * compareBoxes(s, bed, table));
  const double triad = triadBandwidth(s.threads);
  out << format("triad: %.1f GB/s; the bed moves %.1f GB/s (%.0f %%), the lattice %.1f GB/s (%.0f %%)\n", triad,
                1e-3 * table.rows[0].bytesMoved * table.rows[0].rates.median,
                0.1 * table.rows[0].bytesMoved * table.rows[0].rates.median / triad,
                1e-3 * table.rows[3].bytesMoved * table.rows[3].rates.median,
                0.1 * table.rows[3].bytesMoved * table.rows[3].rates.median / triad);
  writeSummary(s, table.rows, triad);
}

void studyLeavingOut(const Settings& s, std::ostream& out) {
  Table table{out, {}};
  table.header();
  const int nz = s.quick ? 4 : 40;
  const auto time = [&](const std::string& name, auto&& change) {
    auto model = waveLattice(50, 50, nz);
    change(model);
    return table.add(measure(name, model, timeStep, 50, s.steps, s.repeats)).nanoseconds();
  };
  const double bare = time("frictionless lattice", [](auto&) {});
  const double again = time("the same again", [](auto&) {});
  const double wall = time("with a wall that nobody touches", [](auto& m) {
    dem::addWall(m, dem::makeSphere({}, 0.1, false)).skin = listSkin;  // between the spheres of the lattice
  });
  const double booked = time("with energies booked", [](auto& m) { m.booking = dem::Booking::on; });
  const double damped = time("with viscous damping", [](auto& m) { dem::damping(m).viscousRate = 1e-6; });
  // Without overlap and at rest: an open lattice of squeezed spheres would fly apart.
  const auto still = [&](const std::string& name, bool periodic) {
    auto model = makeModel(lattice(50, 50, nz, 1.0), dem::ElasticLaw{{stiffness}},
                           {{{0, 0, 0}, {50, 50, double(nz)}}, {periodic, periodic, periodic}}, {});
    return table.add(measure(name, model, timeStep, 50, s.steps, s.repeats));
  };
  const Figures closed = still("at rest, periodic", true), open = still("at rest, without periodicity", false);
  const auto perPair = [](const Figures& f) {
    return f.nanoseconds() * static_cast<double>(f.particles) / static_cast<double>(f.pairs);
  };
  auto frictional = makeModel(lattice(50, 50, nz, 1.01), frictionalLaw(),
                              {{{0, 0, 0}, {50, 50, double(nz)}}, {true, true, true}}, {});
  const double friction =
      table.add(measure("with friction and spin", frictional, timeStep, 50, s.steps, s.repeats)).nanoseconds();
  const auto cost = [&](double ns) { return 100.0 * (ns / std::min(bare, again) - 1.0); };
  out << format(
      "\ncost over the bare lattice: the same again %+.1f %%, idle wall %+.1f %%, booking %+.1f %%, damping %+.1f %%, "
      "friction %+.1f %%\n",
      cost(std::max(bare, again)), cost(wall), cost(booked), cost(damped), cost(friction));
  out << format("periodicity: %+.1f %% per pair\n", 100.0 * (perPair(closed) / perPair(open) - 1.0));
  out << format("bytes held per particle: %.0f without friction, %.0f with\n", table.rows[0].bytesHeld,
                table.rows.back().bytesHeld);
  writeSummary(s, table.rows, 0.0);
}

void studyScaling(const Settings& s, std::ostream& out) {
  Table table{out, {}};
  table.header();
  // One tenth of the volume in big spheres, the rest a lattice of small ones.
  std::vector<double> edges = s.quick ? std::vector<double>{22.0} : std::vector<double>{22.0, 46.0, 100.0};
  for (const double edge : edges) {
    const int bigOnes = std::max(1, static_cast<int>(0.3 * edge * edge * edge / 1000.0));
    auto model = makeModel(bigAmongSmall(edge, bigOnes, 10.0, 1), frictionalLaw(), cube(edge), {});
    table.add(measure("ratio 10", model, timeStep, 20, s.steps / 2, s.repeats));
  }
  const double edge = s.quick ? 24.0 : 48.0;
  for (const double ratio : {1.0, 10.0, 100.0}) {
    // The same lattice of small spheres; the others stand in for the same number of contacts or fewer.
    auto small = lattice(int(edge), int(edge), int(edge), 1.02);
    Spheres all;
    const Vec3 centre{0.5 * edge, 0.5 * edge, 0.5 * edge - 0.45 * ratio};
    for (std::size_t i = 0; i < small.size(); ++i)
      if (ratio == 1.0 || norm(small.x[i] - centre) > 0.5 * ratio + 0.5) {
        all.x.push_back(small.x[i]);
        all.diameter.push_back(1.02);
      }
    if (ratio > 1.0) {
      all.x.push_back(centre);
      all.diameter.push_back(ratio);
    }
    auto model = makeModel(all, frictionalLaw(), {}, {});
    table.add(measure(format("ratio %.0f, one big sphere", ratio), model, timeStep, 20, s.steps / 2, s.repeats, 50));
  }
  const auto perContact = [&](std::size_t row) {
    const Figures& f = table.rows[row];
    return f.nanoseconds() * static_cast<double>(f.particles) / static_cast<double>(f.pairs);
  };
  const std::size_t n = edges.size();
  out << format("\ncost per particle step, largest over smallest number: %.2f\n",
                table.rows[n - 1].nanoseconds() / table.rows[0].nanoseconds());
  out << format("cost per pair, ratio 100 over ratio 1: %.2f\n", perContact(n + 2) / perContact(n));
  writeSummary(s, table.rows, 0.0);
}

void studyThreads(const Settings& s, std::ostream& out) {
  Table table{out, {}};
  table.header();
  const Spheres bed = bedOf(s), wide = s.quick ? bed : repeated(bed, 5, 20.0);
  auto model = bedModel(wide, frictionalLaw(), s.quick ? 20.0 : 100.0);
  run(model, timeStep, 3 * s.warmUp);
  for (const int count : {1, 2}) {
    setThreads(count);
    table.add(
        measure(format("bed, %d thread%s", count, count > 1 ? "s" : ""), model, timeStep, 10, s.steps, s.repeats));
  }
  for (const int count : {1, 2}) {
    setThreads(count);
    auto wave = waveLattice(50, 50, s.quick ? 4 : 40);
    table.add(
        measure(format("lattice, %d thread%s", count, count > 1 ? "s" : ""), wave, timeStep, 50, s.steps, s.repeats));
  }
  setThreads(1);
  const double one = triadBandwidth(1), two = triadBandwidth(2);
  for (std::size_t row : {1u, 3u})
    out << format("%s over one: %.2f; %.1f GB/s of the triad's %.1f (one thread: %.1f)\n", table.rows[row].name.c_str(),
                  table.rows[row].rates.median / table.rows[row - 1].rates.median,
                  1e-3 * table.rows[row].bytesMoved * table.rows[row].rates.median, two, one);
  writeSummary(s, table.rows, two);
}

void writeScenes(const Settings& s, std::ostream& out) {
  benchmark::underName("--write", [&] {
    return io::prepareOutputFolder(s.write, {"bed.txt", "bed.data", "poly.txt", "poly.data", "drum.txt", "drum.data"});
  });
  const Spheres bed = bedOf(s);
  double top = 0.0;
  for (const Vec3& x : bed.x) top = std::max(top, x.z);
  writeSpheres(s.write / "bed.txt", bed);
  writeLammpsData(s.write / "bed.data", bed, {{0, 0, 0}, {20, 20, std::ceil(top) + 2.0}});
  const Spheres mixed = polydisperse(s);
  const double edge = s.quick ? 24.0 : 44.0;
  writeSpheres(s.write / "poly.txt", mixed);
  writeLammpsData(s.write / "poly.data", mixed, cube(edge).box);
  Spheres drum = s.quick ? Spheres{} : flowingDrum();
  if (!s.quick) {
    writeSpheres(s.write / "drum.txt", drum);
    constexpr double r = drumRadius + 1.0;
    writeLammpsData(s.write / "drum.data", drum, {{-r, -r, 0}, {r, r, drumWidth}});
  }
  out << bed.size() << " spheres in bed.txt and bed.data, " << mixed.size() << " in poly.txt and poly.data, "
      << drum.size() << " in drum.txt and drum.data, in " << s.write.string() << '\n';
}

}  // namespace dovetail::dem_benchmark
