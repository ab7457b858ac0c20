// Contact laws behind one virtual call per sweep, so that callers do not depend on the law.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/dem/laws/contact_work.hpp"
#include "dovetail/dem/laws/listed_laws.hpp"

namespace dovetail::dem {

class PairList;
struct EndedPairs;
struct ContactDemand;
struct ContactSample;
struct Particles;
struct PrimitiveWall;
struct TriangulatedWall;
struct WallContacts;

/// A law for each pair of materials, prepared; never changes. One call sweeps all contacts of a kind; nothing in the
/// sweep is virtual.
class ContactLaws {
public:
  virtual ~ContactLaws() = default;

  /// Adds the pair forces to particles.f, equal and opposite (and torques, if the law exerts them and the particles
  /// spin). Bitwise the same for any number of threads. Call once per step if the law has memory.
  /// @param dt step over which memories advance, s
  /// @throws InputError if the law has springs that remember and dt is not finite and > 0, or naming a particle whose
  /// material has no
  ///         law
  virtual ContactWork pairs(Particles& particles, PairList& list, double dt, Booking booking) const = 0;
  /// The same for the contacts that findContacts has found; sets the wall's force and torque. Effective mass and radius
  /// are the particle's.
  virtual ContactWork wall(Particles& particles, PrimitiveWall& wall, double dt, Booking booking) const = 0;
  /// The same for the contacts that findWallContacts has found; sets their forces and couples, the reaction on the wall
  /// being up to addWallForces. The wall counts as flat: the effective radius is the particle's, and the effective mass
  /// too unless the wall has one (TriangulatedWall::mass). Where facets share a contact, each has its fraction
  /// (engagement) of the law's force at the overlap of particle and facet alone.
  ///
  /// Wall velocities enter with the weights that carry the force, so power balances: Σ force·(v_particle − v_wall)
  /// = −d(elastic energy)/dt − dissipated power. The moment of elastic forces balances to round-off; that of a dashpot
  /// does in a single contact, and where facets share a contact up to (dashpot force) × (overlap).
  virtual ContactWork wall(Particles& particles, const TriangulatedWall& wall, WallContacts& contacts, double dt,
                           Booking booking) const = 0;

  /// Adds the demand of the present contacts on the step (see contact_step.hpp): the stiffness and the dashpot that the
  /// law has at their overlap. A wall is immovable.
  /// @param leastOverlap m; if > 0, all pairs of the list count, with this overlap at least: for a scene that is yet to
  ///        collide, under laws that stiffen
  /// @throws InputError if there is no law for a pair of materials
  virtual void addDemand(ContactDemand& demand, const Particles& particles, const PairList& list,
                         double leastOverlap) const = 0;
  virtual void addDemand(ContactDemand& demand, const Particles& particles, const PrimitiveWall& wall) const = 0;
  virtual void addDemand(ContactDemand& demand, const Particles& particles, const TriangulatedWall& wall,
                         const WallContacts& contacts) const = 0;

  /// Pairs with their present forces: springs as the last sweep left them, dashpots at the velocities that particles
  /// have. Nothing is changed, and memories are used as they are. Pairs without a force are left out. In the order of
  /// the list, for any number of threads. For output, not for every step.
  /// @param list that of the last sweep, with the same particles
  /// @throws InputError if the law has memory and the list has not been through `pairs`
  virtual ContactSample sample(const Particles& particles, const PairList& list) const = 0;

  /// Energy in springs of pairs that ended with the removal of a particle, J.
  virtual double held(const EndedPairs& pairs) const = 0;

  /// Numbers that a contact remembers, without those of velocities.
  virtual int memory() const = 0;
  /// Whether contacts exert torques, so that particles should spin.
  virtual bool rotates() const = 0;
  /// Distance beyond touch up to which it acts, m: the largest of the table, ∞ if every pair of the list is bonded.
  virtual double reach() const = 0;
  /// Rows of the table: materials 0 … materials() − 1 have laws. A single law serves all materials and reports 1.
  virtual int materials() const = 0;
  /// The parts, such as "Hertz + Mindlin + rolling and twisting + DMT".
  virtual const std::string& name() const = 0;
  /// The prepared parameters, row by row of the table: equal bytes and equal names are equal laws.
  virtual void saveParameters(ByteWriter& writer) const = 0;
};

/// Whether both have the same parts and the same parameters, to the last bit.
bool sameLaws(const ContactLaws& a, const ContactLaws& b);

namespace detail {

/// Laws that the library has compiled with the flags that make their loops vectors.
template <class Law>
std::shared_ptr<const ContactLaws> compiledLaws(PreparedLaws<Law> laws, std::string name);

/// All others: own_laws.hpp defines it.
template <class Law>
struct OwnLaws;

template <class Law>
std::shared_ptr<const ContactLaws> behindOneCall(PreparedLaws<Law> laws, std::string name) {
  if (laws.table.empty() || laws.table.size() != static_cast<std::size_t>(laws.materials * laws.materials))
    throw InputError("a table of " + std::to_string(laws.table.size()) + " laws for " + std::to_string(laws.materials) +
                         " materials",
                     "contact laws", "take prepare(law) or prepare(table)");
  if constexpr (isListed<Law>)
    return compiledLaws<Law>(std::move(laws), std::move(name));
  else  // "incomplete type OwnLaws<…>": include own_laws.hpp in this file, which then compiles the law itself
    return OwnLaws<Law>::make(std::move(laws), std::move(name));
}

}  // namespace detail

/// Laws for a scene. Those of listed_laws.hpp, and those that differ from them in a part they can stand for, are
/// compiled in the library. For any other put the call in a file of its own that includes own_laws.hpp; there
/// -O3 -fno-math-errno -fno-trapping-math lets its loops vectorise.
/// @throws InputError as validate does, naming the materials
template <class Law>
std::shared_ptr<const ContactLaws> makeContactLaws(const LawTable<Law>& laws) {
  for (int a = 0; a < laws.materials(); ++a)
    for (int b = a; b < laws.materials(); ++b) detail::validateEntry(laws.at(a, b), a, b);
  PreparedLaws<ListedFor<Law>> prepared{laws.materials(), {}};
  for (const Law& law : laws.laws()) prepared.table.push_back(listedFor(law).prepare());
  return detail::behindOneCall(std::move(prepared), lawName<Law>());
}
template <class Normal, class Tangential, class Rolling, class Adhesion>
std::shared_ptr<const ContactLaws> makeContactLaws(const ContactLaw<Normal, Tangential, Rolling, Adhesion>& law) {
  validate(law);
  using Law = ContactLaw<Normal, Tangential, Rolling, Adhesion>;
  return detail::behindOneCall(PreparedLaws<ListedFor<Law>>{1, {listedFor(law).prepare()}}, lawName<Law>());
}
template <class Law>
std::shared_ptr<const ContactLaws> makeContactLaws(const PreparedLaws<Law>& laws) {
  return detail::behindOneCall(laws, lawName<Law>());
}

}  // namespace dovetail::dem
