// The largest stable step of velocity Verlet.
#pragma once

#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem {

/// A step and who sets it.
struct CriticalStep {
  double dt;     ///< s; infinite without particles
  int particle;  ///< −1 without particles
};

/// Whom a particle may touch: a wall, whose mass is infinite (m_eff = m), or also its like (m_eff = m/2).
enum class Partners { walls, particles };

/// 2/ω, ω² = n k/m_eff, for the lightest particle: n springs of stiffness k that all act along one line. Velocity
/// Verlet is unstable beyond it; take a tenth or less for accuracy. Dashpots evaluated at the half-step velocity lower
/// the limit: 2/ω (√(1 + ζ²) − ζ), which is included.
/// @param contacts n ≥ 1, springs acting on the particle at once
/// @throws InputError if contacts < 1 or the law is not valid
CriticalStep criticalStep(const Particles& particles, const LinearSpringDashpot& normal, Partners partners,
                          int contacts = 1);

}  // namespace dovetail::dem
