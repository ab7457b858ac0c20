#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "dovetail/arlequin/critical_step.hpp"
#include "dovetail/core/error.hpp"
#include "scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

/// Energy after many steps at a share of the critical step, over that at the start.
double growth(double share) {
  SceneOptions o;
  o.massShare = 0.375;
  Model model = makeBar(o);
  std::mt19937 random(1);
  for (Vec3& v : model.discrete.particles.v) v = randomVector(random, 1e-4);
  const double dt = share * criticalStep(model).together;
  Profile profile;
  StepSums sums;
  start(model, dt, profile);
  const double before = energies(model).total();
  try {
    for (int s = 0; s < 3000; ++s) {
      stepExplicit(model, dt, 1, sums, s == 2999, profile);
      if (!std::isfinite(model.discrete.particles.v[0].y) || norm(model.discrete.particles.v[0]) > 1e3) return 1e30;
    }
  } catch (const NumericalError&) {  // farther than its radius in one step
    return 1e30;
  }
  return energies(model).total() / before;
}

TEST(CriticalStep, VerletIsBoundedBelowAndGrowsAboveIt) {
  EXPECT_LT(growth(0.98), 50.0);
  EXPECT_GT(growth(1.02), 1e6);
}

TEST(CriticalStep, TheDashpotsLimitWithUniformSharesIsTwo) {
  // No stiffness, w = ½ everywhere: stable for ε dt²/(ρ w (1 − w)) < 2.
  const auto endSpeed = [](double number) {
    SceneOptions o;
    o.across = 1;
    o.particlesPerEdge = 1;
    Model model;
    model.discrete.particles = lattice({0, 0, 0}, {edge, 4 * edge, edge}, 1);
    for (Vec3& v : model.discrete.particles.v) v.y = 1.0;
    dem::ElasticLaw law;
    law.normal.stiffness = 1e-9;
    model.discrete.laws = dem::makeContactLaws(law);
    model.discrete.sortEvery = 0;
    model.discrete.pairs.setSkin(0.0);
    dem::findPairs(model.discrete.particles, model.discrete.pairs);
    const fem::SolidMesh mesh = fem::boxOf(fem::CellShape::hex8, {1, 4, 1}, {0, 0, 0}, {edge, 4 * edge, edge});
    const std::vector<double> weight(mesh.X.size(), 0.5);
    auto solid = std::make_unique<fem::Model>(fem::makeModel(mesh));
    const fem::StVenantKirchhoff soft{1e-9, 0.0, bulk};
    solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(soft)), {.share = solidWeights(weight)}));
    model.solid.emplace(mesh, std::move(solid));
    const double dt = 1e-3;
    CouplingOptions coupling;
    coupling.constraint = ConstraintKind::dashpot;
    coupling.penalty = number * bulk * 0.25 / (dt * dt);
    model.coupling.emplace(
        makeCoupling(model.discrete.particles, model.discrete.pairs, *model.solid, weight, coupling));
    Profile profile;
    StepSums sums;
    start(model, dt, profile);
    try {
      for (int s = 0; s < 2000; ++s) stepExplicit(model, dt, 1, sums, false, profile);
    } catch (const NumericalError&) {  // farther than its radius in one step
      return edge / dt;
    }
    return norm(model.discrete.particles.v[1]);
  };
  EXPECT_LT(endSpeed(1.99), 2.0);
  EXPECT_GT(endSpeed(2.01), 1e2);
}

SceneOptions dashpotScene(double epsilon) {
  SceneOptions o;
  o.across = 1;
  o.particlesPerEdge = 1;
  o.particleElements = 4;
  o.overlapElements = 3;
  o.solidElements = 4;
  o.weights.floor = 0.1;
  o.coupling.constraint = ConstraintKind::dashpot;
  o.coupling.penalty = epsilon;
  return o;
}

/// The step as a linear map of (x, v, u, v_FE, last increments) of a one-brick-wide bar along y, column by column.
Eigen::MatrixXd stepMatrix(double epsilon, double dt) {
  const SceneOptions o = dashpotScene(epsilon);
  const auto slots = [](Model& m) {
    std::vector<double*> place;
    for (Vec3& v : m.discrete.particles.v) place.push_back(&v.y);
    for (Vec3& u : m.solid->nodes().u) place.push_back(&u.y);
    for (Vec3& v : m.solid->nodes().v) place.push_back(&v.y);
    for (Vec3& d : m.coupling->increment) place.push_back(&d.y);
    for (Vec3& x : m.discrete.particles.x) place.push_back(&x.y);
    return place;
  };
  Profile profile;
  constexpr double small = 1e-7;
  const auto advanced = [&](int column) {
    Model model = makeBar(o);
    std::vector<double> before;
    for (double* value : slots(model)) before.push_back(*value);
    if (column >= 0) *slots(model)[static_cast<std::size_t>(column)] += small;
    StepSums sums;
    start(model, dt, profile);
    stepExplicit(model, dt, 1, sums, false, profile);
    std::vector<double> after;
    const auto places = slots(model);
    for (std::size_t k = 0; k < places.size(); ++k) after.push_back(*places[k] - before[k]);
    return after;
  };
  const std::vector<double> rest = advanced(-1);
  const auto size = static_cast<Eigen::Index>(rest.size());
  Eigen::MatrixXd step(size, size);
  for (Eigen::Index column = 0; column < size; ++column) {
    const std::vector<double> moved = advanced(static_cast<int>(column));
    for (Eigen::Index row = 0; row < size; ++row)
      step(row, column) = (moved[static_cast<std::size_t>(row)] - rest[static_cast<std::size_t>(row)]) / small;
  }
  return step;
}

/// Largest growth of the velocities of the overlap in many steps.
double dashpotGrowth(double epsilon, double dt) {
  const SceneOptions o = dashpotScene(epsilon);
  Model model = makeBar(o);
  std::mt19937 random(3);
  for (Vec3& v : model.discrete.particles.v) v.y = 1e-6 * randomVector(random, 1.0).y;
  Profile profile;
  StepSums sums;
  start(model, dt, profile);
  double speed = 0.0;
  for (int s = 0; s < 3000 && speed < 1.0; ++s) {
    stepExplicit(model, dt, 1, sums, false, profile);
    speed = 0.0;
    for (const Vec3& v : model.discrete.particles.v) speed = std::max(speed, norm(v));
  }
  return speed / 1e-6;
}

TEST(CriticalStep, OnABarTheDashpotFailsWhereTheSpectralRadiusOfItsStepPassesOne) {
  const double dt = 5e-4;
  const auto radius = [&](double epsilon) {
    return Eigen::EigenSolver<Eigen::MatrixXd>(stepMatrix(epsilon, dt), false).eigenvalues().cwiseAbs().maxCoeff();
  };
  double stable = 1e6, unstable = 1e11;
  while (unstable / stable > 1.005) {
    const double middle = std::sqrt(stable * unstable);
    (radius(middle) < 1.0 + 1e-5 ? stable : unstable) = middle;
  }
  EXPECT_LT(dashpotGrowth(0.98 * stable, dt), 10.0);
  EXPECT_GT(dashpotGrowth(1.02 * stable, dt), 1e3);
  RecordProperty("epsilon_dt2_over_rho_w_1_minus_w_at_the_limit", std::to_string(stable * dt * dt / (bulk * 0.09)));
}

}  // namespace
}  // namespace dovetail::arlequin
