#include "dovetail/dem/particles/particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t grain = 4096;

std::string place(std::size_t particle, const char* field) {
  return "particle " + std::to_string(particle) + ", " + field;
}

void checkVector(const Vec3& value, std::size_t particle, const char* field) {
  if (!isFinite(value)) throw InputError("not a finite vector", place(particle, field), "give three finite numbers");
}

void checkPositive(double value, std::size_t particle, const char* field) {
  if (!std::isfinite(value) || value <= 0.0)
    throw InputError("the value is " + formatNumber(value), place(particle, field),
                     "give a finite number greater than zero");
}

void checkLength(std::size_t length, std::size_t wanted, const char* field) {
  if (length != wanted)
    throw InputError(
        "the array has " + std::to_string(length) + " entries for " + std::to_string(wanted) + " particles", field,
        "add particles with addParticle, or resize all arrays together");
}

}  // namespace

int addParticle(Particles& particles, const Vec3& x, const Vec3& v, double radius, Mass mass) {
  const std::size_t i = particles.size();
  checkVector(x, i, "position");
  checkVector(v, i, "velocity");
  checkPositive(radius, i, "radius");
  checkPositive(mass.value, i, "mass");
  if (particles.rotates()) {
    particles.omega.emplace_back();
    particles.torque.emplace_back();
  }
  if (!particles.material.empty()) particles.material.push_back(0);
  if (!particles.id.empty()) particles.id.push_back(1 + *std::max_element(particles.id.begin(), particles.id.end()));
  particles.x.push_back(x);
  particles.v.push_back(v);
  particles.f.emplace_back();
  particles.radius.push_back(radius);
  particles.mass.push_back(mass.value);
  return static_cast<int>(i);
}

int addParticle(Particles& particles, const Vec3& x, const Vec3& v, double radius, Density density) {
  checkPositive(density.value, particles.size(), "density");
  return addParticle(particles, x, v, radius,
                     Mass{density.value * (4.0 / 3.0) * std::numbers::pi * radius * radius * radius});
}

void switchOnRotation(Particles& particles) {
  particles.omega.resize(particles.size());
  particles.torque.resize(particles.size());
}

void validate(const Particles& particles) {
  const std::size_t n = particles.size();
  checkLength(particles.v.size(), n, "velocity");
  checkLength(particles.f.size(), n, "force");
  checkLength(particles.radius.size(), n, "radius");
  checkLength(particles.mass.size(), n, "mass");
  if (!particles.material.empty()) checkLength(particles.material.size(), n, "material");
  if (!particles.id.empty()) checkLength(particles.id.size(), n, "id");
  if (particles.rotates() || !particles.torque.empty()) {
    checkLength(particles.omega.size(), n, "angular velocity");
    checkLength(particles.torque.size(), n, "torque");
  }
  for (std::size_t i = 0; i < n; ++i) {
    checkVector(particles.x[i], i, "position");
    checkVector(particles.v[i], i, "velocity");
    checkPositive(particles.radius[i], i, "radius");
    checkPositive(particles.mass[i], i, "mass");
    if (particles.rotates()) checkVector(particles.omega[i], i, "angular velocity");
  }
}

double momentOfInertia(const Particles& particles, int particle) {
  const auto i = static_cast<std::size_t>(particle);
  return 0.4 * particles.mass[i] * particles.radius[i] * particles.radius[i];
}

void clearForces(Particles& particles) {
  parallelFor(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.f[i] = {};
    if (particles.rotates())
      for (std::size_t i = begin; i < end; ++i) particles.torque[i] = {};
  });
}

void applyGravity(Particles& particles, const Vec3& g) {
  parallelFor(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.f[i] += particles.mass[i] * g;
  });
}

void kick(Particles& particles, double dt) {
  parallelFor(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.v[i] += (dt / particles.mass[i]) * particles.f[i];
    if (particles.rotates())
      for (std::size_t i = begin; i < end; ++i)
        particles.omega[i] += (dt / momentOfInertia(particles, static_cast<int>(i))) * particles.torque[i];
  });
}

void drift(Particles& particles, double dt) {
  parallelFor(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.x[i] += dt * particles.v[i];
  });
}

namespace {

/// What one sweep does to a particle.
struct Sweep {
  double dt;
  int halfKicks;      // before the drift
  bool startsForces;  // after it
  Vec3 g;
};

/// Half kicks and drift of one particle; returns the squared displacement, m². Two half kicks are made one after the
/// other, so that the digits are those of two sweeps.
template <bool spins>
double advance(Particles& particles, std::size_t i, const Sweep& sweep) {
  const double half = 0.5 * sweep.dt / particles.mass[i];
  Vec3 v = particles.v[i];
  for (int k = 0; k < sweep.halfKicks; ++k) v += half * particles.f[i];
  particles.v[i] = v;
  particles.x[i] += sweep.dt * v;
  if constexpr (spins) {
    const double halfSpin = 0.5 * sweep.dt / momentOfInertia(particles, static_cast<int>(i));
    Vec3 omega = particles.omega[i];
    for (int k = 0; k < sweep.halfKicks; ++k) omega += halfSpin * particles.torque[i];
    particles.omega[i] = omega;
  }
  if (sweep.startsForces) {
    particles.f[i] = particles.mass[i] * sweep.g;
    if constexpr (spins) particles.torque[i] = {};
  }
  return squaredNorm(v) * (sweep.dt * sweep.dt);
}

struct Largest {
  double value = 0.0;
  Largest& operator+=(const Largest& b) {
    if (!(b.value <= value)) value = b.value;
    return *this;
  }
};

double sweepAll(Particles& particles, const Sweep& sweep) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto part = [&](std::size_t begin, std::size_t end) {
    double largest = 0.0;
    bool finite = true;
    const auto take = [&](double d2) {
      finite = finite && d2 < infinity;
      largest = d2 > largest ? d2 : largest;
    };
    if (particles.rotates())
      for (std::size_t i = begin; i < end; ++i) take(advance<true>(particles, i, sweep));
    else
      for (std::size_t i = begin; i < end; ++i) take(advance<false>(particles, i, sweep));
    return Largest{finite ? largest : infinity};
  };
  return std::sqrt(parallelSum(particles.size(), grain, part).value);
}

}  // namespace

double kickAndDrift(Particles& particles, double dt) { return sweepAll(particles, {dt, 1, false, {}}); }

double startStep(Particles& particles, double dt, const Vec3& g) { return sweepAll(particles, {dt, 1, true, g}); }

double turnStep(Particles& particles, double dt, const Vec3& g) { return sweepAll(particles, {dt, 2, true, g}); }

void startForces(Particles& particles, const Vec3& g) {
  parallelFor(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.f[i] = particles.mass[i] * g;
    if (particles.rotates())
      for (std::size_t i = begin; i < end; ++i) particles.torque[i] = {};
  });
}

double kineticEnergy(const Particles& particles) {
  return parallelSum(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      sum += 0.5 * particles.mass[i] * squaredNorm(particles.v[i]);
      if (particles.rotates())
        sum += 0.5 * momentOfInertia(particles, static_cast<int>(i)) * squaredNorm(particles.omega[i]);
    }
    return sum;
  });
}

Vec3 momentum(const Particles& particles) {
  return parallelSum(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    Vec3 sum;
    for (std::size_t i = begin; i < end; ++i) sum += particles.mass[i] * particles.v[i];
    return sum;
  });
}

Vec3 angularMomentum(const Particles& particles) {
  return parallelSum(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    Vec3 sum;
    for (std::size_t i = begin; i < end; ++i) {
      sum += particles.mass[i] * cross(particles.x[i], particles.v[i]);
      if (particles.rotates()) sum += momentOfInertia(particles, static_cast<int>(i)) * particles.omega[i];
    }
    return sum;
  });
}

void requireFinite(const Particles& particles, const std::string& when) {
  dovetail::requireFinite(particles.x, "particle", "position", when);
  dovetail::requireFinite(particles.v, "particle", "velocity", when);
}

}  // namespace dovetail::dem
