#include <algorithm>
#include <numbers>

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

}  // namespace
}  // namespace dovetail::fem
