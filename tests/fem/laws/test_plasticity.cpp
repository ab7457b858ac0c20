#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/laws/materials.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "plastic_laws.hpp"

namespace dovetail::fem {
namespace {

TEST(Plasticity, TangentIsTheDerivativeOfTheStress) {
  std::mt19937 random(1);
  for (const auto& [name, material] : laws())
    for (int i = 0; i < 20; ++i) {
      Eigen::Matrix3d F;
      const std::vector<double> history = loaded(*material, random, F);
      const Eigen::Matrix3d next = (Eigen::Matrix3d::Identity() + randomMatrix(random, i % 2 ? 0.05 : 0.2)) * F;
      const PointResult result = evaluate(*material, next, history);
      const Matrix9 tangent = result.tangent;
      EXPECT_LT((tangent - differencedTangent(*material, next, history, 0.0, 1e-5)).norm(), 1e-6 * tangent.norm())
          << name;
      if (material->isSymmetric()) {
        EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-12 * tangent.norm()) << name;
      }
    }
}

TEST(Plasticity, TangentWithEqualStretches) {
  for (const auto& [name, material] : laws())
    for (const double apart : {0.0, 1e-12, 1e-8, 1e-5, 1e-3}) {
      const Eigen::Matrix3d F = rotation(1.0, {1, 2, 3}) * stretches(1.1, 1.1 + apart, 0.7);
      const PointResult result = evaluate(*material, F);
      EXPECT_GT(result.dissipated, 0.0);
      EXPECT_LT((result.tangent - differencedTangent(*material, F, freshHistory(*material), 0.0, 1e-3)).norm(),
                1e-8 * result.tangent.norm())
          << name << " " << apart;
    }
}

TEST(Plasticity, SaysWhetherItsTangentIsSymmetric) {
  std::mt19937 random(2);
  for (const auto& [name, material] : laws()) {
    EXPECT_FALSE(material->isElastic());
    double asymmetry = 0.0;
    for (int i = 0; i < 10; ++i) {
      Eigen::Matrix3d F;
      const std::vector<double> history = loaded(*material, random, F);
      const Eigen::Matrix3d next = (Eigen::Matrix3d::Identity() + randomMatrix(random, 0.1)) * F;
      const Matrix9 tangent = evaluate(*material, next, history).tangent;
      asymmetry = std::max(asymmetry, (tangent - tangent.transpose()).norm() / tangent.norm());
    }
    EXPECT_EQ(asymmetry < 1e-10, material->isSymmetric()) << name << " " << asymmetry;
  }
}

TEST(Plasticity, BeforeYieldItIsHencky) {
  std::mt19937 random(3);
  const MaterialPointer elastic = pointMaterial(Hencky{young, nu, rho});
  for (const MaterialPointer& material : {pointMaterial(steel()), pointMaterial(steel(20e9))}) {
    const Eigen::Matrix3d F = randomRotation(random) * (Eigen::Matrix3d::Identity() + randomMatrix(random, 1e-3));
    const PointResult result = evaluate(*material, F), expected = evaluate(*elastic, F);
    EXPECT_EQ(result.history, freshHistory(*material));
    EXPECT_LT((result.P - expected.P).norm(), 1e-14 * young);
    EXPECT_LT((result.tangent - expected.tangent).norm(), 1e-12 * young);
    EXPECT_NEAR(result.energy, expected.energy, 1e-14 * young);
  }
}

TEST(Plasticity, TurningThePointTurnsTheStress) {
  std::mt19937 random(4);
  for (const auto& [name, material] : laws()) {
    Eigen::Matrix3d F;
    const std::vector<double> history = loaded(*material, random, F);
    const Eigen::Matrix3d next = (Eigen::Matrix3d::Identity() + randomMatrix(random, 0.1)) * F;
    const Eigen::Matrix3d R = randomRotation(random);
    const PointResult bare = evaluate(*material, next, history), turned = evaluate(*material, R * next, history);
    EXPECT_LT((turned.P - R * bare.P).norm(), 1e-12 * bare.tangent.norm() + 1e-6) << name;
    EXPECT_NEAR(turned.energy, bare.energy, 1e-12 * bare.tangent.norm() + 1e-6);
    for (std::size_t k = 0; k < bare.history.size(); ++k) EXPECT_NEAR(turned.history[k], bare.history[k], 1e-12);
  }
}

/// What flow alone changes of a history: not the elastic strain of volume, which soils remember.
std::vector<double> flowOf(std::vector<double> history) {
  if (history.size() == 11) history.pop_back();
  return history;
}

TEST(Plasticity, UnloadingIsElastic) {
  std::mt19937 random(5);
  for (const auto& [name, material] : laws()) {
    // Coaxial, so that the back stress of the last step holds exactly.
    const Eigen::Matrix3d F = stretches(0.9, 1.06, 1.03);
    const PointResult loadedPoint = evaluate(*material, F);
    ASSERT_GT(plasticStrain(loadedPoint.history), 0.0) << name;
    // A frictional point unloads under more pressure.
    const Eigen::Matrix3d back = 0.9995 * stretches(0.9004, 1.06, 1.03);
    const PointResult unloaded = evaluate(*material, back, loadedPoint.history);
    EXPECT_EQ(flowOf(unloaded.history), flowOf(loadedPoint.history)) << name;
    EXPECT_EQ(unloaded.dissipated, 0.0);
    const Eigen::Matrix3d again = kirchhoff(evaluate(*material, F, loadedPoint.history), F);
    EXPECT_LT((again - kirchhoff(loadedPoint, F)).norm(), 1e-12 * loadedPoint.tangent.norm());
  }
}

TEST(Plasticity, LargeStepsAndTurnsHaveAnAnswerOnTheYieldSurface) {
  std::mt19937 random(6);
  const J2Plasticity metal = steel();
  for (int i = 0; i < 300; ++i) {
    const MaterialPointer material = pointMaterial(metal);
    std::vector<double> history = freshHistory(*material);
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    for (int k = 0; k < 5; ++k) {
      F = rotation(0.5 * std::numbers::pi, randomMatrix(random, 1.0).col(0)) *
          (Eigen::Matrix3d::Identity() + randomMatrix(random, 0.2)) * F;
      const PointResult result = evaluate(*material, F, history);
      ASSERT_TRUE(result.P.allFinite() && result.tangent.allFinite());
      EXPECT_GE(result.dissipated, 0.0);
      EXPECT_LE(misesOf(kirchhoff(result, F)), metal.yield.stress(plasticStrain(result.history)) * (1.0 + 1e-10));
      EXPECT_NEAR(plasticVolume(result.history), 1.0, 1e-13);
      history = result.history;
    }
    EXPECT_GT(plasticStrain(history), 0.2);
  }
}

TEST(Plasticity, DissipationIsNeverNegative) {
  std::mt19937 random(7);
  for (const auto& [name, material] : laws())
    for (int path = 0; path < 40; ++path) {
      std::vector<double> history = freshHistory(*material);
      Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
      for (int k = 0; k < 30; ++k) {
        F = (Eigen::Matrix3d::Identity() + randomMatrix(random, 0.05)) * F;
        if (!(F.determinant() > 0.3)) break;
        const PointResult result = evaluate(*material, F, history);
        ASSERT_GE(result.dissipated, 0.0) << name;
        ASSERT_GE(plasticStrain(result.history), plasticStrain(history)) << name;
        history = result.history;
      }
    }
}

/// |work − stored − dissipated| over a path in `steps` steps, relative to the work.
double imbalance(const PointMaterial& material, int steps) {
  std::vector<double> history = freshHistory(material);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero(), F = Eigen::Matrix3d::Identity();
  double work = 0.0, dissipated = 0.0, stored = 0.0;
  for (int k = 1; k <= steps; ++k) {
    const double s = static_cast<double>(k) / steps;
    const double thin = 1.0 - 0.2 * s, wide = 1.0 + 0.1 * std::sin(5.0 * s);
    Eigen::Matrix3d next = rotation(s, {1, -1, 2}) * stretches(thin, wide, 1.0 / (thin * wide));
    next(0, 1) += 0.3 * std::sin(3.0 * s);
    const PointResult result = evaluate(material, next, history);
    work += 0.5 * (P + result.P).cwiseProduct(next - F).sum();
    dissipated += result.dissipated;
    stored = result.energy;
    history = result.history;
    P = result.P;
    F = next;
  }
  EXPECT_GT(dissipated, 0.04 * std::abs(work));
  return std::abs(work - stored - dissipated) / std::abs(work);
}

/// The largest of a few numbers of steps: the step in which flow begins errs by where in it that is.
double largestImbalance(const PointMaterial& material, int steps) {
  double largest = 0.0;
  for (const int more : {0, 3, 7, 12}) largest = std::max(largest, imbalance(material, steps + more));
  return largest;
}

TEST(Plasticity, WorkIsStoredOrDissipatedToSecondOrderInTheStep) {
  for (const auto& [name, material] : laws()) {
    const double coarse = largestImbalance(*material, 150), fine = largestImbalance(*material, 600);
    EXPECT_LT(fine, 3e-5) << name;
    EXPECT_GT(std::log(coarse / fine) / std::log(4.0), 1.6) << name;
  }
}

/// Stretch of the sides at which they are free of stress, by Newton's method.
PointResult pulled(const PointMaterial& material, double stretch, const std::vector<double>& history, double& side) {
  for (int i = 0; i < 50; ++i) {
    const PointResult result = evaluate(material, stretches(stretch, side, side), history);
    const double slope = result.tangent(4, 4) + result.tangent(4, 8);
    const double change = result.P(1, 1) / slope;
    if (std::abs(change) < 1e-15) return result;
    side -= change;
  }
  ADD_FAILURE() << "the sides find no rest at the stretch " << stretch;
  return evaluate(material, stretches(stretch, side, side), history);
}

TEST(Plasticity, TensionFollowsTheYieldCurve) {
  const J2Plasticity law = steel();
  const MaterialPointer material = pointMaterial(law);
  std::vector<double> history = freshHistory(*material);
  double side = 1.0;
  for (int k = 1; k <= 40; ++k) {
    const double strain = 0.02 * k, stretch = std::exp(strain);
    const PointResult result = pulled(*material, stretch, history, side);
    history = result.history;
    // ε = σ_y(a)/E + a, whatever the steps
    const double a = plasticStrain(history), stress = law.yield.stress(a);
    EXPECT_NEAR(stress / young + a, strain, 1e-12);
    EXPECT_NEAR(result.P(0, 0) * stretch, stress, 1e-11 * stress);
    EXPECT_NEAR(result.energy, stress * stress / (2.0 * young) + law.yield.stored(a), 1e-10 * stress);
    EXPECT_NEAR(hardeningEnergy(law, history), law.yield.stored(a), 1e-12 * stress);
  }
}

TEST(Plasticity, KinematicHardeningYieldsEarlierOnTheWayBack) {
  const double modulus = 20e9;
  const MaterialPointer material = pointMaterial(J2Plasticity{young, nu, rho, linearYield(yieldStress), modulus});
  std::vector<double> history = freshHistory(*material);
  double side = 1.0, pulledStress = 0.0;
  // |σ − C ε_p| = σ_y: forward σ = σ_y + C ε_p, back σ = −σ_y + C ε_p, in Kirchhoff stress and logarithmic strain.
  const auto at = [&](double strain) {
    const PointResult result = pulled(*material, std::exp(strain), history, side);
    history = result.history;
    return result.P(0, 0) * std::exp(strain);
  };
  for (int k = 1; k <= 20; ++k) pulledStress = at(0.005 * k);
  const double plastic = 0.1 - pulledStress / young;
  EXPECT_NEAR(pulledStress, yieldStress + modulus * plastic, 1e-10 * young);
  const double turn = 0.1 - 2.0 * yieldStress / young, accumulated = plasticStrain(history);
  at(turn + 1e-6);
  EXPECT_EQ(plasticStrain(history), accumulated);
  at(turn - 1e-6);
  EXPECT_GT(plasticStrain(history), accumulated);
  for (int k = 1; k <= 40; ++k) {
    const double strain = turn - 0.005 * k, stress = at(strain), plasticNow = strain - stress / young;
    EXPECT_NEAR(stress, -yieldStress + modulus * plasticNow, 1e-10 * young);
  }
}

TEST(Plasticity, RecoveryBoundsTheBackStress) {
  const double modulus = 20e9, recovery = 20.0;
  const MaterialPointer material =
      pointMaterial(J2Plasticity{young, nu, rho, linearYield(yieldStress), modulus, recovery});
  std::vector<double> history = freshHistory(*material);
  double side = 1.0, stress = 0.0;
  for (int k = 1; k <= 2000; ++k) {
    const double strain = 0.0005 * k;
    const PointResult result = pulled(*material, std::exp(strain), history, side);
    history = result.history;
    stress = result.P(0, 0) * std::exp(strain);
    // X = C/γ (1 − e^(−γ ε_p)), to first order in the step
    const double back = modulus / recovery * (1.0 - std::exp(-recovery * (strain - stress / young)));
    if (plasticStrain(history) > 0.0) {
      EXPECT_NEAR(stress, yieldStress + back, 0.006 * modulus / recovery);
    }
  }
  EXPECT_NEAR(stress, yieldStress + modulus / recovery, 1e-6 * stress);
}

TEST(YieldCurve, SlopeAndStoredEnergyBelongToTheStress) {
  for (const YieldCurve& curve : {saturatingYield(2.0, 0.3, 5.0, 7.0), saturatingYield(2.0, 0.0, 1.0, 3.0),
                                  linearYield(3.0, 0.4), tabulatedYield({{0.0, 2.0}, {0.1, 3.0}, {0.5, 3.5}})})
    for (const double a : {0.05, 0.3, 0.9}) {
      const double h = 1e-5;
      EXPECT_NEAR(curve.slope(a), (curve.stress(a + h) - curve.stress(a - h)) / (2.0 * h), 1e-6);
      EXPECT_NEAR(curve.stress(a) - curve.stress(0.0), (curve.stored(a + h) - curve.stored(a - h)) / (2.0 * h), 1e-6);
      EXPECT_NEAR(curve.stored(0.0), 0.0, 1e-15);
    }
}

TEST(Plasticity, RefusesImpossibleConstants) {
  EXPECT_THROW(saturatingYield(0.0, 0.0, 1.0, 1.0), InputError);
  EXPECT_THROW(saturatingYield(1.0, -1.0, 1.0, 1.0), InputError);
  EXPECT_THROW(tabulatedYield({}), InputError);
  EXPECT_THROW(tabulatedYield({{0.1, 1.0}}), InputError);
  EXPECT_THROW(tabulatedYield({{0.0, 1.0}, {0.0, 2.0}}), InputError);
  EXPECT_THROW(pointMaterial(J2Plasticity{young, nu, rho, {}}), InputError);
  EXPECT_THROW(pointMaterial(J2Plasticity{young, 0.5, rho, linearYield(1.0)}), InputError);
  EXPECT_THROW(pointMaterial(J2Plasticity{young, nu, rho, linearYield(1.0), 0.0, 2.0}), InputError);
  EXPECT_THROW(pointMaterial(soil(0.3, 0.4)), InputError);
  EXPECT_THROW(pointMaterial(soil(30.0, 0.4)), InputError);
  EXPECT_THROW(pointMaterial(DruckerPrager{50e6, 0.25, 2000.0, 0.0, 0.0, 0.0}), InputError);
  EXPECT_THROW(pointMaterial(DruckerPrager{50e6, 0.25, 2000.0, -1.0, 0.3, 0.0}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
