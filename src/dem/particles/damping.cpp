#include "dovetail/dem/particles/damping.hpp"

#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t chunkSize = 4096;

}  // namespace

double resist(Vec3& force, const Vec3& velocity, double alpha) {
  double power = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double v = velocity[k], size = alpha * std::abs(force[k]);
    force[k] -= v > 0.0 ? size : (v < 0.0 ? -size : 0.0);
    power += size * std::abs(v);
  }
  return power;
}

double applyViscousDamping(Particles& particles, double rate) {
  requireNonNegative(rate, "damping rate");
  return parallelSum(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double power = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (particles.isMember(i)) continue;
      const double weighted = rate * particles.weightOf(i);
      const Vec3 force = (weighted * particles.mass[i]) * particles.v[i];
      particles.f[i] -= force;
      power += dot(force, particles.v[i]);
      if (!particles.rotates()) continue;
      const Vec3 torque = (weighted * momentOfInertia(particles, static_cast<int>(i))) * particles.omega[i];
      particles.torque[i] -= torque;
      power += dot(torque, particles.omega[i]);
    }
    return power;
  });
}

double applyLocalDamping(Particles& particles, double alpha) {
  if (!(alpha >= 0.0 && alpha < 1.0))
    throw InputError("the local damping is " + formatNumber(alpha), "local damping", "give 0 ≤ α < 1, such as 0.7");
  return parallelSum(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double power = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (particles.isMember(i)) continue;
      power += resist(particles.f[i], particles.v[i], alpha);
      if (particles.rotates()) power += resist(particles.torque[i], particles.omega[i], alpha);
    }
    return power;
  });
}

Vec3 dampingForce(const Vec3& force, const Vec3& momentum, const Vec3& velocity, double rate, double alpha) {
  Vec3 damping = -rate * momentum;
  for (int k = 0; k < 3; ++k) {
    const double way = force[k] * velocity[k], sign = way > 0.0 ? 1.0 : way < 0.0 ? -1.0 : 0.0;
    damping[k] -= alpha * sign / (1.0 - alpha * sign) * force[k];
  }
  return damping;
}

}  // namespace dovetail::dem
