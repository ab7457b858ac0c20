// Elastic beams between the centres of particles, which break.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "dovetail/dem/laws/contact_work.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::dem {

struct ContactDemand;

/// What bonds are made of. A bond is a cylinder of radius `radiusRatio` times the smaller particle's, as long as the
/// centres are apart when it is made, and then free of stress.
struct BondMaterial {
  double youngsModulus = 0.0;       ///< E, Pa
  double poissonRatio = 0.0;        ///< ν
  double radiusRatio = 1.0;         ///< > 0
  double shearCorrection = 0.9;     ///< κ of Timoshenko's beam; 0 = Euler–Bernoulli, stiff in shear
  double tensileStrength = 0.0;     ///< Pa; may be infinite
  double shearStrength = 0.0;       ///< Pa; may be infinite
  double momentContribution = 1.0;  ///< β in 0 … 1, fraction of the moments in the stresses
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

/// The bonds' ends by particle, so that every particle gathers its own forces. Follows from the bonds.
struct BondEnds {
  std::vector<int> particle;             ///< that has bonds, ascending
  std::vector<std::size_t> first;        ///< its ends are end[first[k]] … end[first[k + 1] − 1]
  std::vector<std::uint32_t> end;        ///< 2 × bond + (0: i, 1: j), ascending; `gone` behind them where bonds broke
  std::size_t bonds = 0, particles = 0;  ///< how many there were when this was made
  static constexpr std::uint32_t gone = 0xffffffffu;
};

/// Bonds of some particles. They need particles that spin. Their separations are those of the nearest images in
/// `space`, which is the pair list's.
struct Bonds {
  std::vector<Bond> bonds;

  struct Forces {
    Vec3 force, torqueI, torqueJ;
  };
  std::vector<Forces> forces;    ///< of the last step: force on j (the opposite on i), torques on both, N, N m
  std::vector<double> utilised;  ///< of the last step: largest stress over strength
  std::vector<double> energy;    ///< of the last step: J stored in each
  /// Pairs, the lower number first, whose last bond broke in the last exchange.
  std::vector<std::array<int, 2>> broken;
  double powerOfBroken = 0.0;    ///< W, that the forces of bonds which broke in the last exchange would have had
  std::int64_t brokenSoFar = 0;  ///< bonds, in all exchanges
  BondEnds ends;

  std::size_t size() const { return bonds.size(); }
};

/// A bond between two particles as they lie; its number, until bonds break or get new numbers of particles.
/// @throws InputError if i = j, if one does not exist, if the centres coincide, or if the material is not valid
int addBond(Bonds& bonds, const Particles& particles, const geometry::Periodicity& space, int i, int j,
            const BondMaterial& material);

/// Bonds all pairs whose gap is at most `gap`, m, and that have no bond yet; returns how many.
/// @param list  for its pairs, if it holds all that are so close, and for its periods
/// @param wanted  whether particles i and j are to be bonded; empty: all are
int bondTouching(Bonds& bonds, const Particles& particles, const PairList& list, double gap,
                 const BondMaterial& material, const std::function<bool(int i, int j)>& wanted = {});

/// Turns the bonds' ends with the particles' spins over dt, adds forces and torques, and removes bonds whose stress
/// exceeds their strength (the last bond takes the number of one that breaks). Call once per step, after drift; dt = 0
/// to evaluate without turning (then nothing breaks).
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
ContactWork exchangeBonds(Particles& particles, Bonds& bonds, const geometry::Periodicity& space, double dt);

/// Power that the dashpots of the bonds, as they stand after an exchange, take from particles that move with v and
/// omega, W. The dashpots' forces are those of that exchange, made of the particles' own velocities: with the means of
/// the velocities before and after the kick that these forces make it is what they lose in it.
/// @param v, omega m/s, rad/s, per particle
double dashpotPower(const Particles& particles, const Bonds& bonds, const geometry::Periodicity& space,
                    std::span<const Vec3> v, std::span<const Vec3> omega);

/// Gives the bonds the new numbers of their particles (see sortParticles), and sorts them by these; bonds of removed
/// particles (< 0) are removed. Returns their energy, J, for the caller to book.
/// @param newNumber one per particle with which the bonds were last used
double renumber(Bonds& bonds, std::span<const int> newNumber);

/// Sets PairList::factors to 0 for bonded pairs, so that only the bond acts between them. Again for every new list; any
/// number of times. A pair whose bond breaks (Bonds::broken) stays muted until its factor is set again,
/// as BondTerm does. (A contact that becomes active between overlapping particles adds energy, which has to be booked.)
void muteBonded(const Bonds& bonds, PairList& list);

/// Adds the bonds to the demand on the particles, as if each were a contact: the largest of its axial, twisting and
/// bending shares over mass and inertia. Exact for two equal particles; on the safe side by up to √3 where bonds go all
/// ways.
void addDemand(ContactDemand& demand, const Particles& particles, const Bonds& bonds);

/// Bonds one by one as the last exchange left them, for fields, averages and files; one entry per bond.
struct BondSample {
  std::vector<int> first, second;               ///< particles
  std::vector<Vec3> from, to;                   ///< their centres, the second one's image next to the first, m
  std::vector<Vec3> force;                      ///< on the first at its centre, N; the second gets the opposite
  std::vector<Vec3> torqueFirst, torqueSecond;  ///< about the centres, N m
  std::vector<double> tension;                  ///< N, > 0 where the bond pulls
  std::vector<double> utilised;                 ///< largest stress over strength
  std::vector<double> energy;                   ///< J
  std::size_t size() const { return first.size(); }
};

/// @throws InputError unless exchangeBonds has been called since bonds were added or particles got new numbers
BondSample sampleBonds(const Particles& particles, const Bonds& bonds, const geometry::Periodicity& space);

/// Whether the bonds fit the particles.
/// @throws InputError if the particles do not spin, or naming the bond that refers to a particle that is not there or
/// to
///         one twice, or whose length, stiffness or strength is not valid
void check(const Bonds& bonds, const Particles& particles);

/// @throws InputError naming the field
void validate(const BondMaterial& material);

}  // namespace dovetail::dem
