// What acts on the particles of a model beside their contacts: walls, bonds, bodies, damping, loads. A model is
// particles, a pair list, laws and a list of such terms; what is absent is not in the list.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/impulses.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

struct Model;
struct Particles;
struct ContactDemand;
struct ContactSample;
struct Energies;
struct ImpactPartner;
struct Surroundings;
struct WallAtSeam;
struct AnsweredContacts;

/// The step under way.
struct Step {
  double time = 0.0;        ///< s, at its end
  double dt = 0.0;          ///< s
  std::int64_t number = 0;  ///< counted from 1
  double closing = 0.0;     ///< s: length of the step before if its last half kick is still to be made, else 0
  double moved = 0.0;       ///< m, bound on how far any particle has moved since forces were last asked for
  bool timeless = false;    ///< forces of a state in which no time passes: memories stay and nothing is booked
};

/// Which half of a step's kick has just been made.
enum class Half { first, second };

/// One thing that acts. All functions do nothing unless overridden; those that a term leaves out cost one empty call
/// per step.
class Term {
public:
  /// Order in which terms add forces: terms that update the other side of a coupling, terms that add forces, damping,
  /// which needs all others, constraints, which are computed last from all of these, and bodies, which gather the
  /// forces on their members.
  enum class Order { partners, forces, damping, constraints, bodies };

  virtual ~Term() = default;
  /// For profiles, errors and checkpoints.
  virtual std::string name() const = 0;
  virtual std::unique_ptr<Term> clone() const = 0;
  /// User code that no file can hold, such as "a motion"; empty if there is none. A checkpoint names it.
  virtual std::string code() const { return {}; }
  virtual Order order() const { return Order::forces; }

  /// Before the first step, and again when particles were added or removed. @throws InputError saying what is wrong
  virtual void check(const Model&) const {}
  /// Marks particles that it moves (setOwner), where particles, terms or their numbers have changed.
  virtual void own(Particles&) const {}
  /// Moves what the term owns by step.dt: [kick(closing/2)] · kick(dt/2) · drift(dt), or along a given motion.
  /// @return how far it has moved any particle beyond what the particles' own sweep did, m
  virtual double move(Model&, const Step&) { return 0.0; }
  /// Whether `prescribe` is wanted; then the sweeps of a step are made one by one.
  virtual bool prescribes() const { return false; }
  /// After half a kick: sets velocities. In the first half the particles are about to drift by step.dt.
  virtual void prescribe(Model&, const Step&, Half) {}
  /// Adds obstacles of inserted particles, which must exist until the end of the step.
  virtual void surround(Surroundings&) {}
  /// Inserts and removes particles (insertParticles, removeParticles of the model).
  virtual void exchange(Model&, const Step&) {}
  /// The list of pairs is new: sets factors of pairs (PairList) to mute or weight them.
  virtual void neighbourListUpdated(Model&) {}
  /// Particles are about to be removed, one entry per particle, 0 = stays. Marks others that are removed with them, and
  /// sets those whose mass and energy it counts itself to `booked`.
  virtual void leaving(Model&, std::vector<char>& /*leaves*/) {}
  static constexpr char booked = 2;
  /// Particles get new numbers, < 0: removed. `before` still has all of them in their old order.
  /// @return J that the term's contacts with removed particles had stored
  virtual double renumber(std::span<const int> /*newNumber*/, const Particles& /*before*/) { return 0.0; }
  /// Finds contacts with facets, before any term behind the partners adds forces, and appends those that are one
  /// surface with others where they meet (joinAtSeams).
  virtual void findFacetContacts(Model&, const Step&, std::vector<WallAtSeam>&) {}
  /// They have been joined: appends what of them is answered (passMemories).
  virtual void takeFacetContacts(Model&, const Step&, std::vector<AnsweredContacts>&) {}
  /// Adds to particles.f (and torque), and to model.work what it stores and loses.
  virtual void addForces(Model&, const Step&) {}
  /// All forces are known: adds to model.rate the power of those that give or take energy (against the mean of the
  /// velocities before and after the kick that they make).
  virtual void book(Model&, const Step&) {}
  /// For particles that the term moves: sets the means of their velocities (and spins) before and after the kick that
  /// is due.
  virtual void meanMotion(const Model&, const Step&, std::span<Vec3> /*v*/, std::span<Vec3> /*omega*/) const {}
  /// kick(dt/2): the end of the step.
  virtual void close(Model&, double /*dt*/) {}
  /// Its contacts forget how they moved in the last step: see forgetVelocities(Model&).
  /// @param memory  ContactLaws::memory: what stays
  virtual void forgetVelocities(int /*memory*/) {}

  virtual void addDemand(const Model&, ContactDemand&) const {}
  /// Partners of particles in impacts (see impactLimit).
  virtual void addPartners(const Model&, std::vector<ImpactPartner>&) const {}
  /// Adds what it stores and is not in model.work, J; corrects what sums over particles count wrongly.
  virtual void addEnergies(const Model&, Energies&) const {}
  virtual void addMomenta(const Model&, Momenta&) const {}
  /// External forces on particles and bodies, with their moments about the origin. Adds to the first what the last
  /// forces hold of it, N and N m, at the places of the last evaluation; to the second what it has given beside forces
  /// so far, kg m/s and kg m²/s.
  virtual void addOutside(const Model&, Momenta& /*force*/, Momenta& /*impulse*/) const {}
  /// Appends the contacts of particles with what it stands for, as the last evaluation left them (see sampleContacts).
  virtual void addContacts(const Model&, ContactSample&) const {}

  /// State for checkpoints, and back into a term that is set up as the one that was saved.
  virtual void save(ByteWriter&) const {}
  virtual void load(ByteReader&) {}
};

/// Owns terms; a copy has copies of them.
class Terms {
public:
  Terms() = default;
  Terms(const Terms& other) : revision_(other.revision_) {
    for (const auto& term : other.terms_) terms_.push_back(term->clone());
  }
  Terms(Terms&&) noexcept = default;
  Terms& operator=(Terms other) noexcept {
    terms_.swap(other.terms_);
    revision_ = other.revision_;
    return *this;
  }

  /// Behind those of the same order. @return the term, which stays where it is as long as this list lives
  template <class T>
  T& add(T term) {
    return add(std::make_unique<T>(std::move(term)));
  }
  template <class T>
  T& add(std::unique_ptr<T> term) {
    T* const kept = term.get();
    insert(std::move(term));
    return *kept;
  }
  /// All terms of a type, in their order.
  template <class T>
  std::vector<T*> all() {
    return collect<T>(*this);
  }
  template <class T>
  std::vector<const T*> all() const {
    return collect<const T>(*this);
  }
  void remove(const Term& term);

  std::int64_t revision() const { return revision_; }  ///< raised whenever a term is added or removed
  std::size_t size() const { return terms_.size(); }
  bool empty() const { return terms_.empty(); }
  auto begin() const { return terms_.begin(); }
  auto end() const { return terms_.end(); }

private:
  void insert(std::unique_ptr<Term> term);
  template <class T, class List>
  static std::vector<T*> collect(List& list) {
    std::vector<T*> found;
    for (const auto& term : list.terms_)
      if (auto* const t = dynamic_cast<T*>(term.get())) found.push_back(t);
    return found;
  }
  std::vector<std::unique_ptr<Term>> terms_;
  std::int64_t revision_ = 0;
};

}  // namespace dovetail::dem
