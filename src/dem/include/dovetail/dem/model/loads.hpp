// Bonds, damping, external forces and drives of a model.
#pragma once

#include <functional>

#include "dovetail/dem/bonds/bonds.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/dem/walls/rigid_motion.hpp"

namespace dovetail::dem {

class BodyTerm;

/// Bonds between the particles of the model; these spin then. Members of clumps turn their ends as their body turns.
class BondTerm final : public Term {
public:
  Bonds bonds;
  /// Only the bond acts between bonded particles, see muteBonded. When it breaks they touch at once; what their contact
  /// then stores is taken off the fracture energy.
  bool mutesContacts = false;

  std::string name() const override { return "bonds"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<BondTerm>(*this); }
  void check(const Model& m) const override;
  void neighbourListUpdated(Model& m) override;
  double renumber(std::span<const int> newNumber, const Particles& before) override;
  void addForces(Model& m, const Step& step) override;
  void book(Model& m, const Step& step) override;
  void addDemand(const Model& m, ContactDemand& demand) const override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;

private:
  void wake(Model& m, const Step& step);
  double lost_ = 0.0;  // power of the dashpots against the velocities that they saw, W
};

/// Viscous and local damping of all particles, see damping.hpp.
class DampingTerm final : public Term {
public:
  double viscousRate = 0.0;  ///< see applyViscousDamping, 1/s
  double local = 0.0;        ///< see applyLocalDamping

  std::string name() const override { return "damping"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<DampingTerm>(*this); }
  Order order() const override { return Order::damping; }
  void check(const Model& m) const override;
  void addForces(Model& m, const Step& step) override;
  void book(Model& m, const Step& step) override;
  void addOutside(const Model& m, Momenta& force, Momenta& impulse) const override;
  void save(ByteWriter& writer) const override { writer(viscousRate, local); }
  void load(ByteReader& reader) override { reader(viscousRate, local); }

private:
  Momenta forceOn(const Particles& particles, std::size_t i) const;
};

/// Forces of the caller's on the particles: drag, fields, another solver. Their work is booked.
class ExternalForceTerm final : public Term {
public:
  /// Adds forces on the particles, N, at the state and time (s) given.
  using Function = std::function<void(const Particles& particles, double time, std::span<Vec3> force)>;
  ExternalForceTerm(std::string name, Function function) : name_(std::move(name)), function_(std::move(function)) {}

  std::string name() const override { return name_; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<ExternalForceTerm>(*this); }
  std::string code() const override { return "a force"; }
  void check(const Model& m) const override;
  void addForces(Model& m, const Step& step) override;
  void book(Model& m, const Step& step) override;
  void addOutside(const Model& m, Momenta& force, Momenta& impulse) const override;

private:
  std::string name_;
  Function function_;
  std::vector<Vec3> force_;
};

/// Particles and clumps with a prescribed motion; those of zero displacement are held. Where particles spin, driven
/// ones keep the spin that is prescribed, zero unless another one is given. The drive gives impulse and work; a jump of
/// the velocity, as at its start, does its work with the mean velocity. In periodic space a group that turns is no
/// farther from its axis than half a period.
class DriveTerm final : public Term {
public:
  using Path = std::function<Vec3(double time)>;
  using Motion = std::function<RigidMotion(double time)>;
  /// @param ids of the particles (Particles::id), all members of a clump or none
  /// @param displacement of time (s) since the start of the model, m; smooth enough for `velocity`, its derivative, m/s
  /// @param spin  of time, rad/s; empty: none
  DriveTerm(std::vector<std::int64_t> ids, Path displacement, Path velocity, Path spin = {})
      : ids_(std::move(ids)),
        displacement_(std::move(displacement)),
        velocity_(std::move(velocity)),
        spin_(std::move(spin)) {}
  /// All together as one rigid body. @param motion of a point that it turns about, from where the particles are as the
  /// drive begins
  DriveTerm(std::vector<std::int64_t> ids, Motion motion) : ids_(std::move(ids)), rigid_(std::move(motion)) {}

  std::string name() const override { return "drive"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<DriveTerm>(*this); }
  std::string code() const override { return "a path"; }
  void check(const Model& m) const override;
  bool prescribes() const override { return true; }
  void prescribe(Model& m, const Step& step, Half half) override;
  void meanMotion(const Model& m, const Step& step, std::span<Vec3> v, std::span<Vec3> omega) const override;
  double renumber(std::span<const int> newNumber, const Particles& before) override;
  void addOutside(const Model& m, Momenta& force, Momenta& impulse) const override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;

  const std::vector<std::int64_t>& ids() const { return ids_; }
  /// Numbers of its single particles as they are now.
  const std::vector<int>& numbers(const Particles& particles) const;
  /// Numbers of the bodies of its clumps as they are now.
  const std::vector<int>& bodyNumbers(const Particles& particles, const BodyTerm& term) const;
  /// Velocity, m/s, of the point that it turns about, or of all, and spin, rad/s, that it prescribes at a time.
  Momenta motionAt(double time) const;
  /// As prescribe, of its bodies; and their turn, after they have drifted freely.
  void prescribeBodies(Model& m, BodyTerm& term, const Step& step, Half half);
  void turnBodies(const Model& m, BodyTerm& term, const Step& step) const;
  /// As meanMotion, of its bodies: one entry per body of the term each.
  void meanMotionOfBodies(const Model& m, const BodyTerm& term, const Step& step, std::span<Vec3> v,
                          std::span<Vec3> omega) const;

  bool stands = false;  ///< holds the particles where they are, whatever their path, until it is set back
  Vec3 supportImpulse;  ///< given to the particles so far, kg m/s
  Vec3 supportMoment;   ///< its moment about the origin, kg m²/s
  Momenta support;  ///< force on the particles at the end of the last step, N, and its moment about their centre, N m

private:
  struct Way;
  Way wayIn(const Model& m, const Step& step) const;
  Vec3 meanPlace(const Model& m) const;
  std::vector<std::int64_t> ids_;
  Path displacement_, velocity_, spin_;
  Motion rigid_;
  mutable std::vector<int> particle_, body_;
  mutable std::int64_t located_ = -1, bodiesLocated_ = -1;
  Vec3 centre_;  // of its particles and bodies at the end of a step, m
};

/// Marks of the bodies that drives move, one per body.
std::vector<char> drivenBodies(const Model& m, const BodyTerm& term);

/// The bonds of the model, made when first asked for.
Bonds& bonds(Model& m);
/// The damping of the model, made when first asked for.
DampingTerm& damping(Model& m);

}  // namespace dovetail::dem
