// Damping of whole scenes, and mass scaling. Nothing of this acts unless it is called.
#pragma once

#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem {

/// f −= rate · w m v (and torque −= rate · w I ω), w = weight: a bath that slows everything, free flight too.
/// Call after all other forces. Returns the power it takes, W, to be booked.
/// Members of bodies are left out: their bodies damp themselves.
/// @param rate 1/s @throws InputError unless rate is finite and ≥ 0
double applyViscousDamping(Particles& particles, double rate);

/// Local non-viscous damping, f_k −= α |f_k| sign(v_k) for each component of force and velocity, torque and spin
/// (Cundall 1987; Potyondy & Cundall 2004, eq. 18): it brings structures to rest without regard to their frequencies,
/// and leaves steady motion alone. It depends on the axes, and falls into every force: free fall is slowed too. Call
/// after all other forces. Returns the power it takes, W, to be booked.
/// @throws InputError unless 0 ≤ α < 1
double applyLocalDamping(Particles& particles, double alpha);
/// The same for one force; its power, W.
double resist(Vec3& force, const Vec3& velocity, double alpha);

/// What both have added to a force, N (or torque, N m), that holds them, viscous damping first.
/// @param momentum  kg m/s @param velocity  that both have seen, m/s
Vec3 dampingForce(const Vec3& force, const Vec3& momentum, const Vec3& velocity, double rate, double alpha);

}  // namespace dovetail::dem
