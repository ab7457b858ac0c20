// Impacts of a sphere on a sphere or a wall, with their ledger.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "dovetail/dem/laws/materials.hpp"
#include "dovetail/dem/pairs/pair_collide.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {

/// Runs particles, their pairs and (if asked for) the wall z = 0 under one law, and keeps the ledger.
struct Impact {
  Particles particles;
  PairList list;
  std::shared_ptr<const ContactLaws> laws;
  TriangulatedWall wall;
  WallCandidates candidates;
  WallContacts contacts;
  bool againstWall;

  double peakForce = 0.0, peakOverlap = 0.0, contactTime = 0.0;  // of particle 0
  double lost = 0.0, stored = 0.0, start = 0.0;
  double worstResidual = 0.0;               // largest |kinetic + stored + lost − start|, J
  double worstGain = 0.0;                   // largest kinetic + stored − start, J
  double impulse = 0.0, deepImpulse = 0.0;  // ∫F dt, N s, and ∫F δ dt, N s m, of the normal force on particle 0
  double dashpots = 0.0;                    // W, at the last step
  double leastPower = 0.0;                  // most negative power booked to friction, rolling or plastic flow, W
  ContactWork work;

  Impact(Particles who, const auto& law, bool onWall)
      : particles(std::move(who)), laws(makeContactLaws(law)), againstWall(onWall) {
    if (!particles.rotates()) switchOnRotation(particles);
    const double radius = *std::max_element(particles.radius.begin(), particles.radius.end());
    list.setSkin(0.2 * radius);
    findPairs(particles, list);
    if (againstWall) {
      wall = squares(2, 2, 8.0 * radius);
      for (Vec3& x : wall.x) x -= Vec3{8.0 * radius, 8.0 * radius, 0.0};
      candidates.skin = 0.2 * radius;
    }
    start = kineticEnergy(particles);
  }

  /// Forces of all contacts, after drift.
  void exchange(double dt, const Vec3& g = {}) {
    updatePairs(particles, list);
    startForces(particles, g);
    work = laws->pairs(particles, list, dt, Booking::on);
    if (!againstWall) return;
    updateWallCandidates(particles, wall, candidates, movesOf(particles, dt));
    findWallContacts(particles, wall, candidates, EdgeRule::projected, contacts);
    work += laws->wall(particles, wall, contacts, dt, Booking::on);
  }

  void step(double dt, const Vec3& g = {}) {
    kick(particles, 0.5 * dt);
    drift(particles, dt);
    exchange(dt, g);
    kick(particles, 0.5 * dt);
    book(dt);
  }

  /// As a model does: what dashpots take at an instant for the halves of the steps before and after it.
  void book(double dt) {
    lost += (work.lostPower() - 0.5 * (work.dissipatedPower - dashpots)) * dt;
    dashpots = work.dissipatedPower;
    stored = work.storedEnergy();
    leastPower = std::min({leastPower, work.frictionPower, work.rollingPower, work.plasticPower});
    const double energy = kineticEnergy(particles) + stored;
    worstResidual = std::max(worstResidual, std::abs(energy + lost - start));
    worstGain = std::max(worstGain, energy - start);
    const double force = norm(particles.f[0]);
    peakForce = std::max(peakForce, force);
    if (force > 0.0) contactTime += dt;
    const double overlap = againstWall ? particles.radius[0] - particles.x[0].z : pairContact(particles, 0, 1).overlap;
    peakOverlap = std::max(peakOverlap, overlap);
    if (againstWall) {
      impulse += particles.f[0].z * dt;
      deepImpulse += particles.f[0].z * overlap * dt;
    }
  }

  /// Distance of the centre from the contact on the wall over the radius, averaged as the force is.
  double meanArm() const { return 1.0 - deepImpulse / (impulse * particles.radius[0]); }

  void run(double dt, double duration) {
    const auto steps = static_cast<int>(std::ceil(duration / dt));
    for (int s = 0; s < steps; ++s) step(dt);
  }
};

/// A sphere above the wall z = 0, a little before it touches.
inline Particles aboveWall(double radius, double density, const Vec3& v, const Vec3& omega = {}, double gap = 1e-9) {
  Particles particles;
  addParticle(particles, {0.37 * radius, 0.11 * radius, radius * (1.0 + gap)}, v, radius, Density{density});
  switchOnRotation(particles);
  particles.omega[0] = omega;
  return particles;
}

/// Two spheres whose centres lie along `direction`, a little before they touch.
inline Particles headOn(double radiusA, double radiusB, double density, const Vec3& direction, const Vec3& vA,
                        const Vec3& vB, double gap = 1e-9) {
  Particles particles;
  addParticle(particles, {}, vA, radiusA, Density{density});
  addParticle(particles, (radiusA + radiusB) * (1.0 + gap) * normalized(direction), vB, radiusB, Density{density});
  switchOnRotation(particles);
  return particles;
}

}  // namespace dovetail::dem
