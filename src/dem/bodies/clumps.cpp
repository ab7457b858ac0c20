#include "dovetail/dem/bodies/clumps.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "rotational_mobility.hpp"

namespace dovetail::dem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

double rotationalMobility(const Vec3& r, const Vec3& inertia) {
  Eigen::Matrix3d arm;
  arm << 0.0, -r.z, r.y, r.z, 0.0, -r.x, -r.y, r.x, 0.0;
  const Eigen::Vector3d inverse(1.0 / inertia.x, 1.0 / inertia.y, 1.0 / inertia.z);
  const Eigen::Matrix3d form = arm.transpose() * inverse.asDiagonal() * arm;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(form, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

ClumpShape makeClumpShape(std::span<const Vec3> centre, std::span<const double> radius, Density density,
                          Overlap overlap) {
  ClumpShape shape{
      overlap == Overlap::once ? unionOfSpheres(centre, radius, density) : sumOfSpheres(centre, radius, density),
      {},
      {radius.begin(), radius.end()}};
  for (const Vec3& c : centre) shape.offset.push_back(c - shape.properties.centre);
  return shape;
}

int addClump(Particles& particles, Bodies& bodies, Clumps& clumps, const ClumpShape& shape, const Vec3& x,
             const Quaternion& turn, const Vec3& v, const Vec3& omega) {
  const int body = addBody(bodies, shape.properties, x, turn, v, omega);
  const Quaternion q = normalized(turn);
  for (std::size_t k = 0; k < shape.offset.size(); ++k) {
    const Vec3 arm = rotate(q, shape.offset[k]);
    const int particle =
        addParticle(particles, x + arm, v + cross(omega, arm), shape.radius[k], Mass{shape.properties.mass});
    if (particles.rotates()) particles.omega[at(particle)] = omega;
    setOwner(particles, particle, Owner::body);
    clumps.particle.push_back(particle);
    clumps.body.push_back(body);
    clumps.offset.push_back(rotateBack(bodies.orientation[at(body)], arm));
  }
  return body;
}

double placeMembers(const Bodies& bodies, const Clumps& clumps, const geometry::Periodicity& space,
                    Particles& particles) {
  constexpr std::size_t chunkSize = 1024;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> squared((clumps.size() + chunkSize - 1) / chunkSize, 0.0);
  parallelFor(clumps.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double& largest = squared[begin / chunkSize];
    int last = -1;
    Vec3 omega;
    for (std::size_t m = begin; m < end; ++m) {
      const std::size_t b = at(clumps.body[m]), i = at(clumps.particle[m]);
      if (clumps.body[m] != last) omega = angularVelocity(bodies, clumps.body[m]);
      last = clumps.body[m];
      const Vec3 arm = rotate(bodies.orientation[b], clumps.offset[m]);
      Vec3 x = bodies.x[b] + arm;
      if (space.any()) x = particles.x[i] + space.minimumImage(x - particles.x[i]);
      const double moved = squaredNorm(x - particles.x[i]);
      if (!(moved <= largest)) largest = std::isfinite(moved) ? moved : infinity;
      particles.x[i] = x;
      particles.v[i] = bodies.v[b] + cross(omega, arm);
      if (particles.rotates()) particles.omega[i] = omega;
    }
  });
  double largest = 0.0;
  for (const double s : squared) largest = std::max(largest, s);
  return std::sqrt(largest);
}

void spinMembers(const Bodies& bodies, const Clumps& clumps, Particles& particles) {
  if (!particles.rotates()) return;
  for (std::size_t m = 0; m < clumps.size(); ++m)
    particles.omega[at(clumps.particle[m])] = angularVelocity(bodies, clumps.body[m]);
}

void gatherForces(Particles& particles, const Clumps& clumps, Bodies& bodies, const Vec3& gravity) {
  parallelFor(bodies.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) bodies.f[b] += bodies.mass[b] * gravity;
    const auto first = std::lower_bound(clumps.body.begin(), clumps.body.end(), static_cast<int>(begin));
    for (auto m = static_cast<std::size_t>(first - clumps.body.begin()); m < clumps.size(); ++m) {
      const std::size_t b = at(clumps.body[m]), i = at(clumps.particle[m]);
      if (b >= end) break;
      const Vec3 force = particles.f[i] - particles.mass[i] * gravity;
      bodies.f[b] += force;
      bodies.torque[b] += cross(rotate(bodies.orientation[b], clumps.offset[m]), force);
      particles.f[i] = {};
      if (!particles.rotates()) continue;
      bodies.torque[b] += particles.torque[i];
      particles.torque[i] = {};
    }
  });
}

void renumber(Bodies& bodies, Clumps& clumps, std::span<const int> newNumber) {
  std::vector<char> gone(bodies.size(), 0), stays(bodies.size(), 0);
  for (std::size_t m = 0; m < clumps.size(); ++m)
    (newNumber[at(clumps.particle[m])] < 0 ? gone : stays)[at(clumps.body[m])] = 1;
  std::vector<int> body(bodies.size());
  int next = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (gone[b] != 0 && stays[b] != 0)
      throw InputError("some of its members were removed", "body " + std::to_string(b), "remove whole clumps only");
    body[b] = gone[b] != 0 ? -1 : next++;
  }
  if (at(next) < bodies.size()) renumber(bodies, body);
  std::size_t kept = 0;
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    const int particle = newNumber[at(clumps.particle[m])];
    if (particle < 0) continue;
    clumps.body[kept] = body[at(clumps.body[m])];
    clumps.offset[kept] = clumps.offset[m];
    clumps.particle[kept++] = particle;
  }
  clumps.particle.resize(kept);
  clumps.body.resize(kept);
  clumps.offset.resize(kept);
}

void check(const Particles& particles, const Bodies& bodies, const Clumps& clumps) {
  if (clumps.body.size() != clumps.size() || clumps.offset.size() != clumps.size())
    throw InputError("the arrays differ in length", "clumps", "add clumps with addClump");
  std::vector<char> member(particles.size(), 0);
  int last = 0;
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    const int body = clumps.body[m], i = clumps.particle[m];
    const std::string where = "clump of body " + std::to_string(body);
    if (body < last || at(body) >= bodies.size())
      throw InputError("there is no such body here, or bodies are out of order", where, "add clumps with addClump");
    last = body;
    if (i < 0 || at(i) >= particles.size())
      throw InputError("there is no particle " + std::to_string(i), where,
                       "call renumber when particles have been removed");
    if (std::exchange(member[at(i)], char{1}) != 0)
      throw InputError("particle " + std::to_string(i) + " is a member twice", where, "add clumps with addClump");
    if (particles.mass[at(i)] != bodies.mass[at(body)])
      throw InputError("particle " + std::to_string(i) + " has another mass than its body", where,
                       "give members the mass of the body");
    if (!isFinite(clumps.offset[m])) throw InputError("an offset is not finite", where, "give three finite numbers");
  }
}

void requireShorter(const ClumpShape& shape, const geometry::Periodicity& space, const std::string& where) {
  double least = std::numeric_limits<double>::infinity(), reach = 0.0, length = 0.0;
  for (int k = 0; k < 3; ++k)
    if (space.axes[static_cast<std::size_t>(k)]) least = std::min(least, space.length(k));
  for (std::size_t a = 0; a < shape.offset.size(); ++a)
    reach = std::max(reach, norm(shape.offset[a]) + shape.radius[a]);
  if (2.0 * reach < least) return;
  for (std::size_t a = 0; a < shape.offset.size(); ++a)
    for (std::size_t b = 0; b <= a; ++b)
      length = std::max(length, norm(shape.offset[a] - shape.offset[b]) + shape.radius[a] + shape.radius[b]);
  for (int k = 0; k < 3; ++k)
    if (space.axes[static_cast<std::size_t>(k)] && !(length < space.length(k)))
      throw InputError("it is " + formatNumber(length) + " m long, and the period is " + formatNumber(space.length(k)) +
                           " m along " + "xyz"[k],
                       where, "take a shorter clump or a longer period: it would touch its own image");
}

void requireShorter(const Particles& particles, const Clumps& clumps, const geometry::Periodicity& space) {
  if (!space.any()) return;
  for (std::size_t m = 0; m < clumps.size();) {
    const int body = clumps.body[m];
    ClumpShape shape;
    for (; m < clumps.size() && clumps.body[m] == body; ++m) {
      shape.offset.push_back(clumps.offset[m]);
      shape.radius.push_back(particles.radius[at(clumps.particle[m])]);
    }
    requireShorter(shape, space, "clump of body " + std::to_string(body));
  }
}

std::vector<int> bodyOfParticles(std::size_t particles, const Clumps& clumps) {
  std::vector<int> bodyOf(particles, -1);
  for (std::size_t m = 0; m < clumps.size(); ++m) bodyOf[at(clumps.particle[m])] = clumps.body[m];
  return bodyOf;
}

void muteMemberPairs(const Clumps& clumps, PairList& list) {
  if (clumps.size() == 0) return;
  const std::vector<int> bodyOf = bodyOfParticles(list.particles(), clumps);
  const std::span<double> factors = list.writeFactors();
  for (std::size_t p = 0; p < list.size(); ++p) {
    const auto& [i, j] = list.pairs()[p];
    if (const int body = bodyOf[at(i)]; body >= 0 && body == bodyOf[at(j)]) factors[p] = 0.0;
  }
}

void addDemand(ContactDemand& demand, const Particles& particles, const Bodies& bodies, const Clumps& clumps) {
  if (clumps.size() == 0) return;
  demand.body.resize(particles.size(), -1);
  demand.lever.resize(particles.size(), 1.0);
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    const std::size_t b = at(clumps.body[m]), i = at(clumps.particle[m]);
    const double mass = bodies.mass[b], radius = particles.radius[i];
    const double least = std::min({bodies.inertia[b].x, bodies.inertia[b].y, bodies.inertia[b].z});
    const double central = rotationalMobility(clumps.offset[m], bodies.inertia[b]);
    const double arm = std::sqrt(central) + radius / std::sqrt(least);  // a bound on the root of λ on the surface
    // Where particles spin, the demand holds 7/2 of a tangential stiffness and the rolling one over 2/5 R².
    const double side = std::max((1.0 / mass + arm * arm) / 3.5, radius * radius / (2.5 * least));
    demand.body[i] = clumps.body[m];
    demand.lever[i] = 1.0 + mass * (central + (particles.rotates() ? side : 0.0));
  }
}

double freeKineticEnergy(const Particles& particles) {
  return parallelSum(particles.size(), 4096, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (particles.isMember(i)) continue;
      sum += 0.5 * particles.mass[i] * squaredNorm(particles.v[i]);
      if (particles.rotates())
        sum += 0.5 * momentOfInertia(particles, static_cast<int>(i)) * squaredNorm(particles.omega[i]);
    }
    return sum;
  });
}

}  // namespace dovetail::dem
