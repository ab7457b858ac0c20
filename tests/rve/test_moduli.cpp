// Moduli of tangents and of finite strains.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/moduli.hpp"

namespace dovetail::rve {
namespace {

TEST(Moduli, SecantsOfSmallStrainsAreThoseOfTheTangent) {
  const auto close = [](const Rve& cell, double anisotropy) {
    const Moduli tangent = moduliOf(cell, elasticTangent(cell));
    const SecantModuli secant = secantModuli(cell, std::vector{3e-6});
    EXPECT_NEAR(secant.bulk[0] / tangent.bulk, 1.0, 0.01);
    // One plane of shear, of a cell that is not quite isotropic.
    EXPECT_NEAR(secant.shear[0] / tangent.shear, 1.0, anisotropy);
  };
  close(pressedDiscs(400), 0.1);
  close(pressedSpheres(150), 0.15);
}

TEST(Moduli, SecantsFallWhereGrainsSlip) {
  const Rve cell = pressedDiscs(200);
  const SecantModuli secant = secantModuli(cell, growingStrains(1e-5, 3e-3, 4));
  ASSERT_EQ(secant.shear.size(), 4u);
  EXPECT_LT(secant.shear.back(), 0.75 * secant.shear.front());
  EXPECT_LT(secant.shear.front(), moduliOf(cell, voigtTangent(cell)).shear);
}

/// σ = −p 1 + λ tr ε 1 + 2 μ ε about F, at a pressure p, as ∂P/∂F.
Tangent isotropic(const Rve& cell, double lambda, double mu) {
  const Eigen::Matrix3d& F = cell.state.F;
  const Eigen::Matrix3d inverse = F.inverse(), sigma = stress(cell).cauchy;
  Tangent A = Tangent::Zero();
  for (int k = 0; k < 2; ++k)
    for (int L = 0; L < 2; ++L) {
      Eigen::Matrix3d dF = Eigen::Matrix3d::Zero();
      dF(k, L) = 1.0;
      const Eigen::Matrix3d g = dF * inverse, e = 0.5 * (g + g.transpose()), w = g - e;
      const Eigen::Matrix3d one = plane(1, 0, 0, 1) - Eigen::Vector3d(0, 0, 1).asDiagonal().toDenseMatrix();
      const Eigen::Matrix3d change = lambda * e.trace() * one + 2.0 * mu * e + w * sigma - sigma * w;
      const Eigen::Matrix3d dP =
          F.determinant() * (change + g.trace() * sigma - sigma * g.transpose()) * inverse.transpose();
      for (int i = 0; i < 3; ++i)
        for (int J = 0; J < 3; ++J) A(3 * i + J, 3 * k + L) = dP(i, J);
    }
  return A;
}

TEST(Moduli, AreThoseThatTheTangentWasMadeOf) {
  Rve cell = pressedDiscs(64);
  followPath(cell, plane(1.01, 0.02, -0.01, 0.98));
  const Moduli found = moduliOf(cell, isotropic(cell, 3e6, 2e6));
  EXPECT_NEAR(found.bulk, 5e6, 1e-6);
  EXPECT_NEAR(found.shear, 2e6, 1e-6);
}

TEST(Moduli, BadStrainsAreRefused) {
  const Rve cell = pressedDiscs(64);
  EXPECT_THROW(secantModuli(cell, std::vector{1e-4, 1e-5}), InputError);
  EXPECT_THROW(secantModuli(cell, std::vector{0.0}), InputError);
  EXPECT_THROW(secantModuli(cell, std::vector{1e-4}, {}), InputError);
}

}  // namespace
}  // namespace dovetail::rve
