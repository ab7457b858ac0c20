// The verbs of an explicit step with a ledger: what the explicit integrator and coupled runs are written with.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dovetail/core/impulses.hpp"
#include "dovetail/fem/motion/model_ledger.hpp"
#include "dovetail/fem/motion/motion.hpp"

namespace dovetail::fem {

/// Motion and its books. A step of length h from t is
///
///     halfKick(h, t + h/2) · motion.drift(h) · evaluate(h, …, true) · halfKick(h, t + h) · accept(h)
///
/// Works of terms without energy, of supports and of what materials dissipate are booked as kicks do them.
class BookedMotion {
public:
  /// Puts prescribed and tied components in their place and finds the forces at the start.
  /// @param h  s, of the steps to come
  /// @throws InputError as Motion
  BookedMotion(Model& model, double massFraction, double h);

  /// nodes.f = forces at the present state; whoever couples may add to them before the next kick. Forces that depend on
  /// the velocity see the one that the last forces would lead to.
  /// @param willAccept  whether accept(h) follows with nothing asked for in between
  void evaluate(double h, bool withEnergies, bool willAccept);
  /// v += a h/2, constrained components as at `time`. @param books  whether works are booked
  /// @return false if a velocity is not finite any more
  bool halfKick(double h, double time, bool books);
  /// The materials accept the step of length h that ends here.
  void accept(double h, bool books) { ledger.accept(motion.model(), {motion.model().t, h, &motion.mass()}, books); }
  /// Between steps, the last of which had the length h: terms that want other nodes get them; what this takes of the
  /// kinetic energy, and gives of momenta, is booked. @return whether any did: nodes are then others, with their forces
  bool renewNodes(double h);
  /// Sets the stored channels: energies of the last evaluate with them, and kinetic energy.
  void sample() { ledger.sample(motion.model(), motion.energies(), motion.kineticEnergy()); }
  /// Work of a force on the nodes in a kick that has changed their velocities from `before`, of half the length h, J.
  double workInHalfKick(std::span<const Vec3> force, std::span<const Vec3> before, double h) const;

  bool supportsMove() const { return moving_; }
  /// State of model, terms and books; a run that goes on from it has the same digits. @param kind  marks the state
  void save(ByteWriter& archive, const std::string& kind) const;
  struct State;
  /// What save() wrote. @throws InputError if it is of another kind of run or model, is damaged or not finite
  std::shared_ptr<State> read(ByteReader& archive, const std::string& kind) const;
  /// Puts it in force. @throws InputError if a term refuses its part; nothing is changed then
  void adopt(State& state);

  Motion motion;
  ModelLedger ledger;
  ImpulseLedger impulses;  ///< of supports and of the terms but the elements, in kicks that are booked

private:
  void findForces(double h, bool withEnergies, bool willAccept);
  void accelerate(double h);
  bool push(double h, double time);
  void giveImpulses(double h, bool changes);
  bool guessesVelocity_, moving_, worksAreBooked_;
  bool accelerated_ = false;        // acceleration_ is that of nodes.f
  std::vector<Vec3> acceleration_;  // m/s²; empty where M⁻¹ is a division
  std::vector<Vec3> before_;
  // Of the last evaluation, N and N m: forces per term, empty before they are asked for, and those of supports at rest.
  std::vector<Momenta> outside_;
  Momenta atSupports_;
};

}  // namespace dovetail::fem
