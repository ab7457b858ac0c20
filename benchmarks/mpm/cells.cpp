// Steps of grains a second, of cells of discs at material points.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "cases.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/mpm/fill.hpp"
#include "dovetail/rve/deformation_path.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/packing.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using Deformations = std::vector<RowMajor>;

constexpr double side = 0.1;  // m

rve::Rve discs(int count) {
  rve::Rve cell = rve::randomCell({.count = count}, {.modulus = 6e8, .tangential = 0.8, .friction = 0.5});
  rve::compress(cell, {.friction = 0.1, .rest = {.tolerance = 1e-5}});
  rve::relax(cell, {.tolerance = 1e-6});
  return cell;
}

/// Points between borders that go round.
std::shared_ptr<mpm::PointSolid> eddy(const rve::Rve& cell, int across, double speed) {
  mpm::PointOptions options{.grid = {.spacing = side / across, .plane = true}, .transfer = mpm::Transfer::apic};
  for (const int axis : {0, 1})
    for (const bool above : {false, true})
      options.grid.borders.push_back({.axis = axis, .above = above, .place = above ? side : 0.0});
  mpm::MaterialPoints points = mpm::fillBox(options.grid, {{}, {side, side, side}}, 2, {});
  const double k = std::numbers::pi / side;
  for (std::size_t p = 0; p < points.x.size(); ++p) {
    const Vec3& x = points.x[p];
    points.v[p] = speed * Vec3{std::sin(k * x.x) * std::cos(k * x.y), -std::cos(k * x.x) * std::sin(k * x.y), 0.0};
  }
  return mpm::makePoints(points, hierarchical::cellField({cell}, hierarchical::DynamicCells{}), options);
}

Deformations deformationsOf(const mpm::PointSolid& solid) {
  const auto F = solid.answers().F();
  Deformations all(F.size() / 9);
  for (std::size_t p = 0; p < all.size(); ++p) all[p] = Eigen::Map<const RowMajor>(F.data() + 9 * p);
  return all;
}

double stepsBetween(const Deformations& from, const Deformations& to) {
  double sum = 0.0;
  rve::Rve probe;
  for (std::size_t p = 0; p < from.size(); ++p) {
    probe.state.F = from[p];
    const double strain = rve::DeformationPath(probe, to[p]).strain();
    sum += std::max(1.0, std::ceil(strain / hierarchical::DynamicCells{}.strainPerStep));
  }
  return sum;
}

struct Rates {
  double perPoint = 0.0;          ///< steps of the grains a step of the points
  double all = 0.0, alone = 0.0;  ///< millions of steps of grains a second of the processor
};

Rates rates(int count, int across, double speed, int steps) {
  const rve::Rve cell = discs(count);
  const auto solid = eddy(cell, across, speed);
  fem::Model model = mpm::makeModel(solid);
  fem::ExplicitIntegrator run(model, 2e-5, {.energyEvery = 0});
  run.run(2);
  std::vector<Deformations> path{deformationsOf(*solid)};
  double cpu = 0.0, grainSteps = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double start = seconds();
    run.run(1);
    cpu += seconds() - start;
    path.push_back(deformationsOf(*solid));
    grainSteps += stepsBetween(path[path.size() - 2], path.back());
  }
  std::vector<rve::Rve> cells(path[0].size(), cell);
  for (std::size_t p = 0; p < cells.size(); ++p) hierarchical::stepTo(cells[p], path[0][p], {});
  const double start = seconds();
  for (std::size_t k = 1; k < path.size(); ++k)
    for (std::size_t p = 0; p < cells.size(); ++p) hierarchical::stepTo(cells[p], path[k][p], {});
  const double alone = seconds() - start;
  return {grainSteps / steps / static_cast<double>(cells.size()), 1e-6 * grainSteps * count / cpu,
          1e-6 * grainSteps * count / alone};
}

}  // namespace

bool cells(bool quick) {
  const int before = threads(), across = quick ? 4 : 8;
  setThreads(1);
  std::printf(
      "%d points; millions of steps of discs a second of the processor\n\n"
      "| discs a cell | steps of discs a step of points | all included | cells alone |\n|---|---|---|---|\n",
      4 * across * across);
  for (const int count : {100, 400})
    for (const double speed : {0.2, 2.0, 10.0}) {
      const Rates r = rates(count, across, speed, speed > 5.0 ? 8 : 20);
      std::printf("| %d | %.1f | %.1f | %.1f |\n", count, r.perPoint, r.all, r.alone);
      std::fflush(stdout);
    }
  setThreads(before);
  return true;
}

}  // namespace dovetail::benchmark
