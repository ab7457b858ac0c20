// Waves in a string of discs, by solids of 40 to 400 elements whose cells are strings, beside the chain of all discs.
// Bonds in place of contacts: waves pull by more than contacts hold. Their bending, which a straight row does not feel,
// keeps it from buckling sideways out of round-off.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "figure.hpp"
#include "wave_records.hpp"

namespace dovetail::benchmark {

namespace {

// Liu 2018, Table 4.1.
constexpr double stiffness = 1e4, spacing = 2.2e-3, thickness = 1e-3;  // N/m, m
constexpr double mass = 2e3 * std::numbers::pi * 0.25 * spacing * spacing * thickness;
constexpr int discs = 400;
constexpr double amplitude = 1.8e-3, end = 9e-3, dt = 5e-6;  // m, s

/// Of the right end: towards the others and back.
double driven(double t, double period) {
  return t < 0.5 * period ? -amplitude * std::sin(2.0 * std::numbers::pi * t / period) : 0.0;
}

/// Five discs in a row that repeats, bonded.
rve::Rve rowOfDiscs() {
  rve::Grains grains;
  for (int i = 0; i < 5; ++i) grains.centre.push_back({spacing * (i + 0.5), 0.0, 0.0});
  const double radius = 0.501 * spacing;  // they touch, and press by 0.2 % of the spacing
  grains.radius.assign(grains.centre.size(), radius);
  grains.density = mass / (std::numbers::pi * radius * radius * thickness);
  rve::Rve row = rve::makeRve(
      grains, {{Vec3{5 * spacing, 0, 0}, Vec3{0, 5 * spacing, 0}, Vec3{0, 0, thickness}}, {true, true, false}},
      {.stiffness = stiffness, .tangential = 0.0, .friction = 0.0});
  rve::bond(row, {.normal = stiffness, .shear = stiffness, .bending = stiffness * spacing * spacing});
  return row;
}

/// Displacements at two probes at the ends of all steps, m.
struct Record {
  std::vector<double> near, far;
};

Record chain(double period) {
  std::vector<double> u(discs + 1), v(discs + 1), f(discs + 1);
  Record record;
  const auto forces = [&] {
    for (int i = 1; i < discs; ++i)
      f[static_cast<std::size_t>(i)] =
          stiffness * (u[static_cast<std::size_t>(i + 1)] - 2.0 * u[static_cast<std::size_t>(i)] +
                       u[static_cast<std::size_t>(i - 1)]);
  };
  const auto kick = [&] {
    for (std::size_t i = 1; i < discs; ++i) v[i] += 0.5 * dt / mass * f[i];
  };
  for (int k = 1; k <= std::lround(end / dt); ++k) {
    kick();
    for (std::size_t i = 1; i < discs; ++i) u[i] += dt * v[i];
    u[discs] = driven(dt * k, period);
    forces();
    kick();
    record.near.push_back(u[discs - 10]);
    record.far.push_back(u[discs - 50]);
  }
  return record;
}

Record solid(int elements, double period) {
  const double length = discs * spacing, height = 5 * spacing;
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::quad4, {elements, 1, 1}, {}, {length, height, thickness});
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(mesh, hierarchical::cellField({rowOfDiscs()}, hierarchical::DynamicCells{})));
  fem::addMass(model);
  model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
  model.constraints.hold(fem::nodeSet(mesh, "y-"), fem::componentY);
  model.constraints.hold(fem::nodeSet(mesh, "y+"), fem::componentY);
  model.constraints.prescribe(fem::nodeSet(mesh, "x+"), 0, [period](double t) { return driven(t, period); });
  const auto nodeAt = [&](double x) {
    const std::vector<int>& row = fem::nodeSet(mesh, "y-");
    return static_cast<std::size_t>(
        *std::ranges::min_element(row, {}, [&](int n) { return std::abs(mesh.X[static_cast<std::size_t>(n)].x - x); }));
  };
  const std::size_t near = nodeAt(length - 10 * spacing), far = nodeAt(length - 50 * spacing);
  fem::ExplicitIntegrator run(model, dt, {.energyEvery = 0});
  Record record;
  for (int k = 1; k <= std::lround(end / dt); ++k) {
    run.step();
    record.near.push_back(model.nodes.u[near].x);
    record.far.push_back(model.nodes.u[far].x);
  }
  return record;
}

double timeOfPeak(const std::vector<double>& u) {
  const auto least = std::ranges::min_element(u);
  const double a = *(least - 1), b = *least, c = *(least + 1);
  return dt * (1.0 + static_cast<double>(least - u.begin()) + 0.5 * (a - c) / (a - 2.0 * b + c));
}

}  // namespace

FigureRows stringOfDiscs(bool quick) {
  FigureRows rows;
  const double long_ = 5e-3;
  const Record all = chain(long_);
  const double printed[] = {6.3, 3.2, 1.1};
  Record finest;
  int k = 0;
  for (const int elements : {40, 80, 200}) {
    const std::string name = ", " + std::to_string(elements) + " elements, %";
    finest = solid(elements, long_);
    rows.push_back(
        {"error 110 mm from the end" + name, difference(finest.far, all.far), 0.0, printed[k++], 0.1, "derived here"});
  }
  finest = solid(400, long_);
  rows.push_back({"error 110 mm from the end, 400 elements, %", difference(finest.far, all.far), 0.0, 0.0, 1e-8,
                  "each element is a disc and a spring"});
  rows.push_back({"wave speed, m/s", 40 * spacing / (timeOfPeak(finest.far) - timeOfPeak(finest.near)), 0.0, 79.8, 0.4,
                  "between probes, of the peak; printed: 80"});
  for (const double period : {0.5e-3, 1e-3, 2e-3})
    if (!quick)
      rows.push_back({"the same for T = " + std::to_string(1e3 * period).substr(0, 3) + " ms, 400 elements, %",
                      difference(solid(400, period).far, chain(period).far), 0.0, 0.0, 1e-8});
  return rows;
}

}  // namespace dovetail::benchmark
