// Hill and Mandel's condition in a framed cell.
#pragma once

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "../../src/rve/contacts/bonded.hpp"
#include "../../src/rve/contacts/touching.hpp"
#include "../../src/rve/motion/projection.hpp"
#include "cells.hpp"

namespace dovetail::rve {

/// V P̄ : δF against the virtual work of all contacts, for a random δF and any fluctuation that the conditions leave.
inline double hillMandelError(const Rve& cell, std::mt19937& random) {
  Components w = randomMotion(cell.state.v, 1e-2 * meanDiameter(cell), random);
  Components theta = randomMotion(cell.state.spin, 1e-2, random);
  project(cell, w, theta);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const Eigen::Matrix2d dF = Eigen::Matrix2d::NullaryExpr([&] { return u(random); });
  const Eigen::Matrix2d L = dF * cell.state.F.topLeftCorner<2, 2>().inverse();
  const double spin = 0.5 * (L(1, 0) - L(0, 1));
  const auto moved = [&](std::size_t i) {
    return Vec3{L(0, 0) * cell.state.x[0][i] + L(0, 1) * cell.state.x[1][i] + w[0][i],
                L(1, 0) * cell.state.x[0][i] + L(1, 1) * cell.state.x[1][i] + w[1][i], 0.0};
  };
  double work = 0.0;
  forEachTouch(cell, [&](const Touch& touch) {
    const Vec3 force = contactForce(cell, touch);
    const double couple = cross(touch.normal, force).z;
    const double armI = 0.5 * (touch.distance + cell.radius[touch.i] - cell.radius[touch.j]);
    work += dot(force, moved(touch.j) - moved(touch.i)) - armI * couple * (theta[2][touch.i] + spin) -
            (touch.distance - armI) * couple * (theta[2][touch.j] + spin);
  });
  forEachBond(cell, [&](const BondTouch& bond) {
    const double armI = bond.armI(cell), thetaI = theta[2][bond.i] + spin, thetaJ = theta[2][bond.j] + spin;
    work += dot(bond.forceOnI(), moved(bond.j) - moved(bond.i)) - armI * bond.tangentialForce * thetaI -
            (bond.distance - armI) * bond.tangentialForce * thetaJ + bond.moment * (thetaI - thetaJ);
  });
  const double given = cell.volume * stressOfReactions(cell).topLeftCorner<2, 2>().cwiseProduct(dF).sum();
  return std::abs(given - work) / std::abs(given);
}

}  // namespace dovetail::rve
