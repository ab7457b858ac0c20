#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "reference/moving_mass.hpp"
#include "reference/static_reference.hpp"
#include "reference/surface_contact.hpp"

namespace dovetail::cantilever {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

// The sphere resting at y (held along y only), from the modal model: a fixed point for the amplitudes, for which the
// load hardly changes, and Newton for the height at which the contact carries the weight.
double modalRestHeight(const BeamCase& beam, double y, bool offset, bool largeRotations) {
  const BeamModes modes = computeModes(makeSection(beam), beam.length, {.basis = 60}, 50);
  const ModeTable table(modes, 300, largeRotations);
  const double stiffness = 2.0 * beam.contactStiffness;
  BeamSurfaceContact contact(table, {.height = 0.4, .lever = offset ? 0.4 : 0.0}, stiffness, beam.particleRadius);
  const VectorXd flexibility = Eigen::Map<const VectorXd>(modes.omega.data(), 50).cwiseAbs2().cwiseInverse();
  VectorXd q = VectorXd::Zero(50);
  SphereContact state;
  state.position = y;
  double z = startHeight(beam);
  for (int i = 0; i < 60; ++i) {
    contact.update({y, z}, q, state);
    z += state.overlap - totalWeight(beam) / stiffness;  // near enough for the contact to be closed
    for (int j = 0; j < 10; ++j) {
      contact.update({y, z}, q, state);
      z += (state.force[1] - totalWeight(beam)) / stiffness;
    }
    contact.update({y, z}, q, state);
    q = flexibility.cwiseProduct(state.modalForce);
  }
  EXPECT_NEAR(state.force[1], totalWeight(beam), 1e-6);
  return z;
}

// Large rotations without approximation (Reissner's beam, inextensible): θ' = M/EI, γ = Q/κGA,
// r' = (cos θ − γ sin θ, sin θ + γ cos θ), under one force at the top surface normal to it.
class Elastica {
public:
  explicit Elastica(const BeamCase& beam) : beam_(beam), section_(makeSection(beam)) {}

  double restHeight(double y) {
    double contactArc = y;
    Vector2d centre;
    for (int i = 0; i < 200; ++i) {
      centre = solve(contactArc);
      contactArc += 0.7 * (y - centre[0]);
    }
    EXPECT_NEAR(centre[0], y, 1e-10);
    return centre[1];
  }

private:
  using State = std::array<double, 3>;  // y, z, θ of the axis

  double shearAngle(const Vector2d& force, double angle) const {
    return (-force[0] * std::sin(angle) + force[1] * std::cos(angle)) / section_.shear;
  }
  State slope(const State& s, const Vector2d& at, const Vector2d& force) const {
    const double gamma = shearAngle(force, s[2]), sine = std::sin(s[2]), cosine = std::cos(s[2]);
    const double moment = (at[0] - s[0]) * force[1] - (at[1] - s[1]) * force[0];
    return {cosine - gamma * sine, sine + gamma * cosine, moment / section_.bending};
  }
  State shoot(double arc, const Vector2d& at, const Vector2d& force) const {
    State s{0.0, 0.0, 0.0};
    const int steps = 200;
    const double h = arc / steps;
    const auto moved = [](State a, double factor, const State& d) {
      for (int c = 0; c < 3; ++c) a[c] += factor * d[c];
      return a;
    };
    for (int i = 0; i < steps; ++i) {
      const State k1 = slope(s, at, force), k2 = slope(moved(s, h / 2, k1), at, force);
      const State k3 = slope(moved(s, h / 2, k2), at, force), k4 = slope(moved(s, h, k3), at, force);
      for (int c = 0; c < 3; ++c) s[c] += h / 6.0 * (k1[c] + 2.0 * k2[c] + 2.0 * k3[c] + k4[c]);
    }
    return s;
  }
  // Centre of the sphere when the contact is at the given arc length.
  Vector2d solve(double arc) {
    for (int i = 0; i < 20; ++i) {
      const State s = shoot(arc, at_, force_);
      at_ = {s[0] - 0.4 * std::sin(s[2]), s[1] + 0.4 * std::cos(s[2])};
      // The shear angle jumps from γ to 0 under the load; its mean counts for the normal.
      const double tilt = s[2] + 0.5 * shearAngle(force_, s[2]);
      normal_ = {-std::sin(tilt), std::cos(tilt)};
      force_ = -totalWeight(beam_) / normal_[1] * normal_;
    }
    return at_ + (beam_.particleRadius - force_.norm() / (2.0 * beam_.contactStiffness)) * normal_;
  }

  BeamCase beam_;
  Section section_;
  Vector2d at_{6.0, 0.4}, force_{0.0, -1000.0}, normal_{0.0, 1.0};
};

TEST(Elastica, ModalGeometryIsRightForLargeRotations) {
  const BeamCase beam;
  Elastica elastica(beam);
  for (double y : {4.0, 8.0, 11.9})  // what is left is shear beyond the 50th mode and the square of the shear angle
    EXPECT_NEAR(modalRestHeight(beam, y, true, true), elastica.restHeight(y), 4e-6) << "y = " << y;
}

TEST(Elastica, EachSimplificationCostsUnderAMillimetre) {
  const BeamCase beam;
  const double y = 11.9, exact = Elastica(beam).restHeight(y);
  EXPECT_NEAR(modalRestHeight(beam, y, true, false) - exact, 0.36e-3, 0.01e-3);    // straight axis
  EXPECT_NEAR(modalRestHeight(beam, y, false, true) - exact, -0.70e-3, 0.01e-3);   // top surface follows the axis
  EXPECT_NEAR(modalRestHeight(beam, y, false, false) - exact, -0.34e-3, 0.01e-3);  // both: linear beam theory
  EXPECT_NEAR(staticHeight(beam, y, {.shear = true}) - exact, -0.51e-3, 0.01e-3);  // and the sphere above its contact
}

}  // namespace
}  // namespace dovetail::cantilever
