// A disc of jelly is thrown onto a floor: material points on a grid that is renewed as they travel.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/mpm/fill.hpp"

using namespace dovetail;

constexpr double radius = 0.1, thickness = 0.05, drop = 0.1, pi = 3.14159265358979;  // m
const Vec3 centre{0.0, radius + drop, 0.0}, velocity{0.5, 0.0, 0.0}, g{0.0, -9.81, 0.0};

int main() {
  // 1. Points that fill the disc, four in a cell of the grid; the floor is a border of the grid, along which they
  // slide.
  const mpm::GridOptions grid{.spacing = 0.0125, .borders = {{.axis = 1, .place = 0.0}}};
  const geometry::Box box{centre - Vec3{radius, radius, thickness}, centre + Vec3{radius, radius, thickness}};
  const auto isInside = [](const Vec3& x) { return norm(x - centre) < radius; };
  const auto filled = mpm::fillInside(grid, box, 2, isInside, pi * radius * radius * thickness, velocity);

  // 2. Their material, and a model whose nodes are those of the grid.
  const auto jelly = fem::pointField(fem::pointMaterial(fem::neoHookean(50e3, 0.3, 1000.0)));
  const auto points = mpm::makePoints(filled, jelly, {.grid = grid, .transfer = mpm::Transfer::apic});
  fem::Model model = mpm::makeModel(points);
  model.add(mpm::gravity(points, g));
  fem::addMass(model);
  fem::ExplicitIntegrator run(model, 0.5 * fem::stableStep(model).dt);

  // 3. The fall, the impact and the rebound.
  std::printf("%zu points, %zu nodes\n   t, s   lowest, m   highest, m   renewals\n", filled.x.size(),
              points->rows().nodes());
  double least = 1.0;
  for (int k = 1; k <= 12; ++k) {
    run.runUntil(0.025 * k);
    double lowest = 1.0, highest = 0.0;
    for (const Vec3& x : points->places(model.nodes)) lowest = std::min(lowest, x.y), highest = std::max(highest, x.y);
    least = std::min(least, highest - lowest);
    std::printf("%7.3f %11.4f %12.4f %10lld\n", model.t, lowest, highest, static_cast<long long>(points->renewals()));
  }
  std::cout << run.ledger();

  // 4. It was pressed flat, nothing pushed it aside, and the books close.
  Vec3 momentum;
  double mass = 0.0;
  for (std::size_t n = 0; n < model.nodes.mass.size(); ++n)
    mass += model.nodes.mass[n], momentum += model.nodes.mass[n] * model.nodes.v[n];
  const bool good = least < 1.7 * radius && std::abs(momentum.x / mass - velocity.x) < 1e-9 &&
                    run.ledger().largestResidual() < 1e-2 * mass * 9.81 * drop;
  std::printf("pressed to %.3f m, residual %.1e J: %s\n", least, run.ledger().residual(), good ? "ok" : "OFF");
  return good ? 0 : 1;
}
