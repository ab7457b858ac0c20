#include "band_pressuremeter.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "soft_sand.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double hole = 1.0, edge = 10.0, circle = 1.3, growth = 0.2;  // m, s
constexpr double angle = 0.5 * std::numbers::pi;
const Vec3 weakest{hole * std::cos(0.7), hole* std::sin(0.7), 0.0};

fem::SolidMesh ringMesh(const Pressuremeter& s) {
  fem::SolidMesh mesh = fem::cylinderSector(fem::ElementShape::quad8, {s.along, s.around, 1}, hole, edge, angle, 1.0);
  for (Vec3& X : mesh.X) {
    const double r = std::hypot(X.x, X.y);
    const double graded = hole * std::pow(edge / hole, (r - hole) / (edge - hole));
    X.x *= graded / r, X.y *= graded / r;
  }
  return mesh;
}

fem::Model ringModel(const Pressuremeter& s, const fem::SolidMesh& mesh) {
  fem::Model model = fem::makeModel(mesh);
  model.add(fem::makeSolid(mesh, softSand({.weakSpot = weakest}),
                           {.formulation = fem::Formulation::reduced, .name = "sand"}));
  if (s.modulus > 0.0) model.add(fem::gradientEnergy(mesh, {.modulus = s.modulus}));
  model.add(fem::followingPressure(
      mesh, fem::faceSet(mesh, "inner"), [](double t) { return allRoundPressure * (1.0 + t / growth); }, {}, "hole"));
  model.add(fem::followingPressure(mesh, fem::faceSet(mesh, "outer"), allRoundPressure, {}, "ground"));
  model.add(fem::massDamping(20.0));
  model.constraints.hold(fem::nodeSet(mesh, "start"), fem::componentY);
  model.constraints.hold(fem::nodeSet(mesh, "end"), fem::componentX);
  fem::addMass(model);
  return model;
}

/// |(F₁₁ − F₂₂, F₁₂ + F₂₁)| of the points next to a circle, in their order around it.
std::vector<double> shearAround(const fem::Solid::Sample& sample, double radius) {
  const auto distance = [&](std::size_t p) { return std::hypot(sample.X[p].x, sample.X[p].y); };
  double next = HUGE_VAL;
  for (std::size_t p = 0; p < sample.X.size(); ++p)
    if (std::abs(distance(p) - radius) < std::abs(next - radius)) next = distance(p);
  std::vector<std::pair<double, double>> found;  // angle, shear
  for (std::size_t p = 0; p < sample.X.size(); ++p) {
    const double* const F = &sample.F[9 * p];
    if (std::abs(distance(p) - next) < 0.01 * radius)
      found.emplace_back(std::atan2(sample.X[p].y, sample.X[p].x), std::hypot(F[0] - F[4], F[1] + F[3]));
  }
  std::ranges::sort(found);
  std::vector<double> shear;
  for (const auto& point : found) shear.push_back(point.second);
  return shear;
}

void countBands(PressuremeterLook& look, const std::vector<double>& shear) {
  const auto count = static_cast<double>(shear.size());
  const double mean = std::accumulate(shear.begin(), shear.end(), 0.0) / count;
  double above = 0.0;
  for (std::size_t k = 0; k < shear.size(); ++k) {
    if (shear[k] <= mean) continue;
    above += circle * angle / count;
    if (k == 0 || shear[k - 1] <= mean) ++look.bands;
  }
  look.width = above / look.bands;
  look.contrast = std::ranges::max(shear) / mean;
}

PressuremeterLook lookAt(const fem::SolidMesh& mesh, fem::Model& model) {
  PressuremeterLook look{.pressure = 1.0 + model.t / growth};
  const std::vector<int>& wall = fem::nodeSet(mesh, "inner");
  for (const int n : wall) {
    const Vec3 &X = mesh.X[static_cast<std::size_t>(n)], &u = model.nodes.u[static_cast<std::size_t>(n)];
    look.opening += (X.x * u.x + X.y * u.y) / (hole * hole * static_cast<double>(wall.size()));
  }
  auto& sand = dynamic_cast<fem::Solid&>(*model.terms.front());
  countBands(look, shearAround(sand.sample(model.nodes, {model.t, 0.0}), circle));
  return look;
}

}  // namespace

PressuremeterCourse inflate(const Pressuremeter& s) {
  const fem::SolidMesh mesh = ringMesh(s);
  fem::Model model = ringModel(s, mesh);
  PressuremeterCourse course;
  const std::clock_t began = std::clock();
  course.step = 0.8 * fem::stableStep(model).dt;
  fem::ExplicitIntegrator run(model, course.step, {.energyEvery = 50, .checkEvery = 10});
  try {
    for (double pressure = 1.25; pressure < s.end + 1e-9; pressure += 0.25) {
      run.runUntil((pressure - 1.0) * growth);
      course.looks.push_back(lookAt(mesh, model));
    }
  } catch (const NumericalError&) {
    course.broken = 1.0 + model.t / growth;
  }
  course.seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  course.residual = run.ledger().largestResidual() / std::abs(run.ledger().joules("work of hole"));
  return course;
}

}  // namespace dovetail::benchmark
