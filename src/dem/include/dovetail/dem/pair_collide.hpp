// Forces between particles.
#pragma once

#include <cmath>
#include <utility>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/contact_work.hpp"
#include "dovetail/dem/laws.hpp"
#include "dovetail/dem/pairs.hpp"

namespace dovetail::dem {

/// Two spheres that may touch.
struct PairContact {
  Vec3 normal;     ///< unit, from particle j to particle i
  double overlap;  ///< m, > 0 when touching
  Vec3 armI;       ///< from the centre of i to the middle of the overlap, m
  Vec3 armJ;       ///< from the centre of j, m
};

/// Where centres coincide, particle i (the lower number) is pushed towards +x.
inline PairContact pairContact(const Particles& particles, std::size_t i, std::size_t j) {
  const Vec3 d = particles.x[i] - particles.x[j];
  const double distance = norm(d);
  const Vec3 normal = distance > 0.0 ? d / distance : Vec3{1.0, 0.0, 0.0};
  const double overlap = particles.radius[i] + particles.radius[j] - distance;
  const Vec3 armI = -(particles.radius[i] - 0.5 * overlap) * normal;
  return {normal, overlap, armI, armI + d};
}

namespace detail {

/// @throws InputError unless dt is finite and > 0
void requireStep(double dt);
/// Adds the pair forces to the particles in the order of the list, whatever the number of threads.
void addPairForces(Particles& particles, const PairList& list, bool withTorque);

/// Force of one pair; writes to places of this pair only.
template <class Law, class Normal>
ContactWork pairForce(const Particles& particles, PairList& list, std::size_t p, const Law& law, const Normal& normal,
                      double dt) {
  const auto i = static_cast<std::size_t>(list.pairs[p][0]), j = static_cast<std::size_t>(list.pairs[p][1]);
  const PairContact contact = pairContact(particles, i, j);
  const double scale = list.scale.empty() ? 1.0 : list.scale[p];
  ContactWork work;
  list.force[p] = {};
  if (!(contact.overlap > 0.0) && !normal.bonded) {
    if constexpr (Law::hasHistory) {
      work.frictionPower = 0.5 * scale * law.tangential.stiffness * squaredNorm(list.stretch[p]) / dt;
      list.stretch[p] = {};
    }
    return work;
  }
  Vec3 velocity = particles.v[i] - particles.v[j];
  if constexpr (Law::hasHistory)
    if (particles.rotates())
      velocity += cross(particles.omega[i], contact.armI) - cross(particles.omega[j], contact.armJ);
  const double separating = dot(contact.normal, velocity);
  // Masses carry the scale too, so it is divided out of the effective one.
  const double rootMass =
      normal.dampingPerRootMass > 0.0 && scale > 0.0
          ? std::sqrt(particles.mass[i] * (particles.mass[j] / (particles.mass[i] + particles.mass[j])) / scale)
          : 0.0;
  const double pressure = normal.force(contact.overlap, separating, 1.0, rootMass);
  list.force[p] = scale * pressure * contact.normal;
  work.elasticEnergy = scale * normal.energy(contact.overlap, 1.0);
  work.dissipatedPower = scale * (normal.elasticForce(contact.overlap) - pressure) * separating;
  if constexpr (Law::hasHistory) {
    const auto grip = law.tangential.respond(list.stretch[p], contact.normal, velocity, pressure, dt);
    list.force[p] += scale * grip.force;
    work.tangentialEnergy = scale * grip.energy;
    work.frictionPower = scale * grip.slipWork / dt;
  }
  return work;
}

}  // namespace detail

/// Sets list.force and adds it to particles.f, equal and opposite (and torques, if the law has friction and the
/// particles spin). Bitwise the same for any number of threads. Call once per step if the law has friction.
/// @param dt  step over which tangential springs stretch, s; of no concern to other laws
/// @throws InputError if the law has friction and dt is not finite and > 0
template <class Normal, class Tangential>
ContactWork collide(Particles& particles, PairList& list, const ContactLaw<Normal, Tangential>& law, double dt = 0.0) {
  using Law = ContactLaw<Normal, Tangential>;
  constexpr std::size_t grain = 512;
  ContactWork work;
  if constexpr (Law::hasHistory) {
    detail::requireStep(dt);
    work.frictionPower = 0.5 * law.tangential.stiffness * std::exchange(list.endedStretch, 0.0) / dt;
  }
  const std::size_t n = list.pairs.size();
  if (n == 0) return work;
  list.force.resize(n);
  if constexpr (Law::hasHistory) list.stretch.resize(n);
  const auto normal = law.normal.prepare();
  const auto forces = [&](std::size_t begin, std::size_t end) {
    ContactWork sum;
    for (std::size_t p = begin; p < end; ++p) sum += detail::pairForce(particles, list, p, law, normal, dt);
    return sum;
  };
  work += n <= grain ? forces(0, n) : parallelSum(n, grain, forces);
  detail::addPairForces(particles, list, Law::hasHistory && particles.rotates());
  return work;
}

}  // namespace dovetail::dem
