#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

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

Bar barWith(ConstraintKind kind, double width, double massFraction = 0.0) {
  SceneOptions o;
  o.coupling.constraint = kind;
  o.coupling.projection.width = width;
  o.coupling.penalty = kind == ConstraintKind::dashpot ? 1e8 : 0.0;
  o.massFraction = massFraction;
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
    EXPECT_TRUE(c.constraint->stores());
    const auto stored = [&] {
      std::vector<Vec3> forces(c.rows());
      c.constraint->evaluate({gap, {}, {}, {}, 1.0}, forces);
      double sum = 0.0;
      for (std::size_t r = 0; r < c.rows(); ++r) sum += 0.5 * dot(gap[r], forces[r]);
      return sum;
    };
    for (const std::size_t r : {std::size_t{0}, c.rows() / 2, c.rows() - 1})
      for (int k = 0; k < 3; ++k) {
        const double before = gap[r][k], step = 1e-5;
        gap[r][k] = before + step;
        const double above = stored();
        gap[r][k] = before - step;
        const double below = stored();
        gap[r][k] = before;
        EXPECT_NEAR(lambda[r][k], (above - below) / (2.0 * step), 1e-6 * norm(lambda[r]) + 1e-9);
        EXPECT_NEAR(tangent[r][k], lambda[r][k], 1e-12 * norm(lambda[r])) << "linear: λ is its own tangent";
      }
    EXPECT_GT(stored(), 0.0);
  }
}

TEST(Constraint, MultipliersTakeTheGapsAccelerationAway) {
  for (const double weight : {0.0, 0.4})
    for (const double width : {0.0, 0.9}) {
      Bar model = barWith(ConstraintKind::multiplier, width, weight);
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
      EXPECT_LT(left, 1e-6 * size) << "width " << width << ", share " << weight;
    }
}

/// A⁺ b by the eigenvalues of A scaled to a unit diagonal; those below 1e-8 of the largest count as zero.
Eigen::VectorXd solveDense(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  const Eigen::VectorXd scale = A.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(scale.asDiagonal() * A * scale.asDiagonal());
  const double least = 1e-8 * spectrum.eigenvalues().maxCoeff();
  const Eigen::VectorXd inverse =
      spectrum.eigenvalues().unaryExpr([&](double value) { return value > least ? 1.0 / value : 0.0; });
  const Eigen::MatrixXd& Q = spectrum.eigenvectors();
  return scale.asDiagonal() * (Q * (inverse.asDiagonal() * (Q.transpose() * (scale.asDiagonal() * b))));
}

Eigen::VectorXd component(std::span<const Vec3> values, int c) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(values.size()));
  for (std::size_t r = 0; r < values.size(); ++r) x[static_cast<Eigen::Index>(r)] = values[r][c];
  return x;
}

/// What λ does to the overlap's particles.
std::vector<Vec3> onParticles(const Bar& c, std::span<const Vec3> lambda) {
  std::vector<Vec3> f(c.particles.size());
  pullParticles(c.gap, c.overlap, lambda, f);
  return f;
}

double largest(std::span<const Vec3> values) {
  double most = 0.0;
  for (const Vec3& v : values) most = std::max(most, norm(v));
  return most;
}

std::vector<Vec3> difference(std::span<const Vec3> a, std::span<const Vec3> b) {
  std::vector<Vec3> d(a.size());
  for (std::size_t k = 0; k < d.size(); ++k) d[k] = a[k] - b[k];
  return d;
}

/// Accelerations of the gap under random forces.
std::vector<Vec3> randomRates(const Bar& c, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec3> a(c.particles.size()), b(c.nodes().X.size()), gap(c.rows());
  for (auto* values : {&a, &b})
    for (Vec3& v : *values) v = randomVector(random, 1.0);
  for (std::size_t n = 0; n < b.size(); ++n)
    if (c.nodes().fixed[n]) b[n] = {};
  gapOf(c.gap, c.overlap, a, b, gap);
  return gap;
}

TEST(Constraint, SparseMultipliersAreTheDenseOnes) {
  for (const double weight : {0.0, 0.4})
    for (const double width : {0.0, 0.9}) {
      const Bar c = barWith(ConstraintKind::multiplier, width, weight);
      const std::vector<Vec3> rates = randomRates(c, 12), none(c.rows());
      std::vector<Vec3> lambda(c.rows()), dense(c.rows());
      c.constraint->evaluate({none, none, none, rates, 1.0}, lambda);
      const auto rows = static_cast<Eigen::Index>(c.rows());
      Eigen::MatrixXd A(rows, rows);
      for (std::size_t r = 0; r < c.rows(); ++r) {
        std::vector<Vec3> unit(c.rows()), nodes(c.nodes().X.size()), answer(c.rows());
        unit[r].x = 1.0;
        std::vector<Vec3> particles = onParticles(c, unit);
        for (std::size_t i = 0; i < particles.size(); ++i) particles[i] *= 1.0 / c.particles.mass[i];
        pullNodes(c.gap, unit, nodes);
        c.mass().solve(nodes);
        gapOf(c.gap, c.overlap, particles, nodes, answer);
        A.col(static_cast<Eigen::Index>(r)) = -component(answer, 0);
      }
      A = (0.5 * (A + A.transpose())).eval();
      for (int k = 0; k < 3; ++k) {
        const Eigen::VectorXd x = solveDense(A, component(rates, k));
        for (std::size_t r = 0; r < c.rows(); ++r) dense[r][k] = x[static_cast<Eigen::Index>(r)];
      }
      const std::vector<Vec3> forces = onParticles(c, dense);
      EXPECT_LT(largest(difference(onParticles(c, lambda), forces)), 1e-10 * largest(forces))
          << "width " << width << ", share " << weight;
    }
}

TEST(Constraint, SparseMetricPenaltiesAreTheDenseOnes) {
  for (const double width : {0.3, 0.5, 0.9, 1.25}) {
    const Bar c = barWith(ConstraintKind::penalty, width);
    const std::vector<Vec3> gap = randomRates(c, 13);
    std::vector<Vec3> lambda(c.rows()), dense(c.rows());
    c.constraint->evaluate({gap, {}, {}, {}, 1.0}, lambda);
    const auto rows = static_cast<Eigen::Index>(c.rows());
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(c.overlap.size()));
    for (int r = 0; r < c.gap.particles.rows(); ++r)
      for (int k = c.gap.particles.offsets[r]; k < c.gap.particles.offsets[r + 1]; ++k)
        P(r, c.gap.particles.column[k]) = c.gap.particles.weight[k];
    const double springs = automaticPenalty(modulus, edge) * std::pow(edge / 2, 3);
    for (int k = 0; k < 3; ++k) {
      const Eigen::VectorXd x = solveDense(P * P.transpose() / springs, component(gap, k));
      for (std::size_t r = 0; r < c.rows(); ++r) dense[r][k] = x[static_cast<Eigen::Index>(r)];
    }
    const std::vector<Vec3> forces = onParticles(c, dense);
    EXPECT_LT(largest(difference(onParticles(c, lambda), forces)), 1e-10 * largest(forces)) << "width " << width;
  }
}

/// One particle in every element: there are more rows than particles.
TEST(Constraint, RowsThatDependOnEachOtherDoNoHarm) {
  for (const ConstraintKind kind : {ConstraintKind::penalty, ConstraintKind::multiplier})
    for (const double width : {0.0, 0.9}) {
      SceneOptions o;
      o.particlesPerEdge = 1;
      o.coupling.constraint = kind;
      o.coupling.projection.width = width;
      const Bar c = makeBar(o);
      const std::vector<Vec3> rates = randomRates(c, 14), none(c.rows());
      std::vector<Vec3> lambda(c.rows());
      c.constraint->evaluate({rates, none, none, rates, 1.0}, lambda);
      for (const Vec3& force : lambda) ASSERT_TRUE(isFinite(force));
      if (kind == ConstraintKind::penalty) continue;
      std::vector<Vec3> particles = onParticles(c, lambda), nodes(c.nodes().X.size()), answer(c.rows());
      for (std::size_t i = 0; i < particles.size(); ++i) particles[i] *= 1.0 / c.particles.mass[i];
      pullNodes(c.gap, lambda, nodes);
      c.mass().solve(nodes);
      gapOf(c.gap, c.overlap, particles, nodes, answer);
      for (std::size_t r = 0; r < c.rows(); ++r) answer[r] += rates[r];
      EXPECT_LT(largest(answer), 1e-8 * largest(rates)) << "width " << width;
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
      EXPECT_FALSE(dashpot->stores());
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
