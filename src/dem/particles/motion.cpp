// The verbs of a time step.
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "four_moves.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t chunkSize = 4096;

double weightedMass(const Particles& particles, std::size_t i) { return particles.weightOf(i) * particles.mass[i]; }

double weightedInertia(const Particles& particles, std::size_t i) {
  return particles.weightOf(i) * momentOfInertia(particles, static_cast<int>(i));
}

}  // namespace

void clearForces(Particles& particles) {
  parallelFor(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.f[i] = {};
    if (particles.rotates())
      for (std::size_t i = begin; i < end; ++i) particles.torque[i] = {};
  });
}

void applyGravity(Particles& particles, const Vec3& g) {
  parallelFor(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.f[i] += weightedMass(particles, i) * g;
  });
}

void kick(Particles& particles, double dt) {
  parallelFor(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.v[i] += (dt / weightedMass(particles, i)) * particles.f[i];
    if (particles.rotates())
      for (std::size_t i = begin; i < end; ++i)
        particles.omega[i] += (dt / weightedInertia(particles, i)) * particles.torque[i];
  });
}

void drift(Particles& particles, double dt) {
  parallelFor(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.x[i] += dt * particles.v[i];
  });
}

namespace {

using detail::Four, detail::Sweep;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Half kicks and drift of one particle; returns the squared displacement, m². Two half kicks are made one after the
/// other, so that the digits are those of two sweeps. What is not finite stays where it is, to be found: then only the
/// velocities change.
template <bool spins, bool weighted>
double advance(Particles& particles, std::size_t i, const Sweep& sweep) {
  const double weight = weighted ? particles.weight[i] : 1.0, mass = weight * particles.mass[i];
  const double half = 0.5 * sweep.dt / mass;
  Vec3 v = particles.v[i];
  for (int k = 0; k < sweep.halfKicks; ++k) v += half * particles.f[i];
  particles.v[i] = v;
  Vec3& x = particles.x[i];
  double moved = squaredNorm(v) * (sweep.dt * sweep.dt) + 0.0 * (x.x + x.y + x.z);
  if constexpr (spins) {
    const double halfSpin = 0.5 * sweep.dt / (weight * momentOfInertia(particles, static_cast<int>(i)));
    Vec3 omega = particles.omega[i];
    for (int k = 0; k < sweep.halfKicks; ++k) omega += halfSpin * particles.torque[i];
    particles.omega[i] = omega;
    moved += 0.0 * (omega.x + omega.y + omega.z);
  }
  if (!(moved < infinity)) [[unlikely]]
    return infinity;
  x += sweep.dt * v;
  if (sweep.startsForces) {
    particles.f[i] = mass * sweep.g;
    if constexpr (spins) particles.torque[i] = {};
  }
  return moved;
}

struct Largest {
  double value = 0.0;
  Largest& operator+=(const Largest& b) {
    if (!(b.value <= value)) value = b.value;
    return *this;
  }
};

template <bool spins, bool weighted>
double sweepAll(Particles& particles, const Sweep& sweep) {
  const auto part = [&](std::size_t begin, std::size_t end) {
    double largest = 0.0;
    bool finite = true;
    const auto take = [&](double d2) {
      finite = finite && d2 < infinity;
      largest = d2 > largest ? d2 : largest;
    };
    std::size_t i = begin;
    withVectors([&, end] {
      const Sweep now = sweep;  // copies that nothing else can change
      std::size_t k = i;
      Four largestOfFour{};
      for (; k + 4 <= end; k += 4)
        if (!detail::advanceFour<spins, weighted>(particles, k, now, largestOfFour)) [[unlikely]]
          for (std::size_t one = k; one < k + 4; ++one) take(advance<spins, weighted>(particles, one, now));
      for (int one = 0; one < 4; ++one) take(largestOfFour[one]);
      i = k;
    });
    for (; i < end; ++i) take(advance<spins, weighted>(particles, i, sweep));
    return Largest{finite ? largest : infinity};
  };
  return std::sqrt(parallelSum(particles.size(), chunkSize, part).value);
}

double sweepAll(Particles& particles, const Sweep& sweep) {
  if (particles.weight.empty())
    return particles.rotates() ? sweepAll<true, false>(particles, sweep) : sweepAll<false, false>(particles, sweep);
  return particles.rotates() ? sweepAll<true, true>(particles, sweep) : sweepAll<false, true>(particles, sweep);
}

}  // namespace

double kickAndDrift(Particles& particles, double dt) { return sweepAll(particles, {dt, 1, false, {}}); }

double startStep(Particles& particles, double dt, const Vec3& g) { return sweepAll(particles, {dt, 1, true, g}); }

double turnStep(Particles& particles, double dt, const Vec3& g) { return sweepAll(particles, {dt, 2, true, g}); }

void startForces(Particles& particles, const Vec3& g) {
  parallelFor(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) particles.f[i] = weightedMass(particles, i) * g;
    if (particles.rotates())
      for (std::size_t i = begin; i < end; ++i) particles.torque[i] = {};
  });
}

double kineticEnergy(const Particles& particles) {
  return parallelSum(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      sum += 0.5 * weightedMass(particles, i) * squaredNorm(particles.v[i]);
      if (particles.rotates()) sum += 0.5 * weightedInertia(particles, i) * squaredNorm(particles.omega[i]);
    }
    return sum;
  });
}

Vec3 momentum(const Particles& particles) {
  return parallelSum(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    Vec3 sum;
    for (std::size_t i = begin; i < end; ++i) sum += weightedMass(particles, i) * particles.v[i];
    return sum;
  });
}

Vec3 angularMomentum(const Particles& particles) {
  return parallelSum(particles.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    Vec3 sum;
    for (std::size_t i = begin; i < end; ++i) {
      sum += weightedMass(particles, i) * cross(particles.x[i], particles.v[i]);
      if (particles.rotates()) sum += weightedInertia(particles, i) * particles.omega[i];
    }
    return sum;
  });
}

void requireFinite(const Particles& particles, const std::string& when) {
  const auto look = [&](const auto& values, const char* field, const char* remedy) {
    const auto finite = [](const auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
        return std::isfinite(value);
      else
        return isFinite(value);
    };
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!finite(values[i]))
        throw NumericalError("its " + std::string(field) + " is not finite, " + when,
                             "particle " + std::to_string(particles.id[i]), remedy);
  };
  constexpr const char *set = "check where it is set", *thrown = "take a smaller time step, or check the forces on it";
  look(particles.mass, "mass", set);
  look(particles.radius, "radius", set);
  look(particles.weight, "weight", set);
  look(particles.x, "position", thrown);
  look(particles.f, "force", "check the laws, walls and external forces that act on it");
  look(particles.torque, "torque", "check the laws, walls and bonds that act on it");
  look(particles.omega, "angular velocity", thrown);
  look(particles.v, "velocity", thrown);
}

}  // namespace dovetail::dem
