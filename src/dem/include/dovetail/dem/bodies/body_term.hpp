// Rigid bodies of a model: clumps of its particles, and triangulated walls that move freely (addFreeWall in walls.hpp).
//
//     dem::BodyTerm& rigid = dem::bodies(model);
//     dem::addClump(model, shape, x);
#pragma once

#include "dovetail/dem/bodies/clumps.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem {

/// Bodies and their members. Members are ordinary particles for lists, laws and walls; their body moves them, and every
/// sum counts a body once.
class BodyTerm final : public Term {
public:
  Bodies bodies;
  Clumps clumps;

  std::string name() const override { return "bodies"; }
  std::unique_ptr<Term> clone() const override { return std::make_unique<BodyTerm>(*this); }
  Order order() const override { return Order::bodies; }
  void check(const Model& m) const override;
  void own(Particles& particles) const override;
  double move(Model& m, const Step& step) override;
  void neighbourListUpdated(Model& m) override;
  void leaving(Model& m, std::vector<char>& leaves) override;
  double renumber(std::span<const int> newNumber, const Particles& before) override;
  void addForces(Model& m, const Step& step) override;
  void book(Model& m, const Step& step) override;
  void meanMotion(const Model& m, const Step& step, std::span<Vec3> v, std::span<Vec3> omega) const override;
  void close(Model& m, double dt) override;
  void addDemand(const Model& m, ContactDemand& demand) const override;
  void addEnergies(const Model& m, Energies& e) const override;
  void addMomenta(const Model& m, Momenta& sums) const override;
  void addOutside(const Model& m, Momenta& force, Momenta& impulse) const override;
  void save(ByteWriter& writer) const override;
  void load(ByteReader& reader) override;

  /// To be called when bodies from number `first` on have been appended within a step: they are booked as entered, with
  /// their velocities at this moment.
  void admit(Model& m, int first);
  /// All forces of the step are known and booked: its last half kick, which is not for newcomers, is taken from what
  /// they have.
  void welcome(const Step& step);
  /// Between steps: bodies added since are booked as entered, unless all are new. Members spin as their bodies.
  void takeIn(Model& m, bool first);

private:
  void damp(Model& m);
  void moveDriven(Model& m, const Step& step, Half half);
  struct Mean;
  Mean meanOf(const Model& m, const Step& step) const;
  int known_ = 0;   // those behind have just come, and are yet to be booked or in the midst of a step
  Momenta beside_;  // half kicks that newcomers and leavers were not given, kg m/s
};

/// The bodies of the model, made when first asked for.
BodyTerm& bodies(Model& m);
/// Appends a clump as addClump does. Returns the body's number.
int addClump(Model& m, const ClumpShape& shape, const Vec3& x, const Quaternion& turn = {}, const Vec3& v = {},
             const Vec3& omega = {});

}  // namespace dovetail::dem
