#include <gtest/gtest.h>

#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/core/error.hpp"
#include "tie_scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

struct Setting {
  ConstraintKind kind;
  double width;
};

Bar barWith(ConstraintKind kind, double width, double massShare = 0.0) {
  SceneOptions o;
  o.coupling.constraint = kind;
  o.coupling.projection.width = width;
  o.coupling.penalty = kind == ConstraintKind::dashpot ? 1e8 : 0.0;
  o.massShare = massShare;
  return makeBar(o);
}

std::vector<Vec3> randomRows(const Bar& c, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec3> rows(c.rows());
  for (Vec3& v : rows) v = randomVector(random, 1e-3);
  return rows;
}

TEST(Constraint, ThePenaltyIsTheGradientOfItsEnergy) {
  for (const double width : {0.0, 0.9}) {
    const Bar model = barWith(ConstraintKind::penalty, width);
    const Bar& c = model;
    std::vector<Vec3> gap = randomRows(c, 4), lambda(c.rows()), tangent(c.rows());
    c.constraint->evaluate({gap, {}, {}, {}, 1.0}, lambda);
    c.constraint->applyStiffness(gap, tangent);
    for (const std::size_t r : {std::size_t{0}, c.rows() / 2, c.rows() - 1})
      for (int k = 0; k < 3; ++k) {
        const double before = gap[r][k], step = 1e-5;
        gap[r][k] = before + step;
        const double above = c.constraint->storedEnergy(gap);
        gap[r][k] = before - step;
        const double below = c.constraint->storedEnergy(gap);
        gap[r][k] = before;
        EXPECT_NEAR(lambda[r][k], (above - below) / (2.0 * step), 1e-6 * norm(lambda[r]) + 1e-9);
        EXPECT_NEAR(tangent[r][k], lambda[r][k], 1e-12 * norm(lambda[r])) << "linear: λ is its own tangent";
      }
    EXPECT_GT(c.constraint->storedEnergy(gap), 0.0);
  }
}

TEST(Constraint, MultipliersTakeTheGapsAccelerationAway) {
  for (const double share : {0.0, 0.4})
    for (const double width : {0.0, 0.9}) {
      Bar model = barWith(ConstraintKind::multiplier, width, share);
      Bar& c = model;
      const fem::ModelMass& solid = model.mass();
      std::mt19937 random(8);
      std::vector<Vec3> f(model.particles.size()), g(model.nodes().X.size());
      for (auto* forces : {&f, &g})
        for (Vec3& v : *forces) v = randomVector(random, 1.0);
      const auto accelerations = [&](std::vector<Vec3> onParticles, std::vector<Vec3> onNodes) {
        for (std::size_t i = 0; i < onParticles.size(); ++i) onParticles[i] *= 1.0 / model.particles.mass[i];
        solid.solve(onNodes);
        std::vector<Vec3> gap(c.rows());
        gapOf(c.gap, c.overlap, onParticles, onNodes, gap);
        return gap;
      };
      const std::vector<Vec3> before = accelerations(f, g), none(c.rows());
      std::vector<Vec3> lambda(c.rows());
      c.constraint->evaluate({none, none, none, before, 1.0}, lambda);
      pullParticles(c.gap, c.overlap, lambda, f);
      pullNodes(c.gap, lambda, g);
      const std::vector<Vec3> after = accelerations(f, g);
      double left = 0.0, size = 0.0;
      for (std::size_t r = 0; r < c.rows(); ++r) {
        left = std::max(left, norm(after[r]));
        size = std::max(size, norm(before[r]));
      }
      EXPECT_LT(left, 1e-6 * size) << "width " << width << ", share " << share;
    }
}

TEST(Constraint, ByIterationMultipliersAreTheSameForces) {
  for (const double share : {0.0, 0.4})
    for (const double width : {0.0, 0.9}) {
      Bar model = barWith(ConstraintKind::multiplier, width, share);
      const Bar& c = model;
      const auto iterative = makeIterativeMultiplier(c.gap, c.overlap, model.particles.mass, model.mass());
      std::mt19937 random(12);
      std::vector<Vec3> a(model.particles.size()), b(model.nodes().X.size()), gap(c.rows()), none(c.rows()),
          direct(c.rows()), other(c.rows());
      for (auto* values : {&a, &b})
        for (Vec3& v : *values) v = randomVector(random, 1.0);
      for (std::size_t n = 0; n < b.size(); ++n)
        if (model.nodes().fixed[n]) b[n] = {};
      gapOf(c.gap, c.overlap, a, b, gap);
      c.constraint->evaluate({none, none, none, gap, 1.0}, direct);
      iterative->evaluate({none, none, none, gap, 1.0}, other);
      std::vector<Vec3> f(a.size()), g(a.size());
      pullParticles(c.gap, c.overlap, direct, f);
      pullParticles(c.gap, c.overlap, other, g);
      double difference = 0.0, size = 0.0;
      for (std::size_t i = 0; i < f.size(); ++i) {
        difference = std::max(difference, norm(f[i] - g[i]));
        size = std::max(size, norm(f[i]));
      }
      EXPECT_LT(difference, (width == 0.0 ? 1e-8 : 1e-5) * size) << "width " << width << ", share " << share;
    }
}

TEST(Constraint, DashpotsLoseWhateverTheIncrement) {
  const Bar model = barWith(ConstraintKind::dashpot, 0.0);
  const Bar& c = model;
  for (const bool consistent : {false, true}) {
    const auto dashpot = makeDashpot(c.gap, 1e8, consistent);
    for (unsigned seed = 0; seed < 20; ++seed) {
      const std::vector<Vec3> increment = randomRows(c, seed);
      std::vector<Vec3> lambda(c.rows());
      dashpot->evaluate({{}, increment, {}, {}, 1.0}, lambda);
      double lost = 0.0;
      for (std::size_t r = 0; r < c.rows(); ++r) lost += dot(lambda[r], increment[r]);
      EXPECT_GT(lost, 0.0);
      EXPECT_EQ(dashpot->storedEnergy(increment), 0.0);
    }
  }
}

TEST(Constraint, LumpedDashpotsAreTheRowSumsOfConsistentOnes) {
  const Bar model = barWith(ConstraintKind::dashpot, 0.0);
  const Bar& c = model;
  const std::vector<Vec3> same(c.rows(), Vec3{1e-4, 2e-4, -1e-4});
  std::vector<Vec3> lumped(c.rows()), consistent(c.rows());
  makeDashpot(c.gap, 1e8, false)->evaluate({{}, same, {}, {}, 1.0}, lumped);
  makeDashpot(c.gap, 1e8, true)->evaluate({{}, same, {}, {}, 1.0}, consistent);
  for (std::size_t r = 0; r < c.rows(); ++r) EXPECT_LT(norm(lumped[r] - consistent[r]), 1e-12 * norm(lumped[r]));
}

TEST(Constraint, ImpossiblePenaltiesAreRefused) {
  const Bar model = barWith(ConstraintKind::penalty, 0.0);
  for (const double p : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(makePenalty({1.0, p}), InputError);
    EXPECT_THROW(makeDashpot(model.gap, p, false), InputError);
  }
}

}  // namespace
}  // namespace dovetail::arlequin
