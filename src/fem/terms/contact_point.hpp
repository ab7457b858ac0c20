// What a rigid plane answers to one point of a surface.
#pragma once

#include <algorithm>
#include <array>

#include "dovetail/core/vec3.hpp"

namespace dovetail::fem {

/// Committed state of a point.
struct ContactPast {
  Vec3 d;               ///< place relative to the plane, m
  Vec3 spring;          ///< stretch of the friction spring, m
  double lambda = 0.0;  ///< multiplier, Pa
};

struct ContactAnswer {
  double pressure;  ///< Pa
  Vec3 traction;    ///< on the solid, Pa
  Vec3 spring;      ///< stretch of the friction spring, m
  Vec3 trial;       ///< its stretch if it had not slipped, m
};

/// factor · a ⊗ b, row-major.
inline std::array<double, 9> scaledOuterProduct(double factor, const Vec3& a, const Vec3& b) {
  std::array<double, 9> block{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) block[static_cast<std::size_t>(3 * i + j)] = factor * a[i] * b[j];
  return block;
}

struct ContactPointLaw {
  Vec3 normal;
  double penalty, tangentialPenalty;  // Pa/m
  double friction;

  ContactAnswer at(const Vec3& d, const ContactPast& past, double lambda) const {
    ContactAnswer answer{std::max(0.0, lambda - penalty * dot(normal, d)), {}, {}, {}};
    answer.traction = answer.pressure * normal;
    if (friction == 0.0) return answer;
    const Vec3 moved = d - past.d;
    answer.trial = past.spring + (moved - dot(normal, moved) * normal);
    const double most = friction * answer.pressure / tangentialPenalty, length = norm(answer.trial);
    answer.spring = length > most ? (most / length) * answer.trial : answer.trial;
    answer.traction -= tangentialPenalty * answer.spring;
    return answer;
  }

  /// −∂traction/∂d; for a point that touches.
  std::array<double, 9> tangent(const ContactAnswer& answer) const {
    std::array<double, 9> K = scaledOuterProduct(penalty, normal, normal);
    if (friction == 0.0) return K;
    const double length = norm(answer.trial), limit = friction * answer.pressure;
    const bool slips = tangentialPenalty * length > limit;
    const Vec3 direction = slips ? answer.trial / length : Vec3{};
    const double lateral = slips ? limit / length : tangentialPenalty;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double projector = (i == j ? 1.0 : 0.0) - normal[i] * normal[j] - direction[i] * direction[j];
        K[static_cast<std::size_t>(3 * i + j)] +=
            lateral * projector - (slips ? friction * penalty : 0.0) * direction[i] * normal[j];
      }
    return K;
  }

  /// Stored per area, J/m².
  double energy(const ContactAnswer& answer, double lambda) const {
    return (answer.pressure * answer.pressure - lambda * lambda) / (2.0 * penalty) +
           0.5 * tangentialPenalty * squaredNorm(answer.spring);
  }
  /// Mean friction of the step times slip, J/m².
  double dissipated(const ContactAnswer& answer, const ContactPast& past) const {
    return 0.5 * tangentialPenalty * dot(past.spring + answer.spring, answer.trial - answer.spring);
  }
  /// Stored energy that vanishes at the old place with the new multiplier, J/m².
  double jump(const ContactPast& past, double lambda) const {
    if (lambda == past.lambda) return 0.0;
    const double gap = dot(normal, past.d);
    const double before = std::max(0.0, past.lambda - penalty * gap), after = std::max(0.0, lambda - penalty * gap);
    return (before * before - past.lambda * past.lambda - after * after + lambda * lambda) / (2.0 * penalty);
  }

  /// −ΔW / Δg from one place to another without friction, Pa.
  double meanPressure(const Vec3& from, const Vec3& to, double lambda) const {
    const double q0 = lambda - penalty * dot(normal, from), q1 = lambda - penalty * dot(normal, to);
    if (q0 > 0.0 && q1 > 0.0) return 0.5 * (q0 + q1);
    if (q0 <= 0.0 && q1 <= 0.0) return 0.0;
    return q1 > 0.0 ? 0.5 * q1 * q1 / (q1 - q0) : 0.5 * q0 * q0 / (q0 - q1);
  }
  /// −∂meanPressure/∂(normal · to), Pa/m.
  double meanPressureSlope(const Vec3& from, const Vec3& to, double lambda) const {
    const double q0 = lambda - penalty * dot(normal, from), q1 = lambda - penalty * dot(normal, to), step = q1 - q0;
    if (q0 > 0.0 && q1 > 0.0) return 0.5 * penalty;
    if (q0 <= 0.0 && q1 <= 0.0) return 0.0;
    return q1 > 0.0 ? penalty * q1 * (step - 0.5 * q1) / (step * step) : 0.5 * penalty * q0 * q0 / (step * step);
  }
};

}  // namespace dovetail::fem
