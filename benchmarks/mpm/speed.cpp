// Time of a step, with and without the law, threads, and memory.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "cases.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr int steps = 60, repeats = 5;

struct Timing {
  double cpu = 0.0, wall = 0.0;  ///< µs a point and step
  double law = 0.0;              ///< µs of the processor for one answer of a point
  double stepsPerRenewal = 0.0;
  double bytes = 0.0;  ///< a point
};

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + repeats / 2);
  return values[repeats / 2];
}

template <class Values>
std::size_t bytesOf(const Values& values) {
  return values.capacity() * sizeof(values[0]);
}

/// Weights, answers, and places, velocities, masses, volumes and F of the last renewal.
double bytesOf(const mpm::PointSolid& solid, bool affine) {
  const mpm::GridRows& r = solid.rows();
  const std::size_t grid = bytesOf(r.cell) + bytesOf(r.node) + bytesOf(r.flip) + bytesOf(r.reached) +
                           bytesOf(r.weight) + bytesOf(r.slope) + bytesOf(r.firstOfCell) + bytesOf(r.pointOfCell) +
                           bytesOf(r.firstOfNode) + bytesOf(r.entryOfNode) + bytesOf(r.X) + bytesOf(r.fixed);
  const std::size_t own = 2 * sizeof(Vec3) + (affine ? 20 : 11) * sizeof(double);
  return static_cast<double>(grid + solid.answers().memory()) / static_cast<double>(r.points()) +
         static_cast<double>(own);
}

double lawAlone(std::span<const double> F, std::size_t points) {
  const auto field = neoHookeanField(1e6, 0.3);
  std::vector<fem::PointPlace> places;
  for (std::size_t p = 0; p < points; ++p) places.push_back({-1, static_cast<int>(p), {}, 1.0});
  field->open(places);
  std::vector<double> P(9 * points), energy(points), dissipated(points);
  std::vector<std::string> reason(points);
  const double start = seconds();
  for (int k = 0; k < steps; ++k)
    field->evaluate({.F = F,
                     .dt = 1e-3,
                     .moved = true,
                     .P = P,
                     .tangent = {},
                     .energy = energy,
                     .dissipated = dissipated,
                     .reason = reason});
  return 1e6 * (seconds() - start) / steps / static_cast<double>(points);
}

/// A block that flies through its grid.
Timing flight(int across, mpm::Shape shape, mpm::Transfer transfer, double pace) {
  mpm::MaterialPoints points = box({}, 1.0, 1.0, 1.0 / across);
  for (Vec3& v : points.v) v = {0.8 * pace, 0.6 * pace, 0.0};
  const auto solid = mpm::makePoints(points, neoHookeanField(1e6, 0.3),
                                     {.grid = {.spacing = 2.0 / across, .shape = shape}, .transfer = transfer});
  fem::Model model = mpm::makeModel(solid);
  fem::addMass(model);
  fem::ExplicitIntegrator run(model, 0.8 * fem::stableStep(model).dt, {.energyEvery = 0});
  run.run(1);
  std::vector<double> cpu, wall;
  for (int k = 0; k < repeats; ++k) {
    const double start = seconds();
    const auto from = std::chrono::steady_clock::now();
    run.run(steps);
    cpu.push_back(seconds() - start);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count());
  }
  const double each = 1e6 / steps / static_cast<double>(points.x.size());
  Timing timing{.cpu = each * median(cpu), .wall = each * median(wall)};
  timing.law = lawAlone(solid->answers().F(), points.x.size());
  timing.stepsPerRenewal = solid->renewals() > 0 ? repeats * steps / static_cast<double>(solid->renewals()) : 0.0;
  timing.bytes = bytesOf(*solid, transfer == mpm::Transfer::apic);
  return timing;
}

}  // namespace

bool speed(bool quick) {
  const int before = threads(), across = quick ? 64 : 128;
  std::printf(
      "%d points, neo-Hookean, 2 × 2 a cell; medians of %d\n\n"
      "| transfer | shape | m/s | steps a renewal | threads | µs of the processor a point and step | of which law | "
      "µs of the clock | bytes a point |\n|---|---|---|---|---|---|---|---|---|\n",
      across * across, repeats);
  for (const mpm::Transfer transfer : {mpm::Transfer::flip, mpm::Transfer::apic})
    for (const mpm::Shape shape : {mpm::Shape::quadratic, mpm::Shape::cubic})
      for (const double pace : {0.0, 1.0, 5.0})
        for (const int count : {1, 2}) {
          if (pace == 0.0 && transfer == mpm::Transfer::apic) continue;
          setThreads(count);
          const Timing t = flight(across, shape, transfer, pace);
          std::printf("| %s | %s | %g | %.1f | %d | %.3f | %.3f | %.3f | %.0f |\n", nameOf(transfer), name(shape), pace,
                      t.stepsPerRenewal, count, t.cpu, t.law, t.wall, t.bytes);
          std::fflush(stdout);
        }
  setThreads(before);
  return true;
}

}  // namespace dovetail::benchmark
