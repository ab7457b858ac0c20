// Where Newton's method starts from.
#include <algorithm>
#include <cmath>

#include "implicit_step.hpp"

namespace dovetail::fem::detail {

namespace {

/// Solves I w = L for a symmetric positive definite I by Cramer's rule; 0 if I is singular.
Vec3 solveInertia(const Vec3& xx, const Vec3& yy, const Vec3& zz, const Vec3& L) {
  const double det = dot(xx, cross(yy, zz));
  if (!(std::abs(det) > 1e-9 * norm(xx) * norm(yy) * norm(zz))) return {};
  return {dot(L, cross(yy, zz)) / det, dot(xx, cross(L, zz)) / det, dot(xx, cross(yy, L)) / det};
}

struct RigidMotion {
  Vec3 centre, velocity, spin;
};

/// Of the body as a whole, from its momenta.
RigidMotion rigidMotion(const Nodes& nodes) {
  double mass = 0.0;
  RigidMotion motion;
  for (std::size_t n = 0; n < nodes.u.size(); ++n) {
    mass += nodes.mass[n];
    motion.centre += nodes.mass[n] * (nodes.X[n] + nodes.u[n]);
    motion.velocity += nodes.mass[n] * nodes.v[n];
  }
  motion.centre = motion.centre / mass;
  motion.velocity = motion.velocity / mass;
  Vec3 L, columns[3];
  for (std::size_t n = 0; n < nodes.u.size(); ++n) {
    const Vec3 r = nodes.X[n] + nodes.u[n] - motion.centre;
    L += nodes.mass[n] * cross(r, nodes.v[n] - motion.velocity);
    for (int c = 0; c < 3; ++c) {
      columns[c] -= nodes.mass[n] * r[c] * r;
      columns[c][c] += nodes.mass[n] * squaredNorm(r);
    }
  }
  motion.spin = solveInertia(columns[0], columns[1], columns[2], L);
  return motion;
}

/// r turned by the vector of rotation (Rodrigues).
Vec3 turned(const Vec3& r, const Vec3& rotation) {
  const double angle = norm(rotation);
  if (angle == 0.0) return r;
  const Vec3 axis = rotation / angle;
  return std::cos(angle) * r + std::sin(angle) * cross(axis, r) + (1.0 - std::cos(angle)) * dot(axis, r) * axis;
}

}  // namespace

/// base: u₁ without correction.
void ImplicitStep::setBase() {
  const double h = h_;
  const double byAcceleration = conserving() ? 0.0 : h * h * (0.5 - options_.scheme.beta);
  for (std::size_t n = 0; n < base_.size(); ++n) base_[n] = u0_[n] + h * v0_[n] + byAcceleration * a0_[n];
}

/// First correction. Strains of a guess that coasts grow with the square of the angle it turns by; a free body that
/// turns far is therefore turned as a whole if that is nearer to balance.
void ImplicitStep::makeGuess(Guess guess) {
  const double h = h_;
  const auto place = [&](auto&& displacement) {
    for (std::size_t n = 0; n < base_.size(); ++n) {
      correction_[n] = displacement(n) - base_[n];
      for (int c = 0; c < 3; ++c)  // fixed components move with their velocity
        if (model_.nodes.fixed[n] >> c & 1) correction_[n][c] = u0_[n][c] + h * v0_[n][c] - base_[n][c];
    }
  };
  const auto coasting = [&](std::size_t n) { return u0_[n] + h * v0_[n]; };
  if (guess == Guess::rest) return place([&](std::size_t n) { return u0_[n]; });
  place(coasting);
  const bool plane = std::ranges::all_of(model_.nodes.fixed, [](std::uint8_t held) { return held == componentZ; });
  if (dofs_.size() < (plane ? 2 : 3) * base_.size()) return;
  const RigidMotion motion = rigidMotion(model_.nodes);
  constexpr double farTurn = 0.01;  // rad
  if (!(h * norm(motion.spin) > farTurn)) return;
  const double coastingNorm = evaluate();
  const std::vector<Vec3> kept = correction_;
  const std::vector<Vec3>& X = model_.nodes.X;
  place([&](std::size_t n) {
    return motion.centre + h * motion.velocity + turned(X[n] + u0_[n] - motion.centre, h * motion.spin) - X[n];
  });
  if (!(evaluate() < coastingNorm) && std::isfinite(coastingNorm)) correction_ = kept;
}

}  // namespace dovetail::fem::detail
