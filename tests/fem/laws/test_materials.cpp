#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

constexpr double young = 3.0e6, nu = 0.3;
const LameConstants lame = lameConstants(young, nu);

/// P of a box in the uniform state F.
Eigen::Matrix3d stressAt(const Eigen::Matrix3d& F, Formulation formulation, const Material& material, bool distorted) {
  SolidScene scene = sceneOf(testMesh({2, 2, 2}, distorted), formulation, material);
  setAffine(scene.model.nodes, F);
  return meanFirstStress(scene);
}

template <class Check>
void forEachBrick(Check&& check) {
  for (const Formulation formulation : brickFormulations)
    for (const bool distorted : {false, true})
      check([=](const Eigen::Matrix3d& F) {
        return stressAt(F, formulation, StVenantKirchhoff{young, nu, 1.0}, distorted);
      });
}

Eigen::Matrix3d diagonal(double a, double b, double c) { return Eigen::Vector3d(a, b, c).asDiagonal(); }

TEST(StVenantKirchhoff, UniaxialWithFreeSides) {
  forEachBrick([](auto stress) {
    for (const double stretch : {0.8, 1.1, 1.4}) {
      const double side = std::sqrt(1.0 - nu * (stretch * stretch - 1.0));
      const Eigen::Matrix3d P = stress(diagonal(side, stretch, side));
      const Eigen::Matrix3d expected = diagonal(0.0, young * stretch * (stretch * stretch - 1.0) / 2.0, 0.0);
      EXPECT_LT((P - expected).norm(), 1e-12 * young);
    }
  });
}

TEST(StVenantKirchhoff, Confined) {
  forEachBrick([](auto stress) {
    for (const double stretch : {0.8, 1.3}) {
      const double change = stretch * stretch - 1.0;
      const Eigen::Matrix3d P = stress(diagonal(1.0, 1.0, stretch));
      EXPECT_NEAR(P(2, 2), (lame.lambda + 2.0 * lame.mu) * stretch * change / 2.0, 1e-12 * young);
      EXPECT_NEAR(P(0, 0), lame.lambda * change / 2.0, 1e-12 * young);
    }
  });
}

TEST(StVenantKirchhoff, SimpleShear) {
  forEachBrick([](auto stress) {
    for (const double gamma : {0.01, 0.4}) {
      Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
      F(0, 1) = gamma;
      EXPECT_NEAR(stress(F)(0, 1), lame.mu * gamma + (lame.lambda / 2.0 + lame.mu) * gamma * gamma * gamma,
                  1e-12 * young);
    }
  });
}

TEST(StVenantKirchhoff, RigidRotationIsFreeOfStress) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(100.0 / 180.0 * std::numbers::pi, axis).toRotationMatrix();
  forEachBrick([&](auto stress) { EXPECT_LT(stress(R).norm(), 1e-10 * young); });
}

/// Eq. (34) written with index sums.
Eigen::Matrix3d deformedMetricStress(const Eigen::Matrix3d& F, double poisson) {
  const LameConstants constants = lameConstants(young, poisson);
  const Eigen::Matrix3d C = F.transpose() * F, E = 0.5 * (C - Eigen::Matrix3d::Identity()), G = C.inverse();
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          S(i, j) +=
              (constants.mu * (G(i, k) * G(j, l) + G(i, l) * G(j, k)) + constants.lambda * G(i, j) * G(k, l)) * E(k, l);
  return S;
}

TEST(AxialSprings, AStretchAlongAnAxisIsLinearAndRotationsDoNothing) {
  for (const bool distorted : {false, true})
    for (const double stretch : {0.7, 1.0 + 1e-6, 1.4}) {
      const Eigen::Matrix3d F = diagonal(1.0, stretch, 1.0);
      const Eigen::Matrix3d expected = diagonal(0.0, young * (stretch - 1.0), 0.0);
      EXPECT_LT((stressAt(F, Formulation::standard, AxialSprings{young, 1.0}, distorted) - expected).norm(),
                1e-12 * young);
      const Eigen::Matrix3d R = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
      EXPECT_LT((stressAt(R * F, Formulation::standard, AxialSprings{young, 1.0}, distorted) - R * expected).norm(),
                1e-12 * young);
    }
}

TEST(AxialSprings, DiffersFromStVenantKirchhoffBySecondOrder) {
  const auto difference = [](double size) {
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F += size * (Eigen::Matrix3d() << 1.0, 0.4, -0.2, 0.3, -0.7, 0.5, 0.1, 0.6, 0.2).finished();
    return (stressAt(F, Formulation::standard, AxialSprings{young, 1.0}, false) -
            stressAt(F, Formulation::standard, StVenantKirchhoff{young, 0.0, 1.0}, false))
        .norm();
  };
  EXPECT_NEAR(std::log2(difference(2e-3) / difference(1e-3)), 2.0, 0.02);
}

TEST(DeformedMetricHooke, StressIsEquation34) {
  Eigen::Matrix3d F;
  F << 1.2, 0.3, -0.1, 0.1, 0.9, 0.2, -0.2, 0.15, 1.1;
  for (const double poisson : {0.0, 0.3})
    for (const bool distorted : {false, true}) {
      const Eigen::Matrix3d P = stressAt(F, Formulation::standard, DeformedMetricHooke{young, poisson, 1.0}, distorted);
      EXPECT_LT((P - F * deformedMetricStress(F, poisson)).norm(), 1e-12 * young);
    }
}

TEST(DeformedMetricHooke, EnergyIsHalfStressTimesStrain) {
  Eigen::Matrix3d F = diagonal(1.1, 0.95, 1.02);
  F(0, 2) = 0.2;
  SolidScene scene = sceneOf(testMesh({1, 2, 1}, true), Formulation::standard, DeformedMetricHooke{young, nu, 1.0});
  setAffine(scene.model.nodes, F);
  const Eigen::Matrix3d E = 0.5 * (F.transpose() * F - Eigen::Matrix3d::Identity());
  const double expected = 0.5 * deformedMetricStress(F, nu).cwiseProduct(E).sum() * volumeOf(scene);
  EXPECT_NEAR(scene.solid->energy(scene.model.nodes, {}), expected, 1e-12 * expected);
}

TEST(DeformedMetricHooke, DiffersFromStVenantKirchhoffBySecondOrder) {
  Eigen::Matrix3d H;
  H << 0.6, 0.3, -0.2, 0.1, -0.4, 0.5, 0.2, -0.3, 0.7;
  const auto difference = [&](double size) {
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + size * H;
    return (stressAt(F, Formulation::standard, DeformedMetricHooke{young, nu, 1.0}, false) -
            stressAt(F, Formulation::standard, StVenantKirchhoff{young, nu, 1.0}, false))
        .norm();
  };
  const double order = std::log2(difference(2e-3) / difference(1e-3));
  EXPECT_NEAR(order, 2.0, 0.02);
}

TEST(Materials, ImpossibleConstantsAreRefused) {
  const auto make = [&](double E, double poisson, double rho) {
    pointMaterial(Material(StVenantKirchhoff{E, poisson, rho}));
  };
  EXPECT_THROW(make(0.0, 0.3, 1.0), InputError);
  EXPECT_THROW(make(1.0, 0.5, 1.0), InputError);
  EXPECT_THROW(make(1.0, -1.0, 1.0), InputError);
  EXPECT_THROW(make(1.0, 0.3, -1.0), InputError);
  EXPECT_NO_THROW(make(1.0, -0.3, 1.0));
  for (const Material& law : {Material(DeformedMetricHooke{1.0, 0.3, 1.0}), Material(AxialSprings{1.0, 1.0})})
    EXPECT_THROW(sceneOf(testMesh({1, 1, 1}, false), Formulation::assumedStress, law), InputError);
}

}  // namespace
}  // namespace dovetail::fem
