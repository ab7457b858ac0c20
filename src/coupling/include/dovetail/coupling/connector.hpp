// What stands between the particles of a run and one of its solids.
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

/// A term of the particles' model that also acts on the nodes of a solid: what it does to one side it does to the
/// other, transposed. It is asked and told like any other term (dem::Term: check, updated, renumber, leaving,
/// addDemand, save, load …). In addForces it adds to particles.f, and to side().load the reaction; the nodes have then
/// moved already. Constraints, which answer all other forces, have the order dem::Term::Order::constraints.
///
/// The connector of a copy of the particles' model meets the solid where it is and loads nobody: its side is its own.
class Connector : public dem::Term {
public:
  explicit Connector(SolidSide& side) : side_(&side) {}
  Connector(const Connector& other)
      : dem::Term(other), own_(std::make_unique<SolidSide>(*other.side_)), side_(own_.get()) {}
  Connector(Connector&&) = default;
  Connector& operator=(const Connector&) = delete;
  Connector& operator=(Connector&&) = default;

  SolidSide& side() const { return *side_; }

  /// Whether it answers other forces: then it has the order `constraints`.
  bool constrains() const { return order() == Order::constraints; }
  /// Of constraints, in macro steps of several steps: the force, constant in both half macro steps around the present
  /// instant, that answers forces which act there only: adds to `onParticles` and `load`, N. `ownForce` is that of the
  /// solid, N; empty if the solid is stepped implicitly, and velocities are to be made to comply. `half` is half a
  /// macro step, s.
  virtual void constrainMacroStep(const dem::Model&, std::span<const Vec3> /*ownForce*/, double /*half*/,
                                  std::span<Vec3> /*onParticles*/, NodalLoad& /*load*/) const {}

  /// Of those that share a volume with their solid: 1 − w of the solid per node, and marks of the particles that are
  /// tied to it (not 0): its surface acts with that fraction, and does not meet these. Nothing of others.
  virtual std::vector<double> solidWeight() const { return {}; }
  virtual void markTied(std::span<std::uint8_t> /*tied*/) const {}

  /// What it stores now and is in no book of the particles' model, J.
  virtual double stored() const { return 0.0; }
  /// What it has lost so far, J; negative if it made energy. Not what the particles' model books.
  virtual double lost() const { return 0.0; }

private:
  std::unique_ptr<SolidSide> own_;
  SolidSide* side_;
};

}  // namespace dovetail::coupling
