// A scene of particles and what acts on them, and its step.
//
//     dem::Model model;
//     model.laws = dem::makeContactLaws(law);
//     model.gravity = {0, 0, -9.81};
//     dem::addParticle(model.particles, …);
//     dem::addWall(model, dem::makePlane({}, {0, 0, 1}));
//     dem::run(model, dt, steps);
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/model/energies.hpp"
#include "dovetail/dem/model/term.hpp"
#include "dovetail/dem/pairs/pairs.hpp"
#include "dovetail/dem/particles/particles.hpp"

namespace dovetail::dem {

/// What happens to particles that leave the domain.
enum class EscapePolicy {
  refuse,  ///< NumericalError with the particle, where it is and how fast
  remove,  ///< it leaves the scene; counted, its mass, momentum and energy booked
};

/// Region that particles may not leave. Checked at every search for pairs; without effect along a periodic axis.
struct Domain {
  geometry::Box box;  ///< m; centres beyond it have escaped
  EscapePolicy policy = EscapePolicy::refuse;
};

/// Whether particles spin. They must where laws exert torques, or nothing rolls.
enum class Rotation {
  automatic,  ///< switched on before the first step if the laws exert torques or a term asks for it
  off         ///< particles only slide
};

/// A check of a run that found its step beyond the limit.
struct PassedLimit {
  double dt;  ///< s
  StepLimit limit;
  double time;  ///< s, when it was found
};

/// Particles, and what acts on them. All parts but particles and laws may be left empty.
struct Model {
  Particles particles;
  PairList pairs;                           ///< skin (and periodicity) are the caller's to set
  std::shared_ptr<const ContactLaws> laws;  ///< of makeContactLaws
  Vec3 gravity;                             ///< m/s²
  Terms terms;                              ///< see addWall, addBonds and their like
  std::optional<Domain> domain;
  Rotation rotation = Rotation::automatic;
  Booking booking = Booking::on;
  /// Particles are sorted at every so many updates of the list, 0 = never; Particles::id names them.
  int sortEvery = 16;
  /// A first step, or another than before, is refused beyond criticalStep and impactLimit; then the run checks its
  /// state now and then, and sets `passed` once when the step is beyond the limit.
  bool refusesUnstableSteps = true;
  Profile* profile = nullptr;  ///< where the stages' times go, if wanted

  // The members below are maintained by the run.
  double time = 0.0;  ///< s
  std::int64_t steps = 0;
  double open = 0.0;  ///< s: after advance, velocities lag by half of this step; 0 after close
  Step step;          ///< the last one
  ContactWork work;   ///< of the last step
  Energies booked;    ///< lost, damping, walls, external, entered, left so far
  Energies rate;      ///< W: lost to dashpots, damping, walls, external with the forces of the last step
  Exchanged entered, left;

  static constexpr std::int64_t never = -1, outdated = -2;
  std::int64_t forcesOf = never;   ///< Particles::revision that the forces belong to; `never` before the first
  std::int64_t knownIds = 0;       ///< ids of all that have been booked are below
  std::int64_t forcesOfTerms = 0;  ///< Terms::revision of the same
  std::shared_ptr<const ContactLaws> forcesOfLaws;  ///< laws of the same
  double smallestRadius = 0.0;                      ///< m; moves beyond it are checked one by one
  double timeBase = 0.0;                            ///< s: time = timeBase + (steps − stepsBase) dt
  std::int64_t stepsBase = 0;
  double checkedStep = 0.0;             ///< s: the dt that has been compared with the critical step
  std::optional<PassedLimit> passed;    ///< the first look that found the step beyond the limit; in no checkpoint
  std::int64_t listUpdates = 0;         ///< number of searches for pairs
  std::vector<std::int64_t> newcomers;  ///< ids of particles that entered in the present step
  bool newcomersTouch = false;          ///< whether contacts of some may add energy
};

/// The parts of a step, to be called one by one:
///
/// move: [last half kick of the step before] · half kick · drift, of particles, walls and bodies. Before the first
/// step, and when particles or terms have been added or removed or laws exchanged since the last, it also closes the
/// step before, checks the model, makes the pair list and finds the forces at the start. The springs of contacts stay
/// if each part of the new laws remembers as many numbers as that of the old ones (ContactLaw::memoryKind), and start
/// anew otherwise.
/// @throws InputError as check and requireStableStep do, or if dt is not finite and > 0; NumericalError naming a
///   particle that is not finite or moved farther than its own radius in this step (it could pass through walls and
///   others unseen)
void move(Model& m, double dt);
/// Particles enter and leave, the list of pairs is updated where moves require it, particles are sorted now and then.
/// @throws NumericalError naming a particle that has escaped from the domain
void updateNeighbourList(Model& m);
/// Gravity, pairs, terms; books what they lost.
void addForces(Model& m);
/// What terms add, and the contacts that they find together (Term::findFacetContacts). Books nothing.
void addForcesOfTerms(Model& m);
/// Forces of the present state, without a step in time. To be called when something was moved between steps: only
/// losses of springs whose contacts end or slide by that are booked. Where particles, terms or laws were added, removed
/// or exchanged since forces were last found, the change of the contacts' energy is booked as entered.
void findForces(Model& m);
/// The half kick that ends a step, so that positions and velocities belong to one time. Does nothing if there is none
/// to make.
void close(Model& m);

/// One step of velocity Verlet: move · updateNeighbourList · addForces. Its `close` is left to the next move, which
/// makes both half kicks in one sweep, or to the caller.
void advance(Model& m, double dt);
/// advance n times, then close.
void run(Model& m, double dt, std::int64_t n);

/// @throws InputError saying what is wrong with the model, where, and what to write instead: arrays of unlike length,
/// values that are not finite, laws that are missing or lack a material, walls and terms that are not valid
void check(const Model& m);

/// Demand of the present pairs and terms on the step. @param leastOverlap see criticalStep
ContactDemand demandOf(const Model& m, double leastOverlap = 0.0);
/// The largest stable step with the present contacts, bonds and bodies, and what sets it (see ContactDemand). A scene
/// that is yet to collide has none: take `leastOverlap` then, the overlap to be expected, m.
ContactStep criticalStep(const Model& m, double leastOverlap = 0.0);
/// @throws InputError naming what sets the limit if dt is beyond it, or beyond that of the impacts to come
void requireStableStep(const Model& m, double dt, double leastOverlap = 0.0);
/// Whether a run checks the limit after this step: at three of the first and then at each 2048th, as a check costs
/// about as much as a step.
bool looksAtLimit(std::int64_t step);
/// After a run broke down: the same error with the limit that its step is beyond, if it is (m.passed); else returns.
void reportOfLimit(const Model& m, const NumericalError& error);
/// Sets m.passed if the step is beyond criticalStep. `advance` does so where looksAtLimit, and where it breaks down.
void lookAtLimit(Model& m);

/// Energies now, J; contact energies and losses need booking. Gravity counts from the origin.
/// @throws InputError between advance and close, when velocities lag behind positions
Energies energies(const Model& m);
/// Momentum and angular momentum now. @throws InputError between advance and close
Momenta momenta(const Model& m);
/// Weight of particles and bodies, N, and its moment about the origin, N m.
Momenta weight(const Model& m);

/// Removes particles; their mass, momentum and energy are booked as left. Pairs, bonds and walls drop them.
/// @throws InputError on a number that does not exist
void removeParticles(Model& m, std::span<const int> list);
/// To be called when particles from number `first` on have been appended within a step: their energy is booked as
/// entered, that of their contacts included, with their velocities at this moment. Particles that are appended between
/// steps count as entered when forces are next found.
void admitParticles(Model& m, std::size_t first);

}  // namespace dovetail::dem
