// Two elastic discs that collide on one grid (Sulsky, Chen & Schreyer 1994, Comput. Methods Appl. Mech. Engng 118,
// 179-196).
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cases.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double radius = 0.2, youngs = 1000.0, poisson = 0.3, pace = 0.1, end = 3.6;  // m, Pa, m/s of x and y, s
constexpr double near = 0.2, far = 0.8;                                                // centres

struct Answer {
  double restitution = 0.0, least = 0.0, met = 0.0;  ///< velocities after over before; kinetic energy; s
  double lost = 0.0, residual = 0.0;                 ///< by renewals, of the ledger; over the energy at the start
  double momentum = 0.0, turning = 0.0;              ///< drift over Σ m |v|, and over that times the radius
};

mpm::MaterialPoints twoDiscs(double distance) {
  mpm::MaterialPoints points;
  for (const double centre : {near, far}) {
    const Vec3 corner{centre - radius, centre - radius, 0.0};
    const mpm::MaterialPoints square = box(corner, 2.0 * radius, 2.0 * radius, distance);
    for (const Vec3& x : square.x) {
      if (squaredNorm(x - Vec3{centre, centre, 0.0}) > radius * radius) continue;
      points.x.push_back(x);
      points.v.push_back((centre < 0.5 ? pace : -pace) * Vec3{1.0, 1.0, 0.0});
      points.volume.push_back(distance * distance);
    }
  }
  return points;
}

/// Of the centres of the discs to each other, along the diagonal.
double separation(const std::vector<Vec3>& x) {
  Vec3 sum;
  const std::size_t half = x.size() / 2;
  for (std::size_t p = 0; p < x.size(); ++p) sum += (p < half ? -1.0 : 1.0) / static_cast<double>(half) * x[p];
  return (sum.x + sum.y) / std::sqrt(2.0);
}

Answer collide(int cells, mpm::Shape shape, mpm::Transfer transfer) {
  const double spacing = 1.0 / cells;
  const auto solid = mpm::makePoints(twoDiscs(0.5 * spacing), neoHookeanField(youngs, poisson),
                                     {.grid = {.spacing = spacing, .shape = shape}, .transfer = transfer});
  fem::Model model = mpm::makeModel(solid);
  fem::addMass(model);
  const double dt = end / std::ceil(end / (0.5 * fem::stableStep(model).dt));
  fem::ExplicitIntegrator run(model, dt);
  const Vec3 momentum = fem::momentum(model.nodes), turning = fem::angularMomentum(model.nodes);
  const double kinetic = run.kineticEnergy();
  double mass = 0.0;
  for (const double m : solid->masses()) mass += m;
  Answer answer{.least = 1.0};
  double before = separation(solid->places(model.nodes)), rate = 0.0;
  const double scale = mass * pace * std::sqrt(2.0);
  while (model.t < end - 0.5 * dt) {
    run.step();
    const double now = separation(solid->places(model.nodes));
    rate = (now - before) / dt, before = now;
    answer.least = std::min(answer.least, run.kineticEnergy() / kinetic);
    if (answer.met == 0.0 && run.kineticEnergy() < 0.99 * kinetic) answer.met = model.t;
    answer.momentum = std::max(answer.momentum, norm(fem::momentum(model.nodes) - momentum) / scale);
    answer.turning = std::max(answer.turning, norm(fem::angularMomentum(model.nodes) - turning) / (scale * radius));
  }
  answer.restitution = rate / (2.0 * std::sqrt(2.0) * pace);
  answer.lost = run.ledger().joules("renewals of points") / kinetic;
  answer.residual = run.ledger().largestResidual() / kinetic;
  return answer;
}

}  // namespace

bool discs(bool quick) {
  bool holds = true;
  std::printf("Circles would touch at %.3f s\n\n",
              ((far - near) * std::sqrt(2.0) - 2.0 * radius) / (2.0 * std::sqrt(2.0) * pace));
  std::printf(
      "| cells of 1 m | transfer | shape | met, s | least kinetic energy | restitution | lost, %% | residual, %% | "
      "momentum | angular |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int cells : {20, 40, 80})
    for (const mpm::Transfer transfer : {mpm::Transfer::flip, mpm::Transfer::apic})
      for (const mpm::Shape shape : {mpm::Shape::quadratic, mpm::Shape::cubic}) {
        if (cells > (quick ? 20 : 40) && (quick || shape == mpm::Shape::cubic)) continue;
        const Answer a = collide(cells, shape, transfer);
        std::printf("| %d | %s | %s | %.2f | %.3f | %.3f | %.1f | %.3f | %.0e | %.0e |\n", cells, nameOf(transfer),
                    name(shape), a.met, a.least, a.restitution, 100.0 * a.lost, 100.0 * a.residual, a.momentum,
                    a.turning);
        std::fflush(stdout);
        holds = holds && a.momentum < 1e-12 && (transfer == mpm::Transfer::flip || a.turning < 1e-12);
      }
  return holds;
}

}  // namespace dovetail::benchmark
