// Waves in strips of regular and of random discs, with bonds and without, by solids whose cells are a tile of the
// strip, beside the strip of all discs.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/packing.hpp"
#include "figure.hpp"
#include "tiles.hpp"
#include "wave_records.hpp"

namespace dovetail::benchmark {

namespace {

// Liu 2018, Table 4.1.
constexpr double stiffness = 1e4, thickness = 1e-3, period = 5e-3;  // N/m, m, s
constexpr double dt = 1e-5;                                         // s, of the solid and of the records

struct Strip {
  bool bonded = true;
  bool regular = false;    ///< a triangular lattice, of which one packing is all
  double pressure = 1.0;   ///< of the cells, N/m over k_n in %
  double amplitude = 0.0;  ///< of the driven end, m
  int tiles = 40;          ///< that move; each is a cell of 228 discs, 30 mm × 30 mm
  double end = 9e-3;       ///< s
};

rve::BondLaw bonds() { return {.normal = stiffness, .shear = 0.4 * stiffness}; }

/// 16 columns of 14 equal discs, which touch all round, and overlap by as much as the pressure asks for.
rve::Rve regularTile(double pressure) {
  constexpr int columns = 16, rows = 14;
  constexpr double radius = 1.1e-3;
  // A triangular lattice of overlaps δ presses with √3 k_n δ/d over the thickness.
  const double pitch = 2.0 * radius * (1.0 - pressure * thickness / (std::numbers::sqrt3 * stiffness));
  const double across = 0.5 * std::numbers::sqrt3 * pitch;
  rve::Grains grains{.density = 2000.0};
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) grains.centre.push_back({across * i, pitch * (j + 0.5 * (i % 2)), 0.0});
  grains.radius.assign(grains.centre.size(), radius);
  return rve::makeRve(
      grains, {{Vec3{across * columns, 0, 0}, Vec3{0, pitch * rows, 0}, Vec3{0, 0, thickness}}, {true, true, false}},
      {.stiffness = stiffness, .tangential = 0.0, .friction = 0.0});
}

/// Discs of the sizes that fill 0.85 of 30 mm × 30 mm, made without friction; without bonds they only press.
rve::Rve randomTile(double pressure, std::uint64_t seed) {
  rve::Rve cell = rve::randomCell({.count = 228,
                                   .sizes = dem::UniformSizes{0.82e-3, 1.23e-3},
                                   .thickness = thickness,
                                   .density = 2000.0,
                                   .seed = seed},
                                  {.stiffness = stiffness, .tangential = 0.0, .friction = 0.0});
  rve::compress(cell, {.pressure = {pressure, pressure, 0.0}, .friction = 0.0, .rest = {.tolerance = 1e-5}});
  return cell;
}

rve::Rve tile(const Strip& strip, std::uint64_t seed) {
  const double pressure = 0.01 * strip.pressure * stiffness / thickness;
  rve::Rve cell = strip.regular ? regularTile(pressure) : randomTile(pressure, seed);
  if (strip.bonded) rve::bond(cell, bonds());
  return cell;
}

double driven(double t, double amplitude) {
  return t < 0.5 * period ? -amplitude * std::sin(2.0 * std::numbers::pi * t / period) : 0.0;
}

/// Displacements of two sections, 30 and 300 mm from the driven end, at the ends of all steps, m.
struct Record {
  std::vector<double> near, far;
};

/// Tiles side by side that repeat upwards, with a rigid one at either end and a gap between these.
rve::Rve sideBySide(const rve::Rve& cell, int tilesInAll, bool bonded) {
  geometry::Lattice lattice = cell.state.lattice;
  lattice.period[0] = (tilesInAll + 0.2) * lattice.period[0];
  rve::Rve strip = rve::makeRve(tiles(cell, tilesInAll, 1), lattice, cell.springs);
  if (bonded) rve::bond(strip, bonds());
  constexpr double rigid = 1e30;
  for (std::size_t i = 0; i < cell.size(); ++i)
    for (const std::size_t g : {i, strip.size() - 1 - i}) strip.mass[g] = strip.inertia[g] = rigid;
  return strip;
}

Record allDiscs(const Strip& strip, const rve::Rve& cell) {
  rve::Rve discs = sideBySide(cell, strip.tiles + 2, strip.bonded);
  const double length = cell.state.lattice.period[0].x, load = length * (strip.tiles + 1);
  const std::vector<double> X = discs.state.x[0];
  const std::size_t first = discs.size() - cell.size();
  const auto meanAt = [&](double section) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < discs.size(); ++i)
      if (std::abs(X[i] - section) < 3e-3) sum += discs.state.x[0][i] - X[i], ++count;
    return sum / count;
  };
  const auto parts = static_cast<int>(std::ceil(dt / (0.8 * discs.state.criticalStep)));
  Record record;
  for (int k = 0; k < std::lround(strip.end / dt); ++k) {
    const double v = (driven(dt * (k + 1), strip.amplitude) - driven(dt * k, strip.amplitude)) / dt;
    std::fill(discs.state.v[0].begin() + static_cast<std::ptrdiff_t>(first), discs.state.v[0].end(), v);
    for (int part = 0; part < parts; ++part) rve::step(discs, dt / parts);
    record.near.push_back(meanAt(load - 0.03));
    record.far.push_back(meanAt(load - 0.3));
  }
  return record;
}

Record solidOfCells(const Strip& strip, const rve::Rve& cell, int elements) {
  const double length = strip.tiles * cell.state.lattice.period[0].x, height = cell.state.lattice.period[1].y;
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::quad4, {elements, 1, 1}, {}, {length, height, thickness});
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(
      mesh, hierarchical::cellField({cell}, hierarchical::DynamicCells{.strainPerStep = 1e-4, .damping = 0.0})));
  fem::addMass(model);
  model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
  const std::vector<int>&bottom = fem::nodeSet(mesh, "y-"), &top = fem::nodeSet(mesh, "y+");
  for (const std::vector<int>* row : {&bottom, &top}) model.constraints.hold(*row, fem::componentY);
  // The strip repeats upwards, and so does what shears it.
  for (const int node : top) {
    const double x = mesh.X[static_cast<std::size_t>(node)].x;
    const int below = *std::ranges::min_element(
        bottom, {}, [&](int n) { return std::abs(mesh.X[static_cast<std::size_t>(n)].x - x); });
    if (x > 1e-9 * length && x < (1.0 - 1e-9) * length)
      model.constraints.ties.push_back({node, 0, {{below, 0, 1.0}}, 0.0, {}});
  }
  model.constraints.prescribe(fem::nodeSet(mesh, "x+"), 0, [&](double t) { return driven(t, strip.amplitude); });
  const auto nodeAt = [&](double x) {
    return static_cast<std::size_t>(*std::ranges::min_element(
        bottom, {}, [&](int n) { return std::abs(mesh.X[static_cast<std::size_t>(n)].x - x); }));
  };
  const std::size_t near = nodeAt(length - 0.03), far = nodeAt(length - 0.3);
  fem::ExplicitIntegrator run(model, dt, {.energyEvery = 0});
  Record record;
  for (int k = 0; k < std::lround(strip.end / dt); ++k) {
    run.step();
    record.near.push_back(model.nodes.u[near].x);
    record.far.push_back(model.nodes.u[far].x);
  }
  return record;
}

/// When a section has moved half of its way, s.
double arrival(const std::vector<double>& u) {
  const double half = 0.5 * *std::ranges::min_element(u);
  const auto at = std::ranges::find_if(u, [half](double value) { return value < half; });
  const double before = at == u.begin() ? 0.0 : *(at - 1);
  return dt * (static_cast<double>(at - u.begin()) + (half - before) / (*at - before));
}

/// Rows of one kind of strip: misfits by the number of elements, scatter of strips of other packings.
FigureRows rowsOf(const std::string& name, const Strip& strip, const std::vector<int>& meshes, std::size_t packings,
                  bool judged) {
  std::vector<Record> discs(packings);
  std::vector<std::vector<double>> misfits(meshes.size(), std::vector<double>(packings));
  std::vector<double> late(packings), scatter(packings);
  parallelTasks(packings, [&](std::size_t s) {
    const rve::Rve cell = tile(strip, s + 1);
    discs[s] = allDiscs(strip, cell);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      const Record solid = solidOfCells(strip, cell, meshes[m]);
      misfits[m][s] = difference(solid.far, discs[s].far);
      late[s] = 100.0 * (arrival(solid.far) / arrival(discs[s].far) - 1.0);
    }
  });
  std::vector<double> mean(discs[0].far.size(), 0.0);
  for (const Record& record : discs)
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += record.far[k] / static_cast<double>(packings);
  for (std::size_t s = 0; s < packings; ++s) scatter[s] = difference(discs[s].far, mean);
  FigureRows rows;
  if (packings > 1)
    rows.push_back(rowOf(name + ": strips of other packings differ from their mean by, %", scatter, std::nan(""), 0.0));
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const bool isFinest = judged && packings > 1 && m + 1 == meshes.size();
    rows.push_back(rowOf(name + ": misfit 300 mm from the end, " + std::to_string(meshes[m]) + " elements, %",
                         misfits[m], isFinest ? 0.0 : std::nan(""), isFinest ? rows[0].here : 0.0,
                         isFinest ? "below that scatter" : ""));
  }
  rows.push_back(rowOf(name + ": the solid of the finest mesh is late by, %", late, judged ? 0.0 : std::nan(""), 0.5));
  return rows;
}

}  // namespace

FigureRows strips(bool quick) {
  const std::vector<int> meshes = quick ? std::vector{40, 80} : std::vector{40, 80, 160, 320};
  const std::size_t packings = quick ? 2 : 4;
  FigureRows rows;
  const auto add = [&](const std::string& name, const Strip& strip, bool judged) {
    for (const FigureRow& row : rowsOf(name, strip, meshes, strip.regular ? 1 : packings, judged)) rows.push_back(row);
  };
  add("bonded, regular", {.regular = true, .pressure = 1e-4, .amplitude = 5e-3}, !quick);
  add("bonded", {.amplitude = 5e-3}, !quick);
  const Strip pressed{.bonded = false, .pressure = 0.1, .amplitude = 1.8e-3, .tiles = 26};
  Strip regular = pressed, more = pressed, gentle = pressed;
  regular.regular = true;
  more.pressure = gentle.pressure = 5.0;
  gentle.amplitude *= 0.01;
  add("without bonds, regular", regular, false);
  add("without bonds", pressed, false);
  add("without bonds, pressed before", more, false);
  add("the same, a hundredth of the amplitude", gentle, false);
  return rows;
}

}  // namespace dovetail::benchmark
