// Particles as a structure of arrays, and the verbs of their time step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

/// Spheres. All arrays that are in use have one entry per particle.
struct Particles {
  std::vector<Vec3> x;         ///< centres, m
  std::vector<Vec3> v;         ///< velocities, m/s
  std::vector<Vec3> f;         ///< forces, N
  std::vector<double> radius;  ///< m
  std::vector<double> mass;    ///< kg
  std::vector<Vec3> omega;     ///< angular velocities, rad/s; empty = particles do not spin
  std::vector<Vec3> torque;    ///< torques about the centre, N m; as long as omega

  std::vector<std::uint8_t> material;  ///< row of a LawTable; empty = all are of material 0
  std::vector<std::int64_t> id;        ///< names that stay when particles are sorted or removed; empty = never sorted

  std::size_t size() const { return x.size(); }
  bool rotates() const { return !omega.empty(); }
};

/// kg/m³; a type of its own so that nobody takes a density for a mass.
struct Density {
  double value;
};
/// kg
struct Mass {
  double value;
};

/// Appends a particle at rest from forces; it spins (from rest) if the others do. Returns its number.
/// @throws InputError naming the particle and the field if x or v is not finite, or radius or mass not finite and > 0
int addParticle(Particles& particles, const Vec3& x, const Vec3& v, double radius, Mass mass);
int addParticle(Particles& particles, const Vec3& x, const Vec3& v, double radius, Density density);

/// Gives every particle a spin (zero) and a torque. Needed for friction to roll particles; without it they only slide.
void switchOnRotation(Particles& particles);

/// Checks lengths and values of all arrays.
/// @throws InputError naming the particle and the field
void validate(const Particles& particles);

/// 2/5 m R² of a solid sphere, kg m².
double momentOfInertia(const Particles& particles, int particle);

/// Forces (and torques) to zero.
void clearForces(Particles& particles);
/// f += m g, g in m/s².
void applyGravity(Particles& particles, const Vec3& g);

/// Velocity Verlet is kick(dt/2) · drift(dt) · forces · kick(dt/2).
/// v += f/m dt, and omega += torque/I dt where particles spin.
void kick(Particles& particles, double dt);
/// x += v dt. (A sphere looks the same from every side: no orientation is kept.)
void drift(Particles& particles, double dt);
/// kick(dt/2) and drift(dt) in one sweep. Returns the largest displacement of a particle, m; infinite if some position
/// or velocity is not finite.
double kickAndDrift(Particles& particles, double dt);
/// kickAndDrift and startForces in one sweep: all of a step that comes before its contacts. kick(dt/2) ends the step.
double startStep(Particles& particles, double dt, const Vec3& g);
/// The end of a step and the start of the next in one sweep: kick(dt/2), then startStep. The same digits, fewer trips
/// to memory.
double turnStep(Particles& particles, double dt, const Vec3& g);
/// f = m g and torque = 0 in one sweep: clearForces and applyGravity.
void startForces(Particles& particles, const Vec3& g);

/// ½ Σ m v² (+ ½ Σ I ω²), J.
double kineticEnergy(const Particles& particles);
/// Σ m v, kg m/s.
Vec3 momentum(const Particles& particles);
/// Σ m x × v (+ Σ I ω) about the origin, kg m²/s.
Vec3 angularMomentum(const Particles& particles);

/// @param when for instance "t = 0.5 s, step 100"
/// @throws NumericalError naming the first particle whose position or velocity is NaN or Inf
void requireFinite(const Particles& particles, const std::string& when);

}  // namespace dovetail::dem
