// Terms that couple the particles of a run to one of its solids.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/ledger.hpp"
#include "dovetail/coupling/solid_side.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::coupling {

/// A term of the particles' model that also acts on the nodes of a solid. The coupling is adjoint: the operator that
/// maps nodal motion to the interface, transposed, maps forces back. It has the calls of any other term (dem::Term:
/// check, updated, renumber, leaving, addDemand, save, load …). addForces adds to particles.f, and the reaction to
/// side().load; the nodes have already moved then. Constraint forces are computed last, from all others
/// (dem::Term::Order::constraints).
///
/// The connector of a copy of the particles' model has a side of its own: it takes the position of the solid and does
/// not load it.
class Connector : public dem::Term {
public:
  explicit Connector(SolidSide& side) : side_(&side) {}
  Connector(const Connector& other)
      : dem::Term(other), own_(std::make_unique<SolidSide>(*other.side_)), side_(own_.get()) {}
  Connector(Connector&&) = default;
  Connector& operator=(const Connector&) = delete;
  Connector& operator=(Connector&&) = default;

  SolidSide& side() const { return *side_; }

  /// Whether its forces are computed from all others: then it has the order `constraints`.
  bool constrains() const { return order() == Order::constraints; }
  /// For constraints and macro steps of several steps: adds to `onParticles` and `load`, N, the force, constant in both
  /// half macro steps around the present instant, that balances forces which act at this instant only. `ownForce` is
  /// that of the solid, N; empty if the solid is stepped implicitly, and velocities are to be made to comply. `half` is
  /// half a macro step, s.
  virtual void constrainMacroStep(const dem::Model&, std::span<const Vec3> /*ownForce*/, double /*half*/,
                                  std::span<Vec3> /*onParticles*/, NodalLoad& /*load*/) const {}

  /// For volume couplings: 1 − w of the solid per node, and marks (not 0) of the particles that are tied to it.
  /// Contacts on the surface of the solid act with this weight, and tied particles have none. Empty for others.
  virtual std::vector<double> solidWeight() const { return {}; }
  virtual void markTied(std::span<std::uint8_t> /*tied*/) const {}

  /// Whether it acts on nodes that the solid lays out anew between macro steps (fem::Term::ownsNodes): others keep the
  /// numbers of nodes.
  virtual bool followsNodes() const { return false; }
  /// Ids of the particles that stand for parts of the solid.
  virtual std::span<const std::int64_t> placed() const { return {}; }
  /// Puts them where the nodes have brought them.
  /// @param v  of the nodes, as particles see them, m/s @return how far one has moved at most, m
  virtual double placeParticles(dem::Model&, std::span<const Vec3> /*v*/) { return 0.0; }
  /// Adds what the solid asks of these particles beside contacts. @param rate  ω² of its own forces, 1/s²; 0 if it is
  /// stepped implicitly
  virtual void addOwnForces(dem::ContactDemand&, double /*rate*/) const {}

  /// Stored energy that the particles' model does not account for, J.
  virtual double stored() const { return 0.0; }
  /// Energy lost so far, J; negative if energy was created. Without what the particles' model accounts for.
  virtual double lost() const { return 0.0; }

private:
  std::unique_ptr<SolidSide> own_;
  SolidSide* side_;
};

}  // namespace dovetail::coupling
