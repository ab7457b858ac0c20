#include "dovetail/dem/bodies/bodies.hpp"

#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/particles/damping.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t chunkSize = 512;

void checkVector(const Vec3& value, const std::string& where) {
  if (!isFinite(value)) throw InputError("not a finite vector", where, "give three finite numbers");
}

void checkProperties(const MassProperties& p, const std::string& body) {
  requirePositive(p.mass, "mass of " + body);
  for (int k = 0; k < 3; ++k) {
    requirePositive(p.inertia[k], "principal moment of " + body);
    if (p.inertia[k] > (1.0 + 1e-12) * (p.inertia[(k + 1) % 3] + p.inertia[(k + 2) % 3]))
      throw InputError("the principal moment " + formatNumber(p.inertia[k]) + " is larger than the sum of the others",
                       "inertia of " + body, "give the moments of a body, which no mass distribution exceeds");
  }
}

void checkQuaternion(const Quaternion& q, const std::string& where) {
  if (const double length = norm(q); !(std::isfinite(length) && length > 0.0))
    throw InputError("the quaternion has the length " + formatNumber(length), where,
                     "give one that can be made a unit quaternion");
}

Vec3 overInertia(const Vec3& l, const Vec3& inertia) { return {l.x / inertia.x, l.y / inertia.y, l.z / inertia.z}; }

/// Turn about principal axis k for the time h.
Quaternion turnAbout(int k, double h, const Quaternion& q, const Vec3& l, const Vec3& inertia) {
  Vec3 axis;
  axis[k] = 1.0;
  const double speed = dot(rotate(q, axis), l) / inertia[k];
  axis[k] = h * speed;
  return q * fromRotationVector(axis);
}

}  // namespace

int addBody(Bodies& bodies, const MassProperties& properties, const Vec3& x, const Quaternion& turn, const Vec3& v,
            const Vec3& omega) {
  const int number = static_cast<int>(bodies.size());
  const std::string body = "body " + std::to_string(number);
  checkProperties(properties, body);
  checkVector(x, body + ", position");
  checkVector(v, body + ", velocity");
  checkVector(omega, body + ", angular velocity");
  checkQuaternion(turn, body + ", orientation");
  checkQuaternion(properties.axes, body + ", principal axes");
  bodies.x.push_back(x);
  bodies.v.push_back(v);
  bodies.f.emplace_back();
  bodies.mass.push_back(properties.mass);
  bodies.inertia.push_back(properties.inertia);
  bodies.orientation.push_back(normalized(normalized(turn) * properties.axes));
  bodies.turnedFrom.push_back(bodies.orientation.back());
  bodies.angularMomentum.emplace_back();
  bodies.torque.emplace_back();
  setAngularVelocity(bodies, number, omega);
  return number;
}

void validate(const Bodies& bodies) {
  const std::size_t n = bodies.size();
  const auto checkLength = [&](std::size_t length, const char* field) {
    if (length != n)
      throw InputError("the array has " + std::to_string(length) + " entries for " + std::to_string(n) + " bodies",
                       std::string(field) + " of bodies", "add bodies with addBody");
  };
  checkLength(bodies.v.size(), "velocity");
  checkLength(bodies.f.size(), "force");
  checkLength(bodies.mass.size(), "mass");
  checkLength(bodies.inertia.size(), "inertia");
  checkLength(bodies.orientation.size(), "orientation");
  checkLength(bodies.turnedFrom.size(), "orientation before the last drift");
  checkLength(bodies.angularMomentum.size(), "angular momentum");
  checkLength(bodies.torque.size(), "torque");
  for (std::size_t b = 0; b < n; ++b) {
    const std::string body = "body " + std::to_string(b);
    checkProperties({bodies.mass[b], {}, bodies.inertia[b], {}}, body);
    checkVector(bodies.x[b], body + ", position");
    checkVector(bodies.v[b], body + ", velocity");
    checkVector(bodies.angularMomentum[b], body + ", angular momentum");
    if (const double length = norm(bodies.orientation[b]); !(std::abs(length - 1.0) <= 1e-12))
      throw InputError("the quaternion has the length " + formatNumber(length), body + ", orientation",
                       "give a unit quaternion");
  }
}

void requireFinite(const Bodies& bodies, const std::string& when) {
  dovetail::requireFinite(bodies.x, "body", "position", when);
  dovetail::requireFinite(bodies.v, "body", "velocity", when);
  dovetail::requireFinite(bodies.f, "body", "force", when);
  dovetail::requireFinite(bodies.angularMomentum, "body", "angular momentum", when);
  dovetail::requireFinite(bodies.torque, "body", "torque", when);
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (!std::isfinite(norm(bodies.orientation[b])))
      throw NumericalError("the orientation is not finite, " + when, "body " + std::to_string(b),
                           "take a smaller time step, or check the moments on it");
}

Vec3 angularVelocity(const Bodies& bodies, int body) {
  const auto b = static_cast<std::size_t>(body);
  const Quaternion& q = bodies.orientation[b];
  return rotate(q, overInertia(rotateBack(q, bodies.angularMomentum[b]), bodies.inertia[b]));
}

void setAngularVelocity(Bodies& bodies, int body, const Vec3& omega) {
  const auto b = static_cast<std::size_t>(body);
  const Quaternion& q = bodies.orientation[b];
  const Vec3 w = rotateBack(q, omega), &i = bodies.inertia[b];
  bodies.angularMomentum[b] = rotate(q, {i.x * w.x, i.y * w.y, i.z * w.z});
}

void clearForces(Bodies& bodies) {
  for (std::size_t b = 0; b < bodies.size(); ++b) bodies.f[b] = bodies.torque[b] = {};
}

void applyGravity(Bodies& bodies, const Vec3& g) {
  for (std::size_t b = 0; b < bodies.size(); ++b) bodies.f[b] += bodies.mass[b] * g;
}

void kickBodies(Bodies& bodies, double dt) {
  parallelFor(bodies.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      bodies.v[b] += (dt / bodies.mass[b]) * bodies.f[b];
      bodies.angularMomentum[b] += dt * bodies.torque[b];
    }
  });
}

void driftBodies(Bodies& bodies, double dt) {
  parallelFor(bodies.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      bodies.x[b] += dt * bodies.v[b];
      Quaternion q = bodies.turnedFrom[b] = bodies.orientation[b];
      const Vec3 &l = bodies.angularMomentum[b], &inertia = bodies.inertia[b];
      for (const int k : {0, 1}) q = turnAbout(k, 0.5 * dt, q, l, inertia);
      q = turnAbout(2, dt, q, l, inertia);
      for (const int k : {1, 0}) q = turnAbout(k, 0.5 * dt, q, l, inertia);
      bodies.orientation[b] = normalized(q);
    }
  });
}

double applyViscousDamping(Bodies& bodies, double rate) {
  requireNonNegative(rate, "damping rate");
  double power = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    bodies.f[b] -= (rate * bodies.mass[b]) * bodies.v[b];
    bodies.torque[b] -= rate * bodies.angularMomentum[b];
    power += rate * (bodies.mass[b] * squaredNorm(bodies.v[b]) +
                     dot(bodies.angularMomentum[b], angularVelocity(bodies, static_cast<int>(b))));
  }
  return power;
}

double applyLocalDamping(Bodies& bodies, double alpha) {
  if (!(alpha >= 0.0 && alpha < 1.0))
    throw InputError("the local damping is " + formatNumber(alpha), "local damping", "give 0 ≤ α < 1, such as 0.7");
  double power = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    power += resist(bodies.f[b], bodies.v[b], alpha);
    power += resist(bodies.torque[b], angularVelocity(bodies, static_cast<int>(b)), alpha);
  }
  return power;
}

Vec3 wrapPositions(Bodies& bodies, const geometry::Periodicity& space) {
  Vec3 moved;
  for (int k = 0; k < 3; ++k) {
    if (!space.axes[static_cast<std::size_t>(k)]) continue;
    const double length = space.length(k), lower = space.box.lower[k];
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const double periods = std::floor((bodies.x[b][k] - lower) / length);
      if (periods == 0.0) continue;
      bodies.x[b][k] -= length * periods;
      moved[k] -= bodies.mass[b] * length * periods;
    }
  }
  return moved;
}

void renumber(Bodies& bodies, std::span<const int> newNumber) {
  const auto compact = [&](auto& values) {
    std::size_t count = 0;
    for (std::size_t b = 0; b < newNumber.size(); ++b)
      if (newNumber[b] >= 0) values[count++] = values[b];
    values.resize(count);
  };
  compact(bodies.x);
  compact(bodies.v);
  compact(bodies.f);
  compact(bodies.mass);
  compact(bodies.inertia);
  compact(bodies.orientation);
  compact(bodies.turnedFrom);
  compact(bodies.angularMomentum);
  compact(bodies.torque);
}

double kineticEnergy(const Bodies& bodies) {
  return parallelSum(bodies.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t b = begin; b < end; ++b) {
      const Vec3 l = rotateBack(bodies.orientation[b], bodies.angularMomentum[b]);
      sum += 0.5 * (bodies.mass[b] * squaredNorm(bodies.v[b]) + dot(l, overInertia(l, bodies.inertia[b])));
    }
    return sum;
  });
}

Vec3 momentum(const Bodies& bodies) {
  Vec3 sum;
  for (std::size_t b = 0; b < bodies.size(); ++b) sum += bodies.mass[b] * bodies.v[b];
  return sum;
}

Vec3 angularMomentum(const Bodies& bodies) {
  Vec3 sum;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    sum += bodies.mass[b] * cross(bodies.x[b], bodies.v[b]) + bodies.angularMomentum[b];
  return sum;
}

}  // namespace dovetail::dem
