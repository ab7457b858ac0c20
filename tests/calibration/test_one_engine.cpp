// dem and rve hold the same cell: one packing, one path, one answer.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "dovetail/calibration/cell_probes.hpp"
#include "dovetail/cg/averages.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/model/snapshot.hpp"
#include "dovetail/dem/setup/cell.hpp"
#include "dovetail/dem/setup/relax.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "dovetail/rve/packing.hpp"

namespace dovetail::calibration {
namespace {

constexpr double sticking = 1e9;  // friction

/// Grains at rest under a pressure, no tangential spring stretched.
rve::Rve pressed(const rve::Springs& springs, double pressure) {
  rve::Rve cell = rve::randomCell(
      {.shape = rve::Shape::sphere, .count = 150, .sizes = dem::UniformSizes{4e-3, 6e-3}, .solidFraction = 0.55},
      springs);
  rve::compress(cell, {.pressure = {pressure, pressure, pressure}, .friction = 0.1, .rest = {.tolerance = 1e-6}});
  rve::Grains grains{.shape = rve::Shape::sphere, .radius = cell.radius, .density = cell.density};
  for (std::size_t i = 0; i < cell.size(); ++i)
    grains.centre.push_back({cell.state.x[0][i], cell.state.x[1][i], cell.state.x[2][i]});
  return rve::makeRve(grains, cell.state.lattice, springs);
}

/// The same for dem, with lists as long.
dem::Model modelOf(const rve::Rve& cell, std::shared_ptr<const dem::ContactLaws> laws) {
  dem::Model m;
  for (std::size_t i = 0; i < cell.size(); ++i)
    dem::addParticle(m.particles, {cell.state.x[0][i], cell.state.x[1][i], cell.state.x[2][i]}, {}, cell.radius[i],
                     dem::Density{cell.density});
  const auto& period = cell.state.lattice.period;
  m.pairs.setPeriodicity({{{0, 0, 0}, {period[0].x, period[1].y, period[2].z}}, {true, true, true}});
  m.pairs.setSkin(cell.skin);
  m.laws = std::move(laws);
  dem::findForces(m);
  return m;
}

struct Both {
  rve::Rve cell;
  dem::Model model;

  void strain(const Vec3& e) {
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    for (int k = 0; k < 3; ++k) G(k, k) += e[k];
    rve::deform(cell, G);
    dem::findForces(model);
    dem::strainCell(model, e);
  }
  double apart() {
    dem::findForces(model);
    const dem::Snapshot now = dem::takeSnapshot(model);
    const cg::SnapshotView view = cg::viewOf(now);
    const Eigen::Matrix3d own = cg::loveWeberStress(view.branches, {}, cellVolume(model)).contact;
    const Eigen::Matrix3d other = rve::stress(cell).cauchy;
    return (0.5 * (own + own.transpose()) - other).norm() / other.norm();
  }
};

Both linearSpheres(double friction) {
  const rve::Springs springs{.stiffness = 1e5, .tangential = 0.8, .friction = friction};
  dem::FrictionalLaw law;
  law.normal = {.stiffness = springs.stiffness};
  law.tangential = {.stiffness = springs.tangential * springs.stiffness, .friction = friction};
  const rve::Rve cell = pressed(springs, 5e5);
  return {cell, modelOf(cell, dem::makeContactLaws(law))};
}

Both elasticSpheres(double friction) {
  const rve::Springs springs = rve::hertzMindlin(29e7, 0.15, friction);
  dem::HertzMindlinLaw law;
  law.normal.effectiveModulus = springs.hertz;
  law.tangential = {.stiffnessRatio = springs.tangential, .friction = friction};
  const rve::Rve cell = pressed(springs, 5e5);
  return {cell, modelOf(cell, dem::makeContactLaws(law))};
}

// Lost is what springs held whose contacts end, and what softer springs hold no longer. Grains that come to touch in a
// step slip with the part of it that they touch in dem, and with the whole step in a cell.
TEST(OneEngine, StressesAgreeAtTheStartAndAlongElasticPaths) {
  for (Both both : {linearSpheres(sticking), elasticSpheres(sticking)}) {
    EXPECT_LT(both.apart(), 1e-12);
    for (int k = 0; k < 20; ++k) {
      both.strain({-2e-4, 1e-4 * std::sin(k), 1.5e-4 * std::cos(k)});
      EXPECT_LT(both.apart(), 1e-5) << k;
    }
    for (int k = 0; k < 10; ++k) both.strain({1e-3, 5e-4, -1e-3});
    const double lost = both.model.booked.lost.frictionPower;
    EXPECT_GT(lost, 0.0);
    EXPECT_NEAR(both.cell.state.ledger.friction, lost, 1e-3 * lost);
  }
}

// With lists as long and all their pairs counted. rve's step is to last until the next list; dem's is of the contacts
// as they are, which are fewer, and is looked up again. Of elastic spheres, whose stiffness changes in every sweep, rve
// takes the fastest grain twice in place of the fastest pair.
TEST(OneEngine, TheCriticalStepIsOne) {
  const Both linear = linearSpheres(0.5);
  const double step = linear.cell.state.criticalStep;
  EXPECT_NEAR(dem::criticalStep(linear.model, 1e-15).dt, step, 1e-12 * step);
  EXPECT_GT(dem::criticalStep(linear.model).dt, step);
  const Both elastic = elasticSpheres(0.5);
  const double now = dem::criticalStep(elastic.model).dt, bound = elastic.cell.state.criticalStep;
  EXPECT_LE(bound, now);
  EXPECT_GT(bound, now / std::sqrt(2.0));
}

// Rest is approached by other steps here and there (velocity Verlet at 0.6 of the critical step, symplectic Euler at
// 0.8), and what slides on the way, and what is taken to stop the grains, depends on that way. Work and stress are
// those of the states at rest; what is lost follows from them.
TEST(OneEngine, WorkAndLossesAgreeOnASlidingPath) {
  for (Both both : {linearSpheres(0.3), elasticSpheres(0.3)}) {
    rve::relax(both.cell, {.tolerance = 1e-8});
    dem::relax(both.model, {.tolerance = 1e-8});
    both.cell.state.ledger = {};
    const dem::Energies start = dem::energies(both.model);
    for (int k = 0; k < 40; ++k) {
      both.strain({1e-4, 1e-4, -2e-4});
      rve::relax(both.cell, {.tolerance = 1e-6});
      dem::relax(both.model, {.tolerance = 1e-6});
    }
    const dem::Energies end = dem::energies(both.model);
    const rve::RveLedger& ledger = both.cell.state.ledger;
    const double work = end.external - start.external, friction = end.lost.frictionPower - start.lost.frictionPower,
                 damping = end.damping - start.damping;
    EXPECT_GT(friction, 0.1 * work);
    EXPECT_LT(both.apart(), 2e-3);
    EXPECT_NEAR(ledger.work, work, 3e-3 * work);
    EXPECT_NEAR(ledger.friction, friction, 0.03 * friction);
    EXPECT_NEAR(ledger.friction + ledger.damping, friction + damping, 0.03 * friction);
  }
}

}  // namespace
}  // namespace dovetail::calibration
