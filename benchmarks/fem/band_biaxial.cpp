#include "band_biaxial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "soft_sand.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double height = 2.0, rate = 0.05;

fem::SolidMesh meshOf(const BandBiaxial& s) {
  fem::SolidMesh mesh = fem::boxOf(s.shape, {s.across, 2 * s.across, 1}, {}, {1.0, height, 1.0});
  for (Vec3& X : mesh.X)
    X.y += s.skew / s.across * std::sin(std::numbers::pi * X.x) * std::sin(3.0 * std::numbers::pi * X.y);
  return mesh;
}

void addParts(fem::Model& model, fem::SolidMesh& mesh, const std::vector<BandPart>& parts) {
  const auto formulation =
      mesh.groups.front().shape == fem::ElementShape::quad8 ? fem::Formulation::reduced : fem::Formulation::standard;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const std::string name = "part " + std::to_string(k);
    if (!parts[k].elements.empty()) mesh.elementSets[name] = parts[k].elements;
    model.add(fem::makeSolid(
        mesh, parts[k].field,
        {.formulation = formulation, .elementSet = parts[k].elements.empty() ? "" : name, .name = name}));
  }
}

void addPressure(fem::Model& model, const fem::SolidMesh& mesh, bool following) {
  for (const char* const side : {"x-", "x+"}) {
    const std::string name = std::string("pressure on ") + side;
    if (following)
      model.add(fem::followingPressure(mesh, fem::faceSet(mesh, side), allRoundPressure, {}, name));
    else
      model.add(fem::deadPressure(mesh, fem::faceSet(mesh, side), allRoundPressure, name));
  }
}

fem::Model modelOf(const BandBiaxial& s, fem::SolidMesh& mesh, const std::vector<BandPart>& parts) {
  fem::Model model = fem::makeModel(mesh);
  addParts(model, mesh, parts);
  if (s.modulus > 0.0) model.add(fem::gradientEnergy(mesh, {.modulus = s.modulus}));
  addPressure(model, mesh, s.following);
  model.add(fem::massDamping(s.damping));
  const std::vector<int>&bottom = fem::nodeSet(mesh, "y-"), &top = fem::nodeSet(mesh, "y+");
  model.constraints.hold(bottom, s.rough ? fem::componentX | fem::componentY : fem::componentY);
  if (s.rough)
    model.constraints.hold(top, fem::componentX);
  else
    model.constraints.hold(std::array{bottom.front()}, fem::componentX);
  model.constraints.prescribe(top, 1, [](double t) {
    constexpr double start = 0.005 / rate;  // s, to come to its speed
    return -height * rate * (t < start ? 0.5 * t * t / start : t - 0.5 * start);
  });
  fem::addMass(model);
  return model;
}

}  // namespace

BandLook shearOf(const fem::Model& model) {
  std::vector<std::pair<double, double>> shear;  // and volume
  double all = 0.0, volume = 0.0, part = 0.0, taken = 0.0;
  for (const auto& term : model.terms) {
    auto* const solid = dynamic_cast<fem::Solid*>(term.get());
    if (solid == nullptr) continue;
    const fem::Solid::Sample sample = solid->sample(model.nodes, {model.t, 0.0});
    for (std::size_t p = 0; p < sample.volume.size(); ++p) {
      const double* const F = &sample.F[9 * p];
      shear.emplace_back(std::hypot(F[0] - F[4], F[1] + F[3]), sample.volume[p]);
      all += shear.back().first * sample.volume[p];
      volume += sample.volume[p];
    }
  }
  std::ranges::sort(shear, std::greater<>());
  for (std::size_t k = 0; k < shear.size() && part < 0.5 * all; ++k)
    part += shear[k].first * shear[k].second, taken += shear[k].second;
  return {0.0, taken / volume, shear.front().first};
}

BiaxialCourse pressTogether(const BandBiaxial& s, const std::vector<BandPart>& parts) {
  fem::SolidMesh mesh = meshOf(s);
  fem::Model model = modelOf(s, mesh, parts);
  BiaxialCourse course;
  const std::clock_t began = std::clock();
  course.step = 0.8 * fem::stableStep(model).dt;
  fem::ExplicitIntegrator run(model, course.step, {.energyEvery = 50, .checkEvery = 10});
  const std::vector<int>& plate = fem::nodeSet(mesh, "y+");
  const auto strain = [&] { return -model.nodes.u[static_cast<std::size_t>(plate.front())].y / height; };
  const auto residual = [&] { return run.ledger().largestResidual() / std::abs(run.ledger().joules("supports")); };
  double sum = 0.0, mark = 0.0025;
  int count = 0, means = 0;
  try {
    while (strain() < s.end - 1e-9) {
      run.step();
      ++course.steps;
      for (const int n : plate) sum += model.nodes.f[static_cast<std::size_t>(n)].y;
      ++count;
      if (strain() < mark) continue;
      if (residual() > brokenResidual) {
        course.broken = strain();
        break;
      }
      course.peak = std::max(course.peak, sum / count);
      if (++means % 4 == 0) {
        course.looks.push_back(shearOf(model));
        course.looks.back().axial = sum / count;
      }
      mark += 0.0025;
      sum = 0.0, count = 0;
    }
  } catch (const NumericalError&) {
    course.broken = strain();
  }
  course.seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  course.residual = residual();
  return course;
}

}  // namespace dovetail::benchmark
