#include "biaxial_solid.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <ctime>

#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/rve/packing.hpp"

namespace dovetail::benchmark {

rve::Rve sand(std::uint64_t seed, int discs) {
  rve::Rve cell =
      rve::randomCell({.count = discs, .seed = seed}, {.modulus = 6e8, .tangential = 0.8, .friction = std::tan(0.5)});
  rve::compress(cell, {.pressure = {1e5, 1e5, 0.0}, .friction = 0.0, .rest = {.tolerance = 1e-6}});
  return cell;
}

BiaxialSolid::BiaxialSolid(const BiaxialOptions& s, std::shared_ptr<fem::PointField> field,
                           const fem::TimeFunction& sinks)
    : mesh(fem::boxOf(s.shape, {s.elements[0], s.elements[1], 1}, {}, s.size)),
      model(fem::makeModel(mesh)),
      solid(fem::makeSolid(mesh, std::move(field), {.formulation = s.formulation, .name = "cells"})),
      size(s.size) {
  model.add(solid);
  model.add(fem::followingPressure(mesh, fem::faceSet(mesh, "x+"), s.pressure));
  const std::vector<int>&bottom = fem::nodeSet(mesh, "y-"), &top = fem::nodeSet(mesh, "y+");
  model.constraints.hold(bottom, s.rough ? fem::componentX | fem::componentY : fem::componentY);
  model.constraints.prescribe(top, 1, [sinks](double t) { return -sinks(t); });
  if (s.rough) model.constraints.hold(top, fem::componentX);
  if (s.wall)
    model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
  else
    model.add(fem::followingPressure(mesh, fem::faceSet(mesh, "x-"), s.pressure, {}, "pressure on the left"));
  if (!s.wall && !s.rough) model.constraints.hold(std::array{bottom.front()}, fem::componentX);
  const std::vector<int>& side = fem::nodeSet(mesh, "x+");
  for (std::size_t k = 1; s.straight && k < side.size(); ++k)
    model.constraints.ties.push_back({side[k], 0, {{side[0], 0, 1.0}}, 0.0, {}});
}

double BiaxialSolid::axial() {
  const fem::Solid::Sample sample = solid->sample(model.nodes, {model.t, 0.0});
  double sum = 0.0, volume = 0.0;
  for (std::size_t p = 0; p < sample.volume.size(); ++p) {
    sum -= sample.volume[p] * sample.P[9 * p + 4];
    volume += sample.volume[p];
  }
  return sum / volume;
}

double BiaxialSolid::plateStress() const {
  double force = 0.0;
  for (const int node : fem::nodeSet(mesh, "y+")) force += model.nodes.f[static_cast<std::size_t>(node)].y;
  return force / (size.x * size.z);
}

namespace {

/// (σ₂₂ − σ₁₁)/(σ₂₂ + σ₁₁) of the means of Cauchy stress.
double stressRatio(const BiaxialSolid& body) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const fem::Solid::Sample sample = body.solid->sample(body.model.nodes, {body.model.t, 0.0});
  double xx = 0.0, yy = 0.0;
  for (std::size_t p = 0; p < sample.volume.size(); ++p) {
    const Eigen::Map<const RowMajor> F(&sample.F[9 * p]), P(&sample.P[9 * p]);
    const Eigen::Matrix3d tau = P * F.transpose();
    xx += sample.volume[p] * tau(0, 0);
    yy += sample.volume[p] * tau(1, 1);
  }
  return (yy - xx) / (yy + xx);
}

/// What plates and pressure have done, J.
double workDone(const EnergyLedger& ledger) {
  return -ledger.joules("supports") - ledger.joules("work of pressure") - ledger.joules("work of pressure on the left");
}

}  // namespace

Course pressTogether(const BiaxialOptions& settings, const std::vector<rve::Rve>& samples, double rate, double damping,
                     double strain) {
  constexpr double between = 5e-4;
  const double height = settings.size.y, start = 0.005 / rate;  // s, in which the plate comes to its speed
  BiaxialSolid body(settings, hierarchical::cellField(samples, hierarchical::DynamicCells{}),
                    [=](double t) { return height * rate * (t < start ? 0.5 * t * t / start : t - 0.5 * start); });
  body.model.add(fem::massDamping(damping));
  fem::addMass(body.model);
  Course course;
  const double began = processorSeconds();
  fem::ExplicitIntegrator run(body.model, 0.8 * fem::stableStep(body.model).dt, {.energyEvery = 10});
  const auto top = static_cast<std::size_t>(fem::nodeSet(body.mesh, "y+").front());
  double sum = 0.0;
  for (int count = 0; course.looks.empty() || course.looks.back().strain < strain;) {
    run.step();
    ++course.steps;
    sum += body.plateStress();
    ++count;
    const double now = -body.model.nodes.u[top].y / height;
    if (now < between * static_cast<double>(course.looks.size() + 1)) continue;
    course.looks.push_back({now, sum / count, stressRatio(body), run.kineticEnergy() / workDone(run.ledger())});
    sum = 0.0;
    count = 0;
  }
  course.residual = run.ledger().largestResidual() / workDone(run.ledger());
  course.seconds = processorSeconds() - began;
  return course;
}

const Look& Course::peak(double Look::*value) const { return *std::ranges::max_element(looks, {}, value); }

double Course::mean(double Look::*value, double from, double to) const {
  double sum = 0.0;
  int count = 0;
  for (const Look& look : looks)
    if (look.strain >= from && look.strain <= to) sum += look.*value, ++count;
  return sum / count;
}

double processorSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace dovetail::benchmark
