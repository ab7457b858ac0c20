#include "dovetail/core/error.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "plastic_laws.hpp"

namespace dovetail::fem {
namespace {

constexpr double dt = 1e-3;

std::vector<MaterialPointer> viscousMaterials() {
  std::vector<MaterialPointer> materials = {
      pointMaterial(kelvinVoigt(pointMaterial(neoHookean(3e6, 0.3, rho)), 5e-3, 3e6, 0.3)),
      pointMaterial(KelvinVoigt{pointMaterial(StVenantKirchhoff{3e6, 0.3, rho}), 0.0, 2e3})};
  for (const auto& [name, material] : laws()) materials.push_back(pointMaterial(kelvinVoigt(material, 1e-3, 1e9, 0.2)));
  return materials;
}

TEST(KelvinVoigt, TangentIsTheDerivativeOfTheStress) {
  std::mt19937 random(1);
  for (const MaterialPointer& material : viscousMaterials())
    for (int i = 0; i < 10; ++i) {
      Eigen::Matrix3d F;
      const std::vector<double> history = loaded(*material, random, F);
      const Eigen::Matrix3d next = (Eigen::Matrix3d::Identity() + randomMatrix(random, 0.05)) * F;
      for (const bool atEnd : {false, true}) {
        const PointResult result = evaluate(*material, next, history, dt, atEnd);
        EXPECT_LT((result.tangent - differencedTangent(*material, next, history, dt, 1e-5, atEnd)).norm(),
                  1e-6 * result.tangent.norm())
            << material->name();
        if (material->isSymmetric()) {
          EXPECT_LT((result.tangent - result.tangent.transpose()).norm(), 1e-12 * result.tangent.norm());
        }
      }
    }
}

TEST(KelvinVoigt, StressIsTheRateOfGreensStrain) {
  std::mt19937 random(2);
  const double bulk = 3e3, shear = 2e3;
  const MaterialPointer base = pointMaterial(neoHookean(3e6, 0.3, rho));
  const MaterialPointer material = pointMaterial(KelvinVoigt{base, bulk, shear});
  EXPECT_EQ(material->density(), rho);
  const Eigen::Matrix3d before = randomGradient(random, 0.2), after = randomGradient(random, 0.2);
  const std::vector<double> history = evaluate(*material, before, freshHistory(*material), dt).history;
  const PointResult result = evaluate(*material, after, history, dt), elastic = evaluate(*base, after);
  const Eigen::Matrix3d change = 0.5 * (after.transpose() * after - before.transpose() * before);
  const Eigen::Matrix3d S =
      (bulk * change.trace() * Eigen::Matrix3d::Identity() + 2.0 * shear * deviatorOf(change)) / dt;
  EXPECT_LT((result.P - elastic.P - after * S).norm(), 1e-12 * result.tangent.norm());
  EXPECT_NEAR(result.dissipated, S.cwiseProduct(change).sum(), 1e-12 * result.tangent.norm());
  EXPECT_EQ(result.energy, elastic.energy);
}

/// Along a path with steps that change their length by half: the stress at the end of the last one is of second order.
TEST(KelvinVoigt, RatesAtTheEndAreOfSecondOrder) {
  const double bulk = 3e3, shear = 2e3;
  const MaterialPointer base = pointMaterial(neoHookean(3e6, 0.3, rho));
  const MaterialPointer material = pointMaterial(KelvinVoigt{base, bulk, shear});
  std::mt19937 random(11);
  const Eigen::Matrix3d A = randomMatrix(random, 0.2), B = randomMatrix(random, 0.2), one = Eigen::Matrix3d::Identity();
  const auto F = [&](double t) -> Eigen::Matrix3d { return one + std::sin(t) * A + t * t * B; };
  const auto rate = [&](double t) -> Eigen::Matrix3d { return std::cos(t) * A + 2.0 * t * B; };
  const double end = 0.7;
  const Eigen::Matrix3d change = 0.5 * (F(end).transpose() * rate(end) + rate(end).transpose() * F(end));
  const Eigen::Matrix3d exact =
      F(end) * (bulk * change.trace() * one + 2.0 * shear * deviatorOf(change)) + evaluate(*base, F(end)).P;
  const auto errorOf = [&](double h, bool atEnd) {
    std::vector<double> history = evaluate(*material, F(end - 2.5 * h), freshHistory(*material)).history;
    history = evaluate(*material, F(end - h), history, 1.5 * h, atEnd).history;
    return (evaluate(*material, F(end), history, h, atEnd).P - exact).norm();
  };
  EXPECT_NEAR(std::log2(errorOf(2e-3, true) / errorOf(1e-3, true)), 2.0, 0.05);
  EXPECT_NEAR(std::log2(errorOf(2e-3, false) / errorOf(1e-3, false)), 1.0, 0.05);
}

TEST(KelvinVoigt, WithoutTimeThereIsNoViscousStress) {
  std::mt19937 random(3);
  for (const auto& [name, base] : laws()) {
    const MaterialPointer material = pointMaterial(KelvinVoigt{base, 1e9, 1e9});
    const Eigen::Matrix3d F = randomGradient(random, 0.1);
    const PointResult viscous = evaluate(*material, F), plain = evaluate(*base, F);
    EXPECT_EQ(viscous.P, plain.P);
    EXPECT_EQ(viscous.tangent, plain.tangent);
    EXPECT_EQ(viscous.dissipated, plain.dissipated);
    EXPECT_TRUE(std::equal(plain.history.begin(), plain.history.end(), viscous.history.begin() + 13));
  }
}

TEST(KelvinVoigt, RigidMotionIsNotResistedAndTurnsTheStress) {
  std::mt19937 random(4);
  const MaterialPointer material = viscousMaterials().front();
  const Eigen::Matrix3d F = randomGradient(random, 0.2), R = randomRotation(random);
  const std::vector<double> history = evaluate(*material, F, freshHistory(*material), dt).history;
  const PointResult rest = evaluate(*material, F, history, dt), turned = evaluate(*material, R * F, history, dt);
  EXPECT_LT((turned.P - R * rest.P).norm(), 1e-12 * rest.tangent.norm());
  EXPECT_NEAR(turned.dissipated, 0.0, 1e-12 * rest.tangent.norm());
  EXPECT_EQ(rest.dissipated, 0.0);
}

TEST(KelvinVoigt, DissipationIsNeverNegative) {
  std::mt19937 random(5);
  for (const MaterialPointer& material : viscousMaterials()) {
    std::vector<double> history = freshHistory(*material);
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    for (int k = 0; k < 200; ++k) {
      const Eigen::Matrix3d next = (Eigen::Matrix3d::Identity() + randomMatrix(random, 0.05)) * F;
      if (next.determinant() > 2.0 || next.determinant() < 0.5) continue;
      F = next;
      const PointResult result = evaluate(*material, F, history, dt);
      ASSERT_GE(result.dissipated, 0.0);
      history = result.history;
    }
  }
}

TEST(KelvinVoigt, CreepsWithItsRelaxationTime) {
  // Simple shear under a small dead stress: γ = s/μ (1 − e^(−t/τ)), to first order in the step.
  const double mu = 3e6 / 2.6, time = 5e-3, stress = 1e-6 * mu, step = 1e-5;
  const MaterialPointer material = viscousMaterials().front();
  std::vector<double> history = freshHistory(*material);
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  for (int k = 1; k <= 1000; ++k) {
    PointResult result = evaluate(*material, F, history, step);
    for (int i = 0; i < 3; ++i) {
      F(0, 1) += (stress - result.P(0, 1)) / result.tangent(1, 1);
      result = evaluate(*material, F, history, step);
    }
    history = result.history;
    EXPECT_NEAR(F(0, 1), stress / mu * (1.0 - std::exp(-step * k / time)), 1e-3 * stress / mu);
  }
}

TEST(KelvinVoigt, RefusesImpossibleConstants) {
  const MaterialPointer base = pointMaterial(neoHookean(3e6, 0.3, rho));
  EXPECT_THROW(pointMaterial(KelvinVoigt{nullptr, 1.0, 1.0}), InputError);
  EXPECT_THROW(pointMaterial(KelvinVoigt{base, -1.0, 1.0}), InputError);
  EXPECT_THROW(pointMaterial(KelvinVoigt{base, 1.0, -1.0}), InputError);
  EXPECT_THROW(kelvinVoigt(base, -1.0, 3e6, 0.3), InputError);
}

}  // namespace
}  // namespace dovetail::fem
