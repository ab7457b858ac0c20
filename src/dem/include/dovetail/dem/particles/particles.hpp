// Particles as a structure of arrays, and the verbs of their time step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

/// What moves a particle in place of its own forces: the body of its clump, a drive, or a solid that it stands for a
/// part of.
enum class Owner : std::uint8_t { nobody, body, drive, solid };

/// Spheres. All arrays that are in use have one entry per particle. What refers to a particle by its number is out of
/// date as soon as `revision` has changed; what must last refers to it by its id.
struct Particles {
  std::vector<Vec3> x;         ///< centres, m
  std::vector<Vec3> v;         ///< velocities, m/s
  std::vector<Vec3> f;         ///< forces, N
  std::vector<double> radius;  ///< m
  std::vector<double> mass;    ///< kg
  std::vector<Vec3> omega;     ///< angular velocities, rad/s; empty = particles do not spin
  std::vector<Vec3> torque;    ///< torques about the centre, N m; as long as omega

  std::vector<std::uint8_t> material;  ///< row of a LawTable; empty = all are of material 0
  /// Fraction of a particle that is modelled here, in (0, 1], the rest being another model's; empty = 1. Inertia,
  /// weight and energies count it; mass and radius are those of the whole particle.
  std::vector<double> weight;
  std::vector<Owner> owner;      ///< empty = none
  std::vector<std::int64_t> id;  ///< names that stay when particles are sorted or removed; no id is given twice

  std::int64_t nextId = 0;
  std::int64_t revision = 0;  ///< raised by whatever changes the number of particles or their numbering
  std::int64_t wraps = 0;     ///< raised when positions were moved by whole periods

  mutable std::vector<int> byId;  ///< numbers by ascending id, made by `find`
  mutable std::int64_t byIdRevision = -1;

  std::size_t size() const { return x.size(); }
  bool rotates() const { return !omega.empty(); }
  Owner ownerOf(std::size_t i) const { return owner.empty() ? Owner::nobody : owner[i]; }
  /// Whether something else counts its mass, its motion and the forces on it.
  bool isMember(std::size_t i) const { return ownerOf(i) == Owner::body || isOfSolid(i); }
  bool isOfSolid(std::size_t i) const { return ownerOf(i) == Owner::solid; }
  double weightOf(std::size_t i) const { return weight.empty() ? 1.0 : weight[i]; }
};

/// Calls act(array) for each array with an entry per particle; those that are not in use are empty.
template <class P, class Act>
void forEachArray(P& p, Act&& act) {
  act(p.x);
  act(p.v);
  act(p.f);
  act(p.radius);
  act(p.mass);
  act(p.omega);
  act(p.torque);
  act(p.material);
  act(p.weight);
  act(p.owner);
  act(p.id);
}

/// kg/m³; a type of its own, so that a density cannot be taken for a mass.
struct Density {
  double value;
};
/// kg
struct Mass {
  double value;
};

/// Appends a particle at rest from forces; it spins (from rest) if the others do. Returns its number.
/// @throws InputError naming particle and field if x (1e15 m at most) or v is not finite, or radius or mass not > 0
int addParticle(Particles& particles, const Vec3& x, const Vec3& v, double radius, Mass mass);
int addParticle(Particles& particles, const Vec3& x, const Vec3& v, double radius, Density density);

/// Number of the particle with this id, or −1. The first call after a change of numbering makes a table, O(N log N);
/// others take O(log N). Not to be called by several threads at once.
int find(const Particles& particles, std::int64_t id);

/// New number of every particle when those listed go and the others close up in their order; −1 for those that go.
/// Pass it to all that refers to particles (`renumber`), and last to the particles themselves.
/// @param list numbers in any order; twice does not matter
/// @throws InputError on a number that does not exist
std::vector<int> numbersWithout(const Particles& particles, std::span<const int> list);

/// Moves particles to their new numbers, and takes those out that have none (< 0).
/// @param newNumber one per particle; those ≥ 0 are 0 … n − 1, each once
void renumber(Particles& particles, std::span<const int> newNumber);

/// numbersWithout and renumber, if nothing else refers to particles, or is renumbered later. Returns the new numbers.
std::vector<int> removeParticles(Particles& particles, std::span<const int> list);

void setOwner(Particles& particles, int particle, Owner owner);

/// Gives every particle a spin (zero) and a torque. Needed for friction to roll particles; without it they only slide.
void switchOnRotation(Particles& particles);

/// Checks lengths and values of all arrays, and that no id occurs twice.
/// @throws InputError naming the particle and the field
void validate(const Particles& particles);

/// 2/5 m R² of a solid sphere, the whole of it, kg m².
inline double momentOfInertia(const Particles& particles, int particle) {
  const auto i = static_cast<std::size_t>(particle);
  return 0.4 * particles.mass[i] * particles.radius[i] * particles.radius[i];
}

/// Forces (and torques) to zero.
void clearForces(Particles& particles);
/// f += w m g, g in m/s², w = weight.
void applyGravity(Particles& particles, const Vec3& g);

/// Velocity Verlet is kick(dt/2) · drift(dt) · forces · kick(dt/2).
/// v += f/(w m) dt, and omega += torque/(w I) dt where particles spin; w = weight.
void kick(Particles& particles, double dt);
/// x += v dt. (A sphere looks the same from every side: no orientation is kept.)
void drift(Particles& particles, double dt);
/// kick(dt/2) and drift(dt) in one sweep. Returns the largest displacement of a particle, m; infinite if some velocity
/// or spin is not finite: these particles keep their places and forces, for requireFinite to report them.
double kickAndDrift(Particles& particles, double dt);
/// kickAndDrift and startForces in one sweep: all of a step that comes before its contacts. kick(dt/2) ends the step.
double startStep(Particles& particles, double dt, const Vec3& g);
/// The end of a step and the start of the next in one sweep: kick(dt/2), then startStep. The same digits, fewer trips
/// to memory.
double turnStep(Particles& particles, double dt, const Vec3& g);
/// f = w m g and torque = 0 in one sweep: clearForces and applyGravity.
void startForces(Particles& particles, const Vec3& g);

/// ½ Σ w m v² (+ ½ Σ w I ω²), J.
double kineticEnergy(const Particles& particles);
/// Σ w m v, kg m/s.
Vec3 momentum(const Particles& particles);
/// Σ w m x × v (+ Σ w I ω) about the origin, kg m²/s.
Vec3 angularMomentum(const Particles& particles);

/// @param when for instance "t = 0.5 s, step 100"
/// @throws NumericalError naming what is NaN or Inf, and the first particle (by its id) of which it is: mass, radius,
///   weight, position, force, torque, angular velocity, velocity, in this order, as the former spoil the latter
void requireFinite(const Particles& particles, const std::string& when);

}  // namespace dovetail::dem
