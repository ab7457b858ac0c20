// What stands between the particles of a run and one of its solids.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "dovetail/core/ledger.hpp"
#include "dovetail/coupling/solid_side.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::coupling {

/// A term of the particles' model that also acts on the nodes of a solid: what it does to one side it does to the
/// other, transposed. It is asked and told like any other term (dem::Term: check, renewed, renumber, leaving, addDemand,
/// save, load …). In addForces it adds to particles.f, and to side().load the reaction; the nodes have then moved
/// already. Constraints, which answer all other forces, have the order dem::Term::Order::constraints.
class Connector : public dem::Term {
public:
  explicit Connector(SolidSide& side) : side_(&side) {}
  SolidSide& side() const { return *side_; }

  /// @throws InputError always: a copy would act on the same solid. Save the run and load it into another.
  std::unique_ptr<dem::Term> clone() const final;

  /// Forces that answer those of the solid's own terms where these act at the ends of windows only, as an impulse:
  /// adds to `onParticles` and `load`, N. @param ownForce  of the solid, N @param window  s
  virtual void constrainWindow(const dem::Model&, std::span<const Vec3> /*ownForce*/, double /*window*/,
                               std::span<Vec3> /*onParticles*/, NodalLoad& /*load*/) {}
  virtual bool constrains() const { return false; }

  /// What it stores now and is in no book of the particles' model, J.
  virtual double stored() const { return 0.0; }
  /// What it has lost so far, J; negative if it made energy. Not what the particles' model books.
  virtual double lost() const { return 0.0; }

private:
  SolidSide* side_;
};

}  // namespace dovetail::coupling
