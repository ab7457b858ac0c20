// What acts on the nodes of a solid: elements, loads, contact, damping. A model is a list of such terms.
#pragma once

#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/elements/critical_element.hpp"
#include "dovetail/fem/model/nodes.hpp"

namespace dovetail::linalg {
class BlockMatrix;
class MatrixPattern;
class NodeMatrix;
}  // namespace dovetail::linalg

namespace dovetail::fem {

class ModelMass;

/// What an accepted state is looked at for: elements turned inside out, or anything else too for which an answer of a
/// material cannot be trusted.
enum class Scrutiny { inversion, all };

/// When forces are asked for: at the end of a step of length dt, which is 0 where no time passes. Times in s.
struct Instant {
  double t = 0.0;
  double dt = 0.0;
  const ModelMass* mass = nullptr;  ///< of the integrator; null in statics, where velocities mean nothing
  bool rateAtEnd = false;           ///< rates are asked for at t, else their means over the step will do
  bool willCommit = false;          ///< commit() at this state follows for certain: nothing else is asked for before
};

/// A force on the nodes that depends on u, v and t, its tangent and its energy. State that lasts over steps (plastic
/// strain, multipliers) changes in commit() only: forces at the same u, v, t are the same however often they are asked.
class Term {
public:
  virtual ~Term() = default;
  /// Names its channel in the ledger.
  virtual std::string name() const = 0;

  /// f += force on the nodes, N. Reads nodes.X, u, v; never nodes.f.
  virtual void addForces(const Nodes& nodes, const Instant& now, std::span<Vec3> f) = 0;

  /// The same; @return its stored energy, J, in the same pass where that is cheaper, 0 without
  virtual double addForcesAndEnergy(const Nodes& nodes, const Instant& now, std::span<Vec3> f) {
    addForces(nodes, now, f);
    return hasEnergy() ? energy(nodes, now) : 0.0;
  }
  /// Whether its force may depend on v: time steps without any such term are spared a guess of v.
  virtual bool usesVelocity() const { return true; }

  /// Whether its force depends on how fast u has changed since the last commit, by dt; v is not read. Runs that start
  /// in motion then ask for it as if u had come to move by v.
  virtual bool feelsRates() const { return false; }

  /// Names the groups of nodes that its tangent couples (a node with itself needs no mention).
  virtual void addPattern(linalg::MatrixPattern&) const {}
  /// K += −∂f/∂u, N/m.
  virtual void addTangent(const Nodes&, const Instant&, linalg::BlockMatrix&) {}
  /// C += −∂f/∂v, kg/s.
  virtual void addDamping(const Nodes&, const Instant&, linalg::BlockMatrix&) {}
  virtual bool isSymmetric() const { return true; }
  /// k += row sums of its tangent at the present displacement, N/m: the largest of the three of each node, or a bound
  /// of it. Explicit steps ask all but elements, which have a bound of their own. Here: of addTangent(), 0 without
  /// energy.
  virtual void addStiffness(const Nodes& nodes, const Instant& now, std::span<double> k);
  /// 2/ω of the stiffest part of it with its lumped mass at the present displacement, never above the limit of the
  /// whole, where it is a body of its own (elements, material points) and not something that acts on one.
  virtual std::optional<StableStep> stableStep(const Nodes&) { return std::nullopt; }
  /// Whether it is: has mass and a stable step of its own.
  virtual bool isBody() const { return false; }
  /// Whether it acts among the nodes alone, as elements do: its forces have no sum and no moment.
  virtual bool actsWithin() const { return false; }
  /// Whether each rank of team() has a part of it: all of them call whatever they call, and have the same answers, but
  /// each adds to a matrix what its own part says.
  virtual bool isShared() const { return false; }

  /// Whether energy() is a function of the state whose negative gradient is the force (up to what commit() books).
  /// Work of terms without is booked by the integrator as it is done.
  virtual bool hasEnergy() const { return false; }
  /// Stored energy, J.
  virtual double energy(const Nodes&, const Instant&) { return 0.0; }

  /// f += a force for the step from u0 to nodes.u whose work on nodes.u − u0 is the loss of energy() exactly, and whose
  /// sum and moment about the mean positions vanish as those of the true force do (a discrete gradient).
  /// @return false if the term has none: integrators then take the force at the mean of both states
  virtual bool addConservingForces(const Nodes&, std::span<const Vec3> /*u0*/, const Instant&, std::span<Vec3> /*f*/) {
    return false;
  }
  /// K += −∂f/∂u of it, or close to that; not symmetric in general.
  virtual void addConservingTangent(const Nodes&, std::span<const Vec3> /*u0*/, const Instant&, linalg::BlockMatrix&) {}

  /// The step is accepted at this state: adopts new history. @return energy dissipated in the step, J
  virtual double commit(const Nodes&, const Instant&) { return 0.0; }
  /// Work that the term's own motion (of a plane) did in the step last accepted, J; commit() leaves it out.
  virtual double workOfMotion() const { return 0.0; }
  /// Called after convergence; @return true if it changed its multipliers and the step must be solved again
  virtual bool augment(const Nodes&, const Instant&) { return false; }
  /// The step is given up: multipliers are again those of the last commit.
  virtual void revert() {}

  /// Whether the nodes of the model are those of this term, which lays them out and renews them (a grid under material
  /// points); at most one of a model.
  virtual bool ownsNodes() const { return false; }
  /// Puts the nodes of its state in the place of all there are: at u = 0, with the velocities that the term gives them.
  virtual void layNodes(Nodes&) {}
  /// Whether they have travelled so far that it wants others in their place.
  virtual bool wantsOtherNodes(const Nodes&) const { return false; }
  /// Puts them there, between steps: its state and its momentum stay, the force at them needs no new answer of a
  /// material. @return kinetic energy that this takes, J, of nodes and of what energy() has of it
  virtual double renewNodes(Nodes&, double /*t*/) { return 0.0; }

  /// mass += its lumped masses, kg.
  virtual void addMass(std::span<double>) const {}
  /// mass += row sums ∫ρN of its consistent mass, kg: what a uniform field acts on.
  virtual void addBodyMass(std::span<double> mass) const { addMass(mass); }
  /// M += its consistent mass, kg.
  virtual void addConsistentMass(linalg::NodeMatrix&) const {}

  /// Committed state for checkpoints, and back.
  virtual void save(ByteWriter&) const {}
  virtual void load(ByteReader&) {}

  /// @throws NumericalError naming the element or node at fault, and `when`
  virtual void requireValid(const Nodes&, const std::string& /*when*/, Scrutiny) {}
};

}  // namespace dovetail::fem
