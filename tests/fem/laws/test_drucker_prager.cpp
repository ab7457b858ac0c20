#include <algorithm>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "plastic_laws.hpp"

namespace dovetail::fem {
namespace {

TEST(DruckerPrager, EndsOnTheConeOrAtItsApex) {
  std::mt19937 random(8);
  for (const auto& [friction, dilatancy] : {std::pair(0.5, 0.5), {0.6, 0.2}, {0.6, 0.0}, {0.0, 0.0}}) {
    const DruckerPrager law = soil(friction, dilatancy);
    const ConeConstants cone = coneConstants(law);
    const MaterialPointer material = pointMaterial(law);
    int apices = 0, cones = 0;
    for (int i = 0; i < 200; ++i) {
      const Eigen::Matrix3d F = randomGradient(random, 0.1);
      const PointResult result = evaluate(*material, F);
      if (result.dissipated == 0.0) continue;
      const Eigen::Matrix3d tau = kirchhoff(result, F);
      const double p = tau.trace() / 3.0, root = deviatorOf(tau).norm() / std::numbers::sqrt2;
      EXPECT_NEAR(root + cone.friction * p, cone.strength, 1e-10 * law.youngsModulus);
      (root > 1e-8 * law.youngsModulus ? cones : apices) += 1;
      // Volume grows by η̄ per shear on the cone.
      const double shear = plasticStrain(result.history) * std::sqrt(3.0);
      if (root > 1e-8 * law.youngsModulus) {
        EXPECT_NEAR(std::log(plasticVolume(result.history)), cone.dilatancy * shear, 1e-10);
      }
    }
    EXPECT_GT(cones, 50);
    EXPECT_EQ(apices > 0, friction > 0.0);
  }
}

/// Mohr and Coulomb's function of principal stresses, tension positive: 0 at yield.
double mohrCoulomb(Eigen::Vector3d s, double cohesion, double phi) {
  std::sort(s.begin(), s.end());
  return (s[2] - s[0]) + (s[2] + s[0]) * std::sin(phi) - 2.0 * cohesion * std::cos(phi);
}

TEST(DruckerPrager, MeetsMohrAndCoulombWhereItSays) {
  const double phi = 0.55;
  for (const auto& [match, side] : {std::pair(ConeMatch::compression, -1.0), {ConeMatch::extension, 1.0}}) {
    const DruckerPrager law = soil(phi, phi, match);
    const MaterialPointer material = pointMaterial(law);
    // Triaxial paths: compression pushes the axis further than the sides, extension the sides further than the axis.
    const Eigen::Matrix3d F = side < 0.0 ? stretches(0.9, 1.04, 1.04) : stretches(1.08, 0.95, 0.95);
    const PointResult result = evaluate(*material, F);
    ASSERT_GT(result.dissipated, 0.0);
    EXPECT_NEAR(mohrCoulomb(kirchhoff(result, F).diagonal(), law.cohesion, phi), 0.0, 1e-9 * law.cohesion);
  }
}

TEST(DruckerPrager, FlowsInPlaneStrainAtMohrAndCoulombsLoad) {
  const double phi = 0.4;
  const DruckerPrager law = soil(phi, phi, ConeMatch::planeStrain);
  const MaterialPointer material = pointMaterial(law);
  std::vector<double> history = freshHistory(*material);
  Eigen::Vector3d stress;
  double side = 1.0;
  for (int k = 1; k <= 400; ++k) {
    const double stretch = 1.0 - 0.0005 * k;
    for (int i = 0; i < 40; ++i) {  // the second side is free, the third is held
      const PointResult trial = evaluate(*material, stretches(stretch, side, 1.0), history);
      side -= trial.P(1, 1) / trial.tangent(4, 4);
    }
    const Eigen::Matrix3d F = stretches(stretch, side, 1.0);
    const PointResult result = evaluate(*material, F, history);
    history = result.history;
    stress = kirchhoff(result, F).diagonal();
  }
  EXPECT_NEAR(stress[1], 0.0, 1e-6 * law.cohesion);
  EXPECT_NEAR(mohrCoulomb(stress, law.cohesion, phi) / law.cohesion, 0.0, 1e-3);
}

/// Drained triaxial compression: equal pressure first, then the axis is pushed while the sides keep their Kirchhoff
/// stress. Along that straight path of stress the direction of flow is constant, so that stress and strain follow from
/// the plastic strain a in closed form, for any curve of the cohesion.
struct Triaxial {
  DruckerPrager law;
  double pressure;
  double a = 0.0;  ///< plastic strain

  double deviator() const {
    const ConeConstants cone = coneConstants(law);
    const double strength = cone.cohesive * law.cohesionCurve.stress(a);
    return (strength + cone.friction * pressure) / (1.0 / std::numbers::sqrt3 - cone.friction / 3.0);
  }
  /// Logarithmic strains of axis and volume.
  double axial() const {
    const double flow = std::numbers::sqrt3 * a;
    return -pressure * (1.0 - 2.0 * law.poissonRatio) / law.youngsModulus - deviator() / law.youngsModulus +
           flow * (coneConstants(law).dilatancy / 3.0 - 1.0 / std::numbers::sqrt3);
  }
  double volume() const {
    return -(3.0 * pressure + deviator()) * (1.0 - 2.0 * law.poissonRatio) / law.youngsModulus +
           std::numbers::sqrt3 * a * coneConstants(law).dilatancy;
  }
};

TEST(DruckerPrager, FollowsTheDrainedTriaxialPathOfItsCohesionCurve) {
  for (const YieldCurve& curve :
       {hardeningCohesion(), softeningCohesion(), tabulatedYield({{0.0, 0.2e6}, {0.01, 0.3e6}, {0.03, 0.2e6}})})
    for (const auto& [friction, dilatancy] : {std::pair(0.5, 0.5), {0.6, 0.2}, {0.6, 0.0}}) {
      Triaxial exact{ageingSoil(friction, dilatancy, curve), 0.4e6};
      const MaterialPointer material = pointMaterial(exact.law);
      std::vector<double> history = freshHistory(*material);
      const double start = exact.pressure * (1.0 - 2.0 * exact.law.poissonRatio) / exact.law.youngsModulus;
      double side = std::exp(-start);
      for (int step = 1; step <= 100; ++step) {
        const double axis = std::exp(-start - 0.001 * step);
        double narrow = 0.99 * side, wide = 1.01 * side;
        for (int i = 0; i < 50; ++i) {
          side = 0.5 * (narrow + wide);
          const PointResult trial = evaluate(*material, stretches(axis, side, side), history);
          (trial.P(1, 1) * side < -exact.pressure ? narrow : wide) = side;
        }
        const Eigen::Matrix3d F = stretches(axis, side, side);
        const PointResult result = evaluate(*material, F, history);
        history = result.history;
        exact.a = plasticStrain(history);
        if (exact.a == 0.0) continue;
        const Eigen::Vector3d stress = kirchhoff(result, F).diagonal();
        ASSERT_NEAR(stress[1], -exact.pressure, 1e-8 * exact.pressure);
        EXPECT_NEAR(stress[1] - stress[0], exact.deviator(), 1e-8 * exact.deviator());
        EXPECT_NEAR(std::log(axis), exact.axial(), 1e-8);
        EXPECT_NEAR(std::log(axis * side * side), exact.volume(), 1e-8);
      }
      EXPECT_GT(exact.a, 0.02);
    }
}

TEST(DruckerPrager, ApexMovesWithTheCohesion) {
  const DruckerPrager law = ageingSoil(0.6, 0.2, softeningCohesion());
  const ConeConstants cone = coneConstants(law);
  const MaterialPointer material = pointMaterial(law);
  const std::vector<double> sheared = evaluate(*material, stretches(0.97, 1.02, 1.02)).history;
  const Eigen::Matrix3d F = 1.1 * stretches(1.01, 1.0, 0.99);
  const PointResult result = evaluate(*material, F, sheared);
  const Eigen::Matrix3d tau = kirchhoff(result, F);
  const double a = plasticStrain(result.history);
  EXPECT_GT(a, plasticStrain(sheared));
  EXPECT_NEAR(tau.trace() / 3.0, cone.cohesive * law.cohesionCurve.stress(a) / cone.friction, 1e-9 * law.youngsModulus);
  EXPECT_LT(deviatorOf(tau).norm(), 1e-9 * law.youngsModulus);
  EXPECT_LT((result.tangent - differencedTangent(*material, F, sheared, 0.0, 1e-4)).norm(),
            1e-6 * result.tangent.norm());
}

TEST(DruckerPrager, RefusesImpossibleCohesion) {
  DruckerPrager law = soil(0.5, 0.2);
  law.cohesionCurve = softeningCohesion();
  EXPECT_THROW(pointMaterial(law), InputError);  // and a cohesion
  law.cohesion = 0.0;
  law.cohesionCurve.slope = nullptr;
  EXPECT_THROW(pointMaterial(law), InputError);
  law.cohesionCurve = saturatingYield(1e6, 0.0, 1e3, 1e3);
  EXPECT_THROW(pointMaterial(law), InputError);  // falls too fast
}

}  // namespace
}  // namespace dovetail::fem
