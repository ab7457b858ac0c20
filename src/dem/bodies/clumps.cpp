#include "dovetail/dem/bodies/clumps.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/parallel.hpp"

namespace dovetail::dem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Largest (r × n)·I⁻¹(r × n) over unit vectors n; r in the principal frame. 1/kg
double turnability(const Vec3& r, const Vec3& inertia) {
  Eigen::Matrix3d arm;
  arm << 0.0, -r.z, r.y, r.z, 0.0, -r.x, -r.y, r.x, 0.0;
  const Eigen::Vector3d inverse(1.0 / inertia.x, 1.0 / inertia.y, 1.0 / inertia.z);
  const Eigen::Matrix3d form = arm.transpose() * inverse.asDiagonal() * arm;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(form, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

}  // namespace

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
    clumps.particle.push_back(particle);
    clumps.body.push_back(body);
    clumps.offset.push_back(rotateBack(bodies.orientation[at(body)], arm));
  }
  return body;
}

double placeMembers(const Bodies& bodies, const Clumps& clumps, Particles& particles) {
  constexpr std::size_t grain = 1024;
  std::vector<Vec3> omega(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) omega[b] = angularVelocity(bodies, static_cast<int>(b));
  std::vector<double> squared((clumps.size() + grain - 1) / grain, 0.0);
  parallelFor(clumps.size(), grain, [&](std::size_t begin, std::size_t end) {
    double& largest = squared[begin / grain];
    for (std::size_t m = begin; m < end; ++m) {
      const std::size_t b = at(clumps.body[m]), i = at(clumps.particle[m]);
      const Vec3 arm = rotate(bodies.orientation[b], clumps.offset[m]), x = bodies.x[b] + arm;
      const double moved = squaredNorm(x - particles.x[i]);
      if (!(moved <= largest)) largest = std::isfinite(moved) ? moved : std::numeric_limits<double>::infinity();
      particles.x[i] = x;
      particles.v[i] = bodies.v[b] + cross(omega[b], arm);
      if (particles.rotates()) particles.omega[i] = omega[b];
    }
  });
  double largest = 0.0;
  for (const double s : squared) largest = std::max(largest, s);
  return std::sqrt(largest);
}

void gatherForces(Particles& particles, const Clumps& clumps, Bodies& bodies, const Vec3& gravity) {
  int last = -1;
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    const std::size_t b = at(clumps.body[m]), i = at(clumps.particle[m]);
    const Vec3 force = particles.f[i] - particles.mass[i] * gravity;
    bodies.f[b] += force;
    bodies.torque[b] += cross(particles.x[i] - bodies.x[b], force);
    if (clumps.body[m] != last) bodies.f[b] += bodies.mass[b] * gravity;
    last = clumps.body[m];
    particles.f[i] = {};
    if (!particles.rotates()) continue;
    bodies.torque[b] += particles.torque[i];
    particles.torque[i] = {};
  }
}

void muteMemberPairs(const Clumps& clumps, PairList& list) {
  if (clumps.size() == 0) return;
  std::vector<int> bodyOf(list.positionAtBuild.size(), -1);
  for (std::size_t m = 0; m < clumps.size(); ++m) bodyOf[at(clumps.particle[m])] = clumps.body[m];
  if (list.scale.empty()) list.scale.assign(list.pairs.size(), 1.0);
  for (std::size_t p = 0; p < list.pairs.size(); ++p) {
    const int body = bodyOf[at(list.pairs[p][0])];
    if (body >= 0 && body == bodyOf[at(list.pairs[p][1])]) list.scale[p] = 0.0;
  }
}

CriticalStep criticalStep(const Bodies& bodies, const Clumps& clumps, const LinearSpringDashpot& normal,
                          Partners partners, int contacts) {
  Particles members;
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    const std::size_t b = at(clumps.body[m]);
    const double mass = 1.0 / (1.0 / bodies.mass[b] + turnability(clumps.offset[m], bodies.inertia[b]));
    addParticle(members, {}, {}, 1.0, Mass{mass});
  }
  CriticalStep step = criticalStep(members, normal, partners, contacts);
  if (step.particle >= 0) step.particle = clumps.particle[at(step.particle)];
  return step;
}

double freeKineticEnergy(const Particles& particles, const Clumps& clumps) {
  std::vector<char> member(particles.size(), 0);
  for (const int i : clumps.particle) member[at(i)] = 1;
  return parallelSum(particles.size(), 4096, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (member[i]) continue;
      sum += 0.5 * particles.mass[i] * squaredNorm(particles.v[i]);
      if (particles.rotates())
        sum += 0.5 * momentOfInertia(particles, static_cast<int>(i)) * squaredNorm(particles.omega[i]);
    }
    return sum;
  });
}

}  // namespace dovetail::dem
