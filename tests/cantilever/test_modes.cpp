#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "dovetail/core/error.hpp"
#include "reference/beam_modes.hpp"
#include "reference/legendre.hpp"
#include "reference/mode_table.hpp"
#include "reference/static_reference.hpp"

namespace dovetail::cantilever {
namespace {

constexpr BeamTheory bernoulli{.supports = Supports::clampedFree, .shear = false, .rotaryInertia = false, .basis = 40};
constexpr double pi = std::numbers::pi;

// (βL)² = ω L² √(ρA / EI)
double betaLength(const BeamModes& modes, const Section& section, int j) {
  return std::sqrt(modes.omega[j] * std::sqrt(section.mass / section.bending)) * modes.length;
}

TEST(Legendre, IntegralsAndDerivativesAgreeWithEachOther) {
  LegendreFamily here(12), after(12);
  const double h = 1e-5;
  for (double xi : {0.0, 0.13, 0.5, 0.77, 1.0 - 2 * h}) {
    here.evaluate(xi);
    after.evaluate(xi + h);
    LegendreFamily middle(12);
    middle.evaluate(xi + 0.5 * h);
    for (int order = -1; order <= 2; ++order)
      for (int k = 0; k < 12; ++k)
        EXPECT_NEAR((after(order, k) - here(order, k)) / h, middle(order - 1, k),
                    2e-6 * (1.0 + std::abs(middle(order - 1, k))));
  }
}

TEST(Legendre, GaussRuleIsExactToItsDegree) {
  const GaussRule rule = gaussRule(9);
  for (int degree = 0; degree <= 17; ++degree) {
    double sum = 0.0;
    for (int g = 0; g < 9; ++g) sum += rule.weight[g] * std::pow(rule.point[g], degree);
    EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-15);
  }
}

TEST(BeamModes, BernoulliCantileverHasTheKnownRoots) {
  const Section section = makeSection(BeamCase{});
  const BeamModes modes = computeModes(section, 12.0, bernoulli, 16);
  const double known[] = {1.875104068711961, 4.694091132974175, 7.854757438237613, 10.99554073487547};
  for (int j = 0; j < 4; ++j) EXPECT_NEAR(betaLength(modes, section, j), known[j], 1e-10);
  for (int j = 4; j < 16; ++j) {  // cosh x cos x + 1 = 0, divided by cosh x
    const double x = betaLength(modes, section, j);
    EXPECT_NEAR(std::cos(x) + 1.0 / std::cosh(x), 0.0, 1e-8) << "mode " << j + 1;
  }
}

TEST(BeamModes, BernoulliSimplySupportedRootsAreMultiplesOfPi) {
  const Section section = makeSection(BeamCase{});
  BeamTheory theory = bernoulli;
  theory.supports = Supports::simplySupported;
  const BeamModes modes = computeModes(section, 12.0, theory, 12);
  for (int j = 0; j < 12; ++j) EXPECT_NEAR(betaLength(modes, section, j), (j + 1) * pi, 1e-9);
}

// State (w, θ, M, Q) along the beam at frequency ω: w' = θ + Q/κGA, θ' = M/EI, M' = −Q − ρIω²θ, Q' = −ρAω²w.
Eigen::Matrix4d transferMatrix(const Section& s, double length, double omega) {
  const double o2 = omega * omega;
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(0, 1) = 1.0;
  a(0, 3) = 1.0 / s.shear;
  a(1, 2) = 1.0 / s.bending;
  a(2, 1) = -s.rotaryMass * o2;
  a(2, 3) = -1.0;
  a(3, 0) = -s.mass * o2;
  const Eigen::Vector4d scale(1.0, 1.0, s.bending, s.bending);  // balances the entries
  a = scale.cwiseInverse().asDiagonal() * a * scale.asDiagonal();
  a *= length / 1024.0;
  Eigen::Matrix4d term = Eigen::Matrix4d::Identity(), sum = term;
  for (int k = 1; k < 20; ++k) sum += term = term * a / k;
  for (int k = 0; k < 10; ++k) sum = sum * sum;
  return sum;
}

// Exact natural frequency nearest to the guess: root of the determinant of the two end conditions.
double exactFrequency(const Section& section, double length, Supports supports, double guess) {
  const auto determinant = [&](double omega) {
    const Eigen::Matrix4d t = transferMatrix(section, length, omega);
    if (supports == Supports::clampedFree) return t(2, 2) * t(3, 3) - t(2, 3) * t(3, 2);  // w = θ = 0; M = Q = 0
    return t(0, 1) * t(2, 3) - t(0, 3) * t(2, 1);                                         // w = M = 0 at both ends
  };
  double lower = guess * (1.0 - 1e-4), upper = guess * (1.0 + 1e-4);
  const double atLower = determinant(lower);
  if (atLower * determinant(upper) > 0.0) return std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (lower + upper);
    (determinant(middle) * atLower > 0.0 ? lower : upper) = middle;
  }
  return 0.5 * (lower + upper);
}

TEST(BeamModes, TimoshenkoFrequenciesSolveTheExactFrequencyEquation) {
  const Section section = makeSection(BeamCase{});
  for (Supports supports : {Supports::clampedFree, Supports::simplySupported}) {
    const BeamModes modes = computeModes(section, 12.0, {.supports = supports}, 16);
    for (int j = 0; j < 16; ++j)
      EXPECT_NEAR(exactFrequency(section, 12.0, supports, modes.omega[j]) / modes.omega[j], 1.0, 1e-8)
          << "mode " << j + 1;
  }
}

TEST(BeamModes, TimoshenkoSimplySupportedFollowsTheClosedForm) {
  // w = sin kx, θ = A cos kx: (κGA k² − ρA ω²)(EI k² + κGA − ρI ω²) = (κGA k)²; a stocky beam for a large effect
  const Section s = makeSection({.length = 3.0});
  const BeamModes modes = computeModes(s, 3.0, {.supports = Supports::simplySupported}, 3);
  for (int j = 0; j < 3; ++j) {
    const double k = (j + 1) * pi / 3.0;
    const double b = s.mass * (s.bending * k * k + s.shear) + s.rotaryMass * s.shear * k * k;
    const double c = s.shear * s.bending * k * k * k * k;
    const double a = s.mass * s.rotaryMass;
    const double omegaSquared = 2.0 * c / (b + std::sqrt(b * b - 4.0 * a * c));
    EXPECT_NEAR(modes.omega[j] / std::sqrt(omegaSquared), 1.0, 1e-10);
  }
}

TEST(BeamModes, AllModesTogetherHaveTheStaticCompliance) {
  const BeamCase beam;
  const Section section = makeSection(beam);
  BeamTheory theory = bernoulli;
  for (bool shear : {false, true}) {
    theory.shear = theory.rotaryInertia = shear;
    const BeamModes modes = computeModes(section, beam.length, theory, theory.basis);
    const Eigen::VectorXd tip = evaluateModes(modes, beam.length).deflection.col(0);
    double compliance = 0.0;
    for (int j = 0; j < theory.basis; ++j) compliance += std::pow(tip[j] / modes.omega[j], 2);
    // With shear, half of the unknowns' modes are left out: shear's share converges as 1 / modes.
    EXPECT_NEAR(compliance / staticDeflection(section, 1.0, beam.length, shear), 1.0, shear ? 1e-4 : 1e-6);
  }
}

TEST(BeamModes, ImpossibleRequestsAreRefused) {
  const Section section = makeSection(BeamCase{});
  EXPECT_THROW(computeModes(section, 12.0, bernoulli, 41), InputError);
  EXPECT_THROW(computeModes(section, 12.0, {.basis = 1}, 1), InputError);
  EXPECT_THROW(makeSection({.density = -1.0}), InputError);
  EXPECT_THROW(makeSection({.poissonRatio = 0.5}), InputError);
  EXPECT_THROW(makeSection({.particles = 0}), InputError);
}

TEST(ModeTable, ReproducesTheModesAndTheirSlopes) {
  const BeamModes modes = computeModes(makeSection(BeamCase{}), 12.0, BeamTheory{}, 24);
  const ModeTable table(modes, 600, false);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> anywhere(0.0, 12.0);
  BeamCell cell;
  for (int trial = 0; trial < 20; ++trial) {
    const double s = anywhere(generator);
    const ModeShapes exact = evaluateModes(modes, s);
    for (int j = 0; j < 24; ++j) {
      table.loadCell(s, Eigen::VectorXd::Unit(24, j), cell);
      const BeamFields fields = table.fields(cell, s);
      const double k = 2.0 * pi;  // 1/m, above the highest wave number here
      EXPECT_NEAR(fields.vertical[0], exact.deflection(j, 0), 1e-9 * 0.02);
      EXPECT_NEAR(fields.vertical[1], exact.deflection(j, 1), 1e-7 * 0.02 * k);
      EXPECT_NEAR(fields.rotation[0], exact.rotation(j, 0), 1e-9 * 0.02 * k);
      EXPECT_NEAR(fields.rotation[1], exact.rotation(j, 1), 1e-7 * 0.02 * k * k);
    }
  }
}

TEST(ModeTable, LargeRotationsKeepTheAxisInextensible) {
  const BeamModes modes = computeModes(makeSection(BeamCase{}), 12.0, BeamTheory{}, 10);
  const ModeTable table(modes, 100, true);
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  Eigen::VectorXd q(10);
  for (int j = 0; j < 10; ++j) q[j] = normal(generator) / (j + 1.0);
  const GaussRule rule = gaussRule(60);
  BeamCell cell;
  for (double s : {0.0, 1.234, 6.0, 11.9, 12.0}) {
    double axial = 0.0, vertical = 0.0;
    for (std::size_t g = 0; g < rule.point.size(); ++g) {
      const double angle = evaluateModes(modes, s * rule.point[g]).deflection.col(1).dot(q);
      axial += s * rule.weight[g] * (std::cos(angle) - 1.0);
      vertical += s * rule.weight[g] * std::sin(angle);
    }
    table.loadCell(s, q, cell);
    const BeamFields fields = table.fields(cell, s);
    EXPECT_NEAR(fields.axial[0], axial, 1e-7 * std::abs(axial));
    EXPECT_NEAR(fields.vertical[0], vertical, 1e-7 * std::abs(vertical) + 1e-12);
    EXPECT_NEAR(std::hypot(1.0 + fields.axial[1], fields.vertical[1]), 1.0, 1e-14);
  }
}

TEST(ModeTable, FieldsAreContinuousAcrossCells) {
  const BeamModes modes = computeModes(makeSection(BeamCase{}), 12.0, BeamTheory{}, 24);
  const ModeTable table(modes, 100, true);
  Eigen::VectorXd q(24);
  for (int j = 0; j < 24; ++j) q[j] = 10.0 / std::pow(j + 1.0, 3);
  BeamCell left, right;
  for (int c : {1, 37, 99}) {
    const double border = 0.12 * c;
    table.loadCell(border - 1e-6, q, left);
    table.loadCell(border + 1e-6, q, right);
    ASSERT_EQ(left.index + 1, right.index);
    const BeamFields before = table.fields(left, border), after = table.fields(right, border);
    for (int d = 0; d < 3; ++d) {
      EXPECT_NEAR(before.axial[d], after.axial[d], 1e-11);
      EXPECT_NEAR(before.vertical[d], after.vertical[d], 1e-11);
      EXPECT_NEAR(before.rotation[d], after.rotation[d], 1e-11);
    }
  }
}

}  // namespace
}  // namespace dovetail::cantilever
