// Elastic beams between the centres of particles, which break.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "dovetail/dem/laws/contact_work.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::dem {

/// What bonds are made of. A bond is a cylinder of radius `radiusRatio` times the smaller particle's, as long as the
/// centres are apart when it is made, and then free of stress.
struct BondMaterial {
  double youngsModulus = 0.0;       ///< E, Pa
  double poissonRatio = 0.0;        ///< ν
  double radiusRatio = 1.0;         ///< > 0
  double shearCorrection = 0.9;     ///< κ of Timoshenko's beam; 0 = Euler–Bernoulli, stiff in shear
  double tensileStrength = 0.0;     ///< Pa; may be infinite
  double shearStrength = 0.0;       ///< Pa; may be infinite
  double momentContribution = 1.0;  ///< β in 0 … 1, share of the moments in the stresses
  double dampingTime = 0.0;         ///< τ ≥ 0, s: every stiffness has a dashpot τ times as large
};

/// One bond. Directions are fixed to the particles and turn with them; at rest directionI = −directionJ points from i
/// to j.
struct Bond {
  int i = 0, j = 0;
  double length = 0.0;                   ///< m, free of stress
  double normal = 0.0, shear = 0.0;      ///< stiffness against stretch and against sliding of the ends, N/m
  double bending = 0.0, twisting = 0.0;  ///< stiffness against opposite end rotations, and about the axis, N m/rad
  double radius = 0.0;                   ///< of the cylinder, m
  double tensileStrength = 0.0, shearStrength = 0.0;  ///< Pa
  double momentContribution = 1.0, dampingTime = 0.0;
  Vec3 directionI, directionJ;  ///< unit
  Vec3 acrossI, acrossJ;        ///< unit, normal to them; equal at rest
};

/// Bonds of some particles. They need particles that spin.
struct Bonds {
  std::vector<Bond> bonds;
  geometry::Periodicity periodicity;  ///< as that of the pair list
  double ended = 0.0;  ///< J stored in bonds that have left with their particles, booked by the next exchange

  struct Forces {
    Vec3 force, torqueI, torqueJ;
  };
  std::vector<Forces> forces;    ///< of the last step: force on j (the opposite on i), torques on both, N, N m
  std::vector<double> utilised;  ///< of the last step: largest stress over strength
  std::vector<double> energy;    ///< of the last step: J stored in each
  std::size_t particles = 0;     ///< how many there were when their numbers were last checked

  std::size_t size() const { return bonds.size(); }
};

/// A bond between two particles as they lie; its number.
/// @throws InputError if i = j, if one does not exist, if the centres coincide, or if the material is not valid
int addBond(Bonds& bonds, const Particles& particles, int i, int j, const BondMaterial& material);

/// Bonds all pairs of the list whose gap is at most `gap`, m; returns how many.
int bondTouching(Bonds& bonds, const Particles& particles, const PairList& list, double gap,
                 const BondMaterial& material);

/// Turns the bonds' ends with the particles' spins over dt, adds forces and torques, and removes bonds whose stress
/// exceeds their strength. Call once per step, after drift; dt = 0 to evaluate without turning (then nothing breaks).
///
/// The forces are those of a potential of lengths and directions (after Kuzkin & Asonov, Phys. Rev. E 86, 051301,
/// 2012),
///   V = ½ k_n (L − L₀)² + k_s L₀²/4 (|n_i − e|² + |n_j + e|²) + b/2 |n_i + n_j|² + k_t/4 (|m_i − m_j|² + |l_i − l_j|²)
/// with e the direction from i to j, n, m, l the ends' directions, b = k_b − k_s L₀²/4 − k_t/2. For small angles it is
/// the beam of Euler–Bernoulli or Timoshenko, exact at its ends; for any angle it is objective, and forces and moments
/// balance to round-off. Stresses are those of the parallel bond (Potyondy & Cundall, Int. J. Rock Mech. 41, 2004):
///   σ = N/A + β M r/I (r the cylinder's radius, M the larger end's bending moment), τ = Q/A + β T r/J;
/// a bond breaks where σ > tensileStrength or τ > shearStrength. What it held is booked as fracture.
/// Results do not depend on the number of threads.
/// @throws InputError if the particles do not spin, if a bond refers to a particle that is not there (see renumber), or
///         dt is not finite and ≥ 0
ContactWork exchangeBonds(Particles& particles, Bonds& bonds, double dt);

/// Gives the bonds the new numbers of their particles (see sortParticles); bonds of particles that are gone (< 0)
/// leave, and what they held is booked by the next exchange.
/// @param newNumber one per particle with which the bonds were last used
void renumber(Bonds& bonds, std::span<const int> newNumber);

/// Sets PairList::scale to 0 for bonded pairs, so that only the bond acts between them. Again for every new list, and
/// when bonds have broken. (A law that wakes up between overlapping particles brings energy from nowhere: bond
/// particles that touch and leave the law on, or mute those that overlap and do not break.)
void muteBonded(const Bonds& bonds, PairList& list);

/// Safe bound on the stable step of velocity Verlet with these bonds alone, s; infinite without any. Every particle
/// shares its mass and inertia among its bonds by what they ask for; the whole is then no faster than the fastest bond.
/// Exact for two equal particles; on the safe side by up to √3 where bonds go all ways. With contacts: 1/dt² adds up.
double criticalStep(const Particles& particles, const Bonds& bonds);

/// @throws InputError naming the field
void validate(const BondMaterial& material);

}  // namespace dovetail::dem
