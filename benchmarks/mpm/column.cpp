// A column under its weight, damped until it stands: which numbers of points in a cell stand still.
#include <cmath>
#include <cstdio>
#include <vector>

#include "cases.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double height = 1.0, width = 0.5, g = 9.81, youngs = 1e5, poisson = 0.3;

enum class Sides { held, free };

/// Mean settlement of quad8 elements, in statics.
double settledElements(Sides sides) {
  const fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::quad8, {16, 32, 1}, {}, {width, height, 1.0});
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(mesh, fem::pointMaterial(fem::neoHookean(youngs, poisson, density))));
  fem::Term& weight = model.add(fem::gravity({0.0, -g, 0.0}));
  model.constraints.hold(fem::nodeSet(mesh, "y-"), fem::componentY);
  model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
  if (sides == Sides::held) model.constraints.hold(fem::nodeSet(mesh, "x+"), fem::componentX);
  fem::addMass(model);
  const double before = weight.energy(model.nodes, {});
  fem::solveStatics(model, 1.0, {.firstStep = 1.0});
  return (before - weight.energy(model.nodes, {.t = 1.0})) / (density * width * height * g);
}

struct Setting {
  Sides sides;
  double perCell;  ///< along an axis
  mpm::Shape shape;
  mpm::Transfer transfer;
};

/// Mean settlement at 0.4, 0.8 … 2 s. @param renewals  in the last 0.4 s
std::vector<double> settlements(const Setting& set, std::int64_t& renewals) {
  const double distance = width / 12.0, spacing = set.perCell * distance;
  const mpm::MaterialPoints points = box({}, width, height, distance);
  std::vector<mpm::GridBorder> borders{{.axis = 1}};
  if (set.sides == Sides::held) {
    borders.push_back({.axis = 0});
    borders.push_back({.axis = 0, .above = true, .place = width});
  }
  const auto solid = mpm::makePoints(
      points, neoHookeanField(youngs, poisson),
      {.grid = {.spacing = spacing, .shape = set.shape, .borders = borders, .gimpHalf = 0.5 / set.perCell},
       .transfer = set.transfer});
  fem::Model model = mpm::makeModel(solid);
  model.add(mpm::gravity(solid, {0.0, -g, 0.0}));
  model.add(fem::massDamping(18.0));  // half of what is critical in the first mode
  fem::addMass(model);
  fem::ExplicitIntegrator run(model, 0.5 * fem::stableStep(model).dt, {.energyEvery = 0});
  std::vector<double> settled;
  for (int k = 1; k <= 5; ++k) {
    renewals = solid->renewals();
    run.runUntil(0.4 * k);
    double sum = 0.0;
    const std::vector<Vec3> x = solid->places(model.nodes);
    for (std::size_t p = 0; p < x.size(); ++p) sum += points.x[p].y - x[p].y;
    settled.push_back(sum / static_cast<double>(x.size()));
  }
  renewals = solid->renewals() - renewals;
  return settled;
}

/// @return whether it stands still in the last 0.4 s, or is refused
bool show(const Setting& set, double exact) {
  std::printf("| %s | %.1f² | %s | %s |", set.sides == Sides::held ? "held" : "free", set.perCell, nameOf(set.transfer),
              name(set.shape));
  std::int64_t renewals = 0;
  try {
    const std::vector<double> all = settlements(set, renewals);
    for (const double one : all) std::printf(" %.4f |", one / exact);
    const double change = all[4] / all[3] - 1.0;
    std::printf(" %+.4f | %ld |\n", 100.0 * change, static_cast<long>(renewals));
    return std::abs(change) < 1e-3;
  } catch (const InputError&) {
    std::printf(" refused | | | | | | |\n");
    return set.perCell < std::sqrt(2.0);
  }
}

}  // namespace

bool column(bool quick) {
  bool holds = true;
  std::printf(
      "Mean settlement over that of quad8 elements\n\n"
      "| sides | points a cell | transfer | shape | 0.4 s | 0.8 s | 1.2 s | 1.6 s | 2 s | last change, %% | renewals "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Sides sides : {Sides::held, Sides::free}) {
    const double exact = settledElements(sides);
    for (const double perCell : {1.0, 1.2, 1.5, 2.0, 3.0})
      for (const mpm::Transfer transfer : {mpm::Transfer::flip, mpm::Transfer::apic})
        for (const mpm::Shape shape : {mpm::Shape::quadratic, mpm::Shape::cubic, mpm::Shape::gimp}) {
          if (transfer == mpm::Transfer::apic && mpm::secondMoment(shape) == 0.0) continue;
          if (quick && (transfer == mpm::Transfer::apic || perCell == 3.0)) continue;
          holds = show({sides, perCell, shape, transfer}, exact) && holds;
          std::fflush(stdout);
        }
  }
  return holds;
}

}  // namespace dovetail::benchmark
