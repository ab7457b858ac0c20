// Clumps: particles that are slaved to a rigid body.
//
// Members are ordinary particles to the search for contacts and to every contact law. Their motion is the body's:
//
//     kick(particles, dt/2)    kickBodies(bodies, dt/2)
//     drift(particles, dt)     driftBodies(bodies, dt)      placeMembers
//     clearForces(particles)   clearForces(bodies)          contacts …      gatherForces
//     kick(particles, dt/2)    kickBodies(bodies, dt/2)     placeMembers
//
// What kick and drift do to members is overwritten by placeMembers. A member's mass is that of its body, which is what
// a dashpot in its contact should be made for; sums over the particles therefore count clumps wrongly, and are put
// right by kineticEnergy(particles, bodies) and gatherForces' parameter for gravity. Lever arms, by which the effective
// mass of a contact is less than the body's mass, enter the critical step by addDemand.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dovetail/dem/bodies/bodies.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem {

struct ContactDemand;

/// A kind of clump.
struct ClumpShape {
  MassProperties properties;
  std::vector<Vec3> offset;    ///< centres from the centre of mass, in the frame of the description, m
  std::vector<double> radius;  ///< m
};

enum class Overlap {
  once,        ///< matter counts once where spheres overlap (unionOfSpheres)
  everySphere  ///< as often as there are spheres (sumOfSpheres)
};

/// @param centre, radius one of each per sphere, m
/// @throws InputError as unionOfSpheres
ClumpShape makeClumpShape(std::span<const Vec3> centre, std::span<const double> radius, Density density,
                          Overlap overlap = Overlap::once);

/// Which particles belong to which bodies; the three arrays have one entry per member.
struct Clumps {
  std::vector<int> particle, body;  ///< by body, ascending
  std::vector<Vec3> offset;         ///< from the body's centre, in its principal frame, m
  std::size_t size() const { return particle.size(); }
};

/// Appends a body and its members, one particle per sphere, with the centre of mass at x, turned by `turn` from how the
/// shape was described. Returns the body's number.
/// @throws InputError as addBody and addParticle
int addClump(Particles& particles, Bodies& bodies, Clumps& clumps, const ClumpShape& shape, const Vec3& x,
             const Quaternion& turn = {}, const Vec3& v = {}, const Vec3& omega = {});

/// Writes x, v (and omega, if particles spin) of all members; along periodic axes at the image of its place that is
/// nearest to where a member was. Returns the largest distance by which a member was moved, m (infinite if a place is
/// not finite): what is to be added to the displacement that kickAndDrift returns, where updatePairs is given a bound.
double placeMembers(const Bodies& bodies, const Clumps& clumps, const geometry::Periodicity& space,
                    Particles& particles);

/// Spins of all members, if particles spin: those of their bodies.
void spinMembers(const Bodies& bodies, const Clumps& clumps, Particles& particles);

/// f += Σ fᵢ, torque += Σ armᵢ × fᵢ + torqueᵢ over each body's members, arms as placeMembers has them; then their
/// forces and torques are zero.
/// @param gravity what applyGravity(particles, gravity) has given to the members, m/s²; every body gets
///   its own weight instead, at its centre of mass
void gatherForces(Particles& particles, const Clumps& clumps, Bodies& bodies, const Vec3& gravity = {});

/// Renumbers the members of clumps (< 0: removed); bodies of removed clumps are removed, and bodies behind them move
/// up.
/// @throws InputError naming the body of which some members are removed and others not; nothing is changed then
void renumber(Bodies& bodies, Clumps& clumps, std::span<const int> newNumber);

/// @throws InputError if arrays differ in length, bodies are not in ascending order, or naming the body whose member is
/// no particle, a member of two bodies, or of another mass than its body
void check(const Particles& particles, const Bodies& bodies, const Clumps& clumps);

/// Pairs of a body's own members are muted, so that it would pass through its own image.
/// @throws InputError if a clump is longer than a period
void requireShorter(const ClumpShape& shape, const geometry::Periodicity& space, const std::string& where);
void requireShorter(const Particles& particles, const Clumps& clumps, const geometry::Periodicity& space);

/// Body of every particle, −1 of those that are no members.
std::vector<int> bodyOfParticles(std::size_t particles, const Clumps& clumps);

/// Factor 0 (PairList::factors) on the pairs within one body, so that members that overlap make no force and store no
/// energy. Again for every new list; any number of times.
void muteMemberPairs(const Clumps& clumps, PairList& list);

/// Marks all members as sharing their body's mass and inertia, so that criticalStep(demand, particles) sums the demand
/// of all contacts of a body. A force at the distance r from the centre of mass has the effective mass 1/(1/m + λ), λ
/// the largest of (r × n)·I⁻¹(r × n) over directions n (r × n)·(r × n) at most; r ends at the member's centre for
/// normal forces and on its surface for tangential ones. On the safe side by up to about 1.4 where the directions or
/// places of the worst differ.
void addDemand(ContactDemand& demand, const Particles& particles, const Bodies& bodies, const Clumps& clumps);

/// ½ Σ m v² (+ ½ Σ I ω²) of the particles that are no members, J.
double freeKineticEnergy(const Particles& particles);
/// Of bodies and free particles together, J; each counted once.
inline double kineticEnergy(const Particles& particles, const Bodies& bodies) {
  return freeKineticEnergy(particles) + kineticEnergy(bodies);
}

}  // namespace dovetail::dem
