// How one solid of a run is stepped.
#pragma once

#include <memory>
#include <set>
#include <string>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/fem/solve/held_load.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::coupling {

/// What has been read of a state, to be put in force once all of it is read.
struct SavedSolid {
  virtual ~SavedSolid() = default;
};

/// A solid and the verbs of its macro step.
class SolidStepper {
public:
  SolidStepper(std::unique_ptr<fem::Model> model, const SolidOptions& options);
  virtual ~SolidStepper() = default;

  SolidSide side;
  double bookedBefore = 0.0;  ///< J, before the last start
  fem::HeldLoad held;         ///< what a static stage has yet to release
  fem::ParameterPath path;    ///< of a static stage along arcs; its parameter is the load factor
  double loadFactor = 0.0;    ///< of the last static stage
  struct StaticWork {
    double loads = 0.0, supports = 0.0, dissipated = 0.0, held = 0.0;  ///< J, in load steps
    int negativePivots = -1;                                           ///< of the tangent factorised last
  };
  StaticWork statics;
  bool stands = false;  ///< a load step has come last: whatever its supports do next, nothing accelerates
  NodalLoad macroLoad;  ///< N: what constraints do in both half macro steps around their ends
  ImpulseLedger::Channel loads{"connectors", {}};  ///< what they have given

  /// Between macro steps: terms that want other nodes get them. @return whether any did: loads are to be found anew
  bool renewNodes();
  /// Velocities of the nodes that particles see which stand for them, m/s. @param timeless  in an evaluation without a
  /// step in time
  virtual std::vector<Vec3> seenVelocities(bool timeless) const = 0;

  /// Forces at the start; the ledger of earlier steps is kept as one sum. @param dt  of particles, s @param K  steps
  /// per macro step
  virtual void start(double dt, int K) = 0;
  /// The half macro step's kick by its own forces, at the macro step's begin. @param sampled  energies will be asked
  /// for
  virtual void begin(bool sampled) = 0;
  /// Kick by the connectors' load for half a step, where it is no part of `begin` and `end`.
  virtual void kickByLoad() = 0;
  /// The nodes move along for one step of the particles.
  virtual void drift() = 0;
  /// The solid's own step in the middle of a macro step.
  virtual void jump() = 0;
  /// Puts the velocities that connectors are to see in the place of the nodes' own. @param timeless  the evaluation
  virtual void showVelocities(bool timeless) = 0;
  /// Puts the nodes' own back.
  virtual void hideVelocities() = 0;
  /// Own forces at the macro step's end. @param sampled  energies too
  virtual void findForces(bool sampled) = 0;
  /// All loads of the last evaluation are known.
  virtual void takeLoad() = 0;
  /// What constraints answer to forces that act at the ends of macro steps, for both half macro steps around this
  /// instant.
  virtual void takeMacroLoad(const NodalLoad& load) = 0;
  /// The half macro step's kick that ends it.
  virtual void end() = 0;
  /// A step of K dt under `load`, all else standing.
  virtual void stepUnder(const NodalLoad& load) = 0;

  /// The nodes stop; the kinetic energy of the solid's moving supports goes back to them.
  void stop();
  /// From rest in equilibrium to rest in equilibrium at `time`, s, while what is held falls to the fraction `after`.
  /// @throws NumericalError if there is none; the solid is then in the last one
  /// @return whether it is stable, or nobody knows
  bool loadStep(double after, double time);
  /// Likewise, one arc on along the path, as long as the first of so many equal load steps.
  bool followLoad(std::int64_t loadSteps);

  /// What the linear systems of its steps are going to take; nothing if there are none.
  virtual linalg::LinearForecast forecast() { return {}; }

  /// Whether what rings at periods of few steps is to die out; relax() asks for it.
  virtual void damp(bool) {}
  /// On every node at the end of a macro step, N: the solid's own, those of connectors, and what constraints answer.
  virtual std::vector<Vec3> forces() const = 0;
  virtual double kineticEnergy() const = 0;
  /// What loads of its own and supports have given.
  ImpulseLedger given() const;
  /// Sets its channels, "name: channel".
  virtual void sample(EnergyLedger& ledger) = 0;

  virtual void save(ByteWriter& archive) = 0;
  virtual std::shared_ptr<SavedSolid> read(ByteReader& archive) const = 0;
  virtual void adopt(SavedSolid& state) = 0;

protected:
  /// The same of what steps it. @return whether any did
  virtual bool renewOwnNodes() = 0;
  /// Begins anew where a load step has left the nodes.
  virtual void restart() = 0;
  virtual const ImpulseLedger& ownImpulses() const = 0;
  /// v += dt/m f on the touched nodes, held components apart: these give it to the supports.
  void kickTouched(const NodalLoad& load, double dt);
  void endLoadStep(const StaticWork& works, double heldBefore);
  void copyChannels(const EnergyLedger& own, double kinetic, EnergyLedger& ledger) const;
  void carryOver(const EnergyLedger& own) {
    bookedBefore += own.booked();
    for (const EnergyLedger::Channel& channel : own.channels())
      if (channel.kind == EnergyLedger::Kind::booked) carriedOver_.insert(channel.name);
    side.outside.add("", ownImpulses());
  }

  std::unique_ptr<fem::Model> model_;
  SolidOptions options_;
  double dt_ = 0.0;
  int K_ = 1;
  std::set<std::string> carriedOver_;  ///< channels whose joules are in bookedBefore, and which may not come again
};

/// Sum of a load at the present places, N and N m.
Momenta totalOf(const NodalLoad& load, const fem::Nodes& nodes);

std::unique_ptr<SolidStepper> makeStepper(std::unique_ptr<fem::Model> model, const SolidOptions& options);

}  // namespace dovetail::coupling
