// The largest stable step of velocity Verlet with the contacts as they are now, under any law; and mass scaling.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/step_limit.hpp"
#include "dovetail/dem/laws/law_table.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::dem {

class ContactLaws;

/// What acts between a particle and its partner, and may set the step.
enum class StepOwner : std::uint8_t { contact, bond, tie };

/// Demand of contacts and bonds on each particle, and on other masses such as nodes of solids. Pairs, walls, bonds,
/// clumps and connectors add to it (addDemand), in any order; then criticalStep reads it.
struct ContactDemand {
  /// How fast a mass goes with a contact: by so much of its own shift.
  struct Fraction {
    int mass;
    double fraction;
  };
  struct Range {
    std::size_t first = 0, end = 0;  ///< in `fractions`
  };
  struct Link {
    int particle, partner;  ///< partner −1: none, see `side`
    StepOwner owner;
    double stiffness = 0.0;  ///< along its normal, N/m
    /// What the other side feels of it by being shifted, and by being turned with the particle's radius as lever, N/m
    /// and N s/m.
    double shifting = 0.0, shiftingDamping = 0.0, turning = 0.0, turningDamping = 0.0;
    int contact = -1;  ///< with a triangulated wall: its number among WallContacts
    int surface = -1;  ///< number among `surfaces`, for messages
    int side = -1;     ///< number among `sides`: the masses on its other side; −1: immovable
    Range shifted{}, turned{};
  };
  /// Masses that move together in time: the nodes of a solid, a servo wall, a body. All connectors of one solid add to
  /// the same masses.
  struct Side {
    const void* of;
    std::size_t first, end;     ///< of `masses`
    bool inMacroSteps = false;  ///< kicked in every step, but moved once a macro step (implicit solids)
    double ownRate = 0.0;       ///< ω² of forces of its own, which act at the ends of macro steps, 1/s²
  };
  struct Mass {
    double inverse = 0.0;                   ///< 1/kg; 0: held, or carried by others
    Range carriedBy{};                      ///< by these at these rates
    double stiffness = 0.0, damping = 0.0;  ///< what is asked of it, then over the mass
  };
  std::vector<double> stiffness;      ///< N/m, per particle: sum over its contacts and bonds
  std::vector<double> damping;        ///< N s/m, the same of the dashpots
  std::vector<double> byTies;         ///< N/m, what of it ties to solids ask; or empty
  std::vector<double> atMacroSteps;   ///< N/m, of forces at the ends of macro steps only; or empty
  std::vector<Link> links;            ///< contacts and bonds
  std::vector<std::string> surfaces;  ///< names of what links without a partner are with
  double twoBody = std::numeric_limits<double>::infinity();  ///< see ContactStep

  std::vector<int> body;      ///< per particle: the body it is a member of, −1 = none; empty: there are no clumps
  std::vector<double> lever;  ///< per particle: a member's mass over the effective mass that its contacts meet, ≥ 1

  int macroStep = 1;  ///< K: steps per macro step
  std::vector<Side> sides;
  std::vector<Mass> masses;
  std::vector<Fraction> fractions;

  /// Number of the side of `of`; made with so many masses if it is not there yet.
  int sideOf(const void* of, std::span<const double> inverseMass);
  /// Links from number `first` on stand on one mass of a side of its own, 1/kg.
  void standOn(std::size_t first, const void* of, double inverseMass);
  Range add(std::span<const Fraction> some);
};

/// The owner is "the bond of particle 3 with particle 4", particles by their ids.
struct ContactStep : StepLimit {
  int particle = -1, partner = -1;      ///< between which it is set; partner −1: a wall
  StepOwner kind = StepOwner::contact;  ///< of the owner
  bool byOwnForces = false;             ///< set mostly by its side's own forces
  /// s; the limit 2/ω (√(1 + 4ζ²) − 2ζ) of the fastest contact if it were alone and acted along its normal only.
  /// For information: with several contacts per particle it is not safe.
  double twoBody = std::numeric_limits<double>::infinity();
};

namespace detail {

/// Largest dt with a dt² + 2 b dt ≤ 4; a in 1/s², b in 1/s.
inline double verletLimit(double a, double b) { return 4.0 / (b + std::sqrt(b * b + 4.0 * a)); }

/// What a contact asks of the mass of a round particle, N/m: along its normal, or across it while the particle turns.
/// @param roundness  moment of inertia over mass and squared radius; infinite: it does not turn
inline double strongest(double normal, double tangential, double rolling, double radius, double roundness) {
  const double perInertia = 1.0 / roundness;
  return std::max(normal, (1.0 + perInertia) * tangential + perInertia * rolling / (radius * radius));
}

/// What acts in every step, and what acts or moves once a macro step: ω², 1/s², and 2ζω, 1/s.
struct LinkRates {
  double stiff = 0.0, damped = 0.0, macroStiff = 0.0, macroDamped = 0.0;
};
/// Largest stable dt of macro steps of K steps.
double macroLimit(const LinkRates& rates, int K);

/// The law of a pair of materials.
/// @throws InputError if the table has no such pair
template <class Law>
const typename Law::Prepared& lawOf(const PreparedLaws<Law>& laws, int a, int b) {
  if (laws.materials == 1) return laws.table[0];
  const int larger = std::max(a, b);
  if (larger >= laws.materials)
    throw InputError("there is no law for material " + std::to_string(larger), "contact laws",
                     "make the table as large as Particles::material and the walls' materials require");
  return laws.table[static_cast<std::size_t>(a * laws.materials + b)];
}

/// Adds one contact; partner −1 for a wall.
void addContact(ContactDemand& demand, const Particles& particles, int particle, int partner,
                const ContactSlopes& slopes, double scale, double effectiveMass);

/// ContactLaws::addDemand, with the law known: the pairs that touch.
template <class Law>
void addPairDemand(ContactDemand& demand, const Particles& particles, const PairList& list,
                   const PreparedLaws<Law>& laws, double leastOverlap) {
  constexpr auto numbers = static_cast<std::size_t>(Law::memory);
  const bool remembers = list.memory().size() == numbers * list.size();
  const auto material = [&](std::size_t i) { return particles.material.empty() ? 0 : int{particles.material[i]}; };
  for (std::size_t p = 0; p < list.size(); ++p) {
    const auto i = static_cast<std::size_t>(list.pairs()[p][0]), j = static_cast<std::size_t>(list.pairs()[p][1]);
    const auto& law = lawOf(laws, material(i), material(j));
    const double ri = particles.radius[i], rj = particles.radius[j];
    const double mi = particles.weightOf(i) * particles.mass[i], mj = particles.weightOf(j) * particles.mass[j];
    const double overlap = ri + rj - norm(particles.x[i] - particles.x[j] + list.shift(p));
    if (!(overlap > -law.normal.reach()) && !(leastOverlap > 0.0)) continue;
    const double scale = list.factor(p);
    if (!(scale > 0.0)) continue;
    Contact contact;
    contact.overlap = std::max(overlap, leastOverlap);
    contact.effectiveMass = mi * mj / (mi + mj) / scale;
    contact.rootMass = std::sqrt(contact.effectiveMass);
    contact.effectiveRadius = ri * rj / (ri + rj);
    contact.normal = {1.0, 0.0, 0.0};
    contact.dt = 1.0;
    double memory[numbers + 1] = {};
    for (std::size_t c = 0; remembers && c < numbers; ++c) memory[c] = list.memory()[c * list.size() + p];
    addContact(demand, particles, list.pairs()[p][0], list.pairs()[p][1], law.slopes(contact, memory), scale,
               mi * mj / (mi + mj));
  }
}

/// The same for contacts with a wall.
/// @param contacts WallContacts after findWallContacts, or PrimitiveContacts after findContacts
/// @param wallMass kg, as dashpots see it (TriangulatedWall::mass)
template <class Law, class Contacts>
void addWallDemand(ContactDemand& demand, const Particles& particles, const Contacts& contacts,
                   const PreparedLaws<Law>& laws, int wallMaterial = 0,
                   double wallMass = std::numeric_limits<double>::infinity()) {
  for (std::size_t c = 0; c < contacts.particle.size(); ++c) {
    const auto i = static_cast<std::size_t>(contacts.particle[c]);
    const int material = particles.material.empty() ? 0 : int{particles.material[i]};
    const auto& law = lawOf(laws, material, wallMaterial);
    Contact contact;
    contact.overlap = fractionOf(contacts, c).overlap;
    if (!(contact.overlap > 0.0)) continue;
    const double mass = particles.mass[i];
    contact.effectiveMass = std::isfinite(wallMass) ? mass * wallMass / (mass + wallMass) : mass;
    contact.rootMass = std::sqrt(contact.effectiveMass);
    contact.effectiveRadius = particles.radius[i];
    contact.normal = {0.0, 0.0, 1.0};
    contact.dt = 1.0;
    double memory[static_cast<std::size_t>(Law::memory) + 1] = {};
    const double weight = particles.weightOf(i);
    addContact(demand, particles, contacts.particle[c], -1, law.slopes(contact, memory), weight,
               weight * contact.effectiveMass);
    demand.links.back().contact = static_cast<int>(c);
  }
}

}  // namespace detail

/// A safe step: every particle shares its mass (and inertia) among its contacts and bonds in proportion to their
/// demand, so that one (i, j) alone has ω² = K_i/m_i + K_j/m_j and 2ζω = C_i/m_i + C_j/m_j, K and C being the sums of
/// stiffness and damping over the contacts of a particle; the whole is no faster than its fastest part. Exact for one
/// contact along its normal, and on the safe side with a dashpot. Masses that contacts stand on share likewise. In kick
/// · drift · forces · kick dashpots act on the velocity of the half step, or on that of their own instant, where they
/// count twice (see ContactLaw's slopes). A contact's stiffness is the larger of its normal one and, where particles
/// spin, 7/2 of the tangential one with the rolling one over 2/5 R². Members of a clump share their body's mass and
/// inertia. Take 0.2 of it or less for accuracy.
///
/// In macro steps of K steps, with a the rate of what acts and moves in every step and g that of what acts, or moves,
/// once a macro step (own forces of explicit solids; nodes of implicit ones), K φ < π and
///   (K dt)² g / 4 ≤ (1 − dt² a / 4) K tan(φ/2) / tan(K φ/2),   sin(φ/2) = dt √a / 2,
/// the first resonance of impulses with what moves in between (Biesiadecki & Skeel, J. Comput. Phys. 109, 1993, for
/// exact motion in between); with K = 1 a and g add up. No implicit scheme lifts it: a connector kicks nodes that are
/// held fixed.
ContactStep criticalStep(const ContactDemand& demand, const Particles& particles);

/// For pairs alone. @param leastOverlap see ContactLaws::addDemand
ContactStep criticalStep(const Particles& particles, const PairList& list, const ContactLaws& laws,
                         double leastOverlap = 0.0);

/// What scaleMasses did.
struct MassScaling {
  std::size_t count = 0;       ///< particles made heavier
  double largestFactor = 1.0;  ///< largest new mass over old mass
  double addedMass = 0.0;      ///< kg
  double massBefore = 0.0;     ///< kg, of all
};

/// Makes particles heavier (with their inertia), none lighter, until dt is stable with these contacts. For quasi-static
/// scenes only: momentum, weight and every wave change with the mass, so check the results. Nothing in this library
/// scales masses unless this is called. Dashpots that depend on the mass grow with it: with damping, make the demand
/// anew and repeat until count = 0.
/// @param dt wanted, s
/// @throws InputError unless dt is finite and > 0, or if members of clumps have contacts
MassScaling scaleMasses(Particles& particles, const ContactDemand& demand, double dt);

}  // namespace dovetail::dem
