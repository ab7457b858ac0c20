// Bonds, damping, external forces and drives of a model.
#pragma once

#include <functional>

#include "dovetail/dem/bonds/bonds.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem {

/// Bonds between the particles of the model; these spin then.
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

/// Particles with a prescribed path and spin; those of zero displacement are held. Where particles spin, driven ones
/// keep the spin that is prescribed, zero unless another one is given. The drive gives impulse and work; a jump of the
/// velocity, as at its start, does its work with the mean velocity.
class DriveTerm final : public Term {
public:
  using Path = std::function<Vec3(double time)>;
  /// @param ids of the particles (Particles::id)
  /// @param displacement of time (s) since the start of the model, m; smooth enough for `velocity`, its derivative, m/s
  /// @param spin  of time, rad/s; empty: none
  DriveTerm(std::vector<std::int64_t> ids, Path displacement, Path velocity, Path spin = {})
      : ids_(std::move(ids)),
        displacement_(std::move(displacement)),
        velocity_(std::move(velocity)),
        spin_(std::move(spin)) {}

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
  /// Numbers of its particles as they are now.
  const std::vector<int>& numbers(const Particles& particles);
  /// Velocity, m/s, and spin, rad/s, that it prescribes at a time.
  Momenta motionAt(double time) const;

  bool stands = false;  ///< holds the particles where they are, whatever their path, until it is set back
  Vec3 supportImpulse;  ///< given to the particles so far, kg m/s
  Vec3 supportMoment;   ///< its moment about the origin, kg m²/s
  Momenta support;  ///< force on the particles at the end of the last step, N, and its moment about their centre, N m

private:
  Momenta motionIn(const Step& step, Half half) const;
  std::vector<std::int64_t> ids_;
  Path displacement_, velocity_, spin_;
  std::vector<int> particle_;
  std::int64_t located_ = -1;
};

/// The bonds of the model, made when first asked for.
Bonds& bonds(Model& m);
/// The damping of the model, made when first asked for.
DampingTerm& damping(Model& m);

}  // namespace dovetail::dem
