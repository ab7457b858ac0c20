// Plastic laws for the tests.
#pragma once

#include <cmath>
#include <memory>
#include <string>

#include "dovetail/fem/laws/plasticity.hpp"
#include "point_helpers.hpp"

namespace dovetail::fem {

using MaterialPointer = std::shared_ptr<const PointMaterial>;
inline constexpr double young = 200e9, nu = 0.3, rho = 7800.0, yieldStress = 2e9;

struct Named {
  std::string name;
  MaterialPointer material;
};

inline J2Plasticity steel(double kinematic = 0.0, double recovery = 0.0) {
  return {young, nu, rho, saturatingYield(yieldStress, 1e9, 3e9, 12.0), kinematic, recovery};
}
inline DruckerPrager soil(double friction, double dilatancy, ConeMatch match = ConeMatch::compression) {
  return {50e6, 0.25, 2000.0, 0.3e6, friction, dilatancy, match};
}

/// Cohesion that changes with plastic strain.
inline DruckerPrager ageingSoil(double friction, double dilatancy, YieldCurve cohesion) {
  return {50e6, 0.25, 2000.0, 0.0, friction, dilatancy, ConeMatch::compression, std::move(cohesion)};
}
inline YieldCurve hardeningCohesion() { return saturatingYield(0.2e6, 2e6, 0.5e6, 20.0); }
inline YieldCurve softeningCohesion() { return saturatingYield(0.4e6, 0.0, 0.1e6, 15.0); }

inline std::vector<Named> laws() {
  return {{"isotropic", pointMaterial(steel())},
          {"perfect", pointMaterial(J2Plasticity{young, nu, rho, linearYield(yieldStress)})},
          {"kinematic", pointMaterial(steel(20e9))},
          {"recovering", pointMaterial(steel(20e9, 15.0))},
          {"associated", pointMaterial(soil(0.5, 0.5))},
          {"dilating", pointMaterial(soil(0.6, 0.2))},
          {"not dilating", pointMaterial(soil(0.6, 0.0, ConeMatch::extension))},
          {"without friction", pointMaterial(soil(0.0, 0.0))},
          {"hardening soil", pointMaterial(ageingSoil(0.6, 0.2, hardeningCohesion()))},
          {"softening soil", pointMaterial(ageingSoil(0.5, 0.1, softeningCohesion()))}};
}

/// A loaded history: some random steps.
inline std::vector<double> loaded(const PointMaterial& material, std::mt19937& random, Eigen::Matrix3d& F,
                                  int steps = 3) {
  std::vector<double> history = freshHistory(material);
  F = Eigen::Matrix3d::Identity();
  for (int i = 0; i < steps; ++i) {
    F = (Eigen::Matrix3d::Identity() + randomMatrix(random, 0.06)) * F;
    history = evaluate(material, F, history).history;
  }
  return history;
}

/// Kirchhoff stress.
inline Eigen::Matrix3d kirchhoff(const PointResult& result, const Eigen::Matrix3d& F) {
  return result.P * F.transpose();
}
inline Eigen::Matrix3d deviatorOf(const Eigen::Matrix3d& a) {
  return a - a.trace() / 3.0 * Eigen::Matrix3d::Identity();
}
inline double misesOf(const Eigen::Matrix3d& a) { return std::sqrt(1.5) * deviatorOf(a).norm(); }

}  // namespace dovetail::fem
