// One run: particles, any number of solids, and their couplings.
//
//     coupling::CoupledRun run;
//     run.grains.laws = dem::makeContactLaws(law);
//     dem::addParticle(run.grains.particles, …);
//     coupling::SolidSide& beam = run.addSolid(std::move(model), {.name = "beam"});
//     run.grains.terms.add(surface::SurfaceContact(beam, …));
//     run.start(dt);
//     run.advance(steps);
//     std::cout << run.ledger();
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/core/impulses.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/core/rest.hpp"
#include "dovetail/core/step_limit.hpp"
#include "dovetail/coupling/connector.hpp"
#include "dovetail/coupling/solid_side.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/fem/model/checkpoint.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/solve/statics.hpp"

namespace dovetail::coupling {

struct SolidOptions {
  std::string name = "solid";  ///< in ledgers, errors and profiles
  Stepping stepping = Stepping::explicitSteps;
  double massFraction = 0.0;  ///< of the consistent mass; 0 lumped
  /// Of implicit steps; its massFraction is the one above.
  fem::ImplicitOptions implicitOptions{.scheme = fem::newmark(), .relativeTolerance = 1e-10};
  /// Of load steps, whose linear systems are solved as those of implicit steps.
  fem::NewtonOptions newton{};
  int motionIterations = 0;  ///< of load steps, as in fem::StaticOptions
};

/// Instants at which forces act. All but `none` serve comparison with staggered schemes: a load that lags adds energy
/// to a solid that responds by inertia, and takes it from one that responds elastically.
enum class Lag {
  none,        ///< all forces of a kick belong to one instant
  load,        ///< the solid steps first, under the mean of the loads of the last two evaluations
  loadAndSkin  ///< and the particles then see the solid where it was before its step
};

struct RunOptions {
  /// K: particle steps per step of the solids. Explicit: impulse multiple time stepping (Tuckerman, Berne & Martyna,
  /// J. Chem. Phys. 97, 1992), the solids' own forces kick the nodes at the ends of macro steps of K dt, connectors at
  /// every step; K dt below the solids' limit and away from half the period of what connectors do. Implicit (Strang
  /// splitting): ⌊K/2⌋ steps with the solid held fixed, one free step K dt of the solid, ⌊K/2⌋ steps; for odd K the
  /// solid moves within the middle step.
  int stepsPerMacroStep = 1;
  Lag lag = Lag::none;
};

/// Momentum and mass now, and their sources since the first start.
struct Totals {
  Vec3 momentum;         ///< kg m/s
  Vec3 angularMomentum;  ///< about the origin, kg m²/s
  double mass = 0.0;     ///< kg
  Vec3 ontoSolids;       ///< impulse of the connectors on the solids so far, kg m/s

  /// External contributions by source: gravity, walls and loads of the particles; supports and loads of every solid;
  /// particles that entered and left.
  ImpulseLedger given;
  double massGained = 0.0;  ///< kg, by what entered and left
  /// Present value less that at the first start and all contributions: round-off for explicit solids and Newmark's
  /// steps to the tolerance of their solver; the angular part of Newmark's steps falls with dt². In periodic space,
  /// moments across periodic axes are left out: those of the sides have no source.
  Momenta residual;
  double massResidual = 0.0;  ///< kg
  /// Sums of the magnitudes of all impulses, of connectors too, to which the residual is relative; kg m/s, kg m²/s.
  double turnedOver = 0.0, turnedOverAngular = 0.0;
};
/// Table of the sources and the residual.
std::ostream& operator<<(std::ostream& out, const Totals& totals);

/// Reactions of supports and ties on the nodes of a solid, N per node.
struct Reactions {
  std::vector<Vec3> supports;  ///< at components that are fixed, held or prescribed; with what their ties pass on
  std::vector<Vec3> ties;      ///< at components that are tied
};

/// Macro steps are symmetric in time and symplectic unless a solid dissipates or lags, so the error of the energy is of
/// second order in the step and does not drift.
class CoupledRun {
public:
  explicit CoupledRun(dem::Model particles = {});
  ~CoupledRun();
  CoupledRun(const CoupledRun&) = delete;
  CoupledRun& operator=(const CoupledRun&) = delete;

  dem::Model grains;

  /// Solids step together with the particles from here on; those at time zero only. Masses are set here if they are not
  /// (fem::addMass). @return the side that connectors are made with; it stays where it is
  /// @throws InputError if there is no model, the name is empty or another's, or the run has started
  SolidSide& addSolid(std::unique_ptr<fem::Model> model, const SolidOptions& options = {});
  std::size_t solids() const;
  SolidSide& solid(std::size_t k);
  const SolidSide& solid(std::size_t k) const;

  /// Computes the forces at the start. Call it once before the first step, and again to change the step or the options,
  /// or after `grains` was replaced; the ledger continues.
  /// @param dt  of the particles, s
  /// @throws InputError as dem::check does, for a step beyond criticalStep (unless grains.refusesUnstableSteps is
  ///         false; the run then goes on as before), options out of range, or a connector whose solid is not in this
  ///         run
  void start(double dt, const RunOptions& options = {});
  /// The critical step at the start, to choose the step by: computes forces, and opens no ledger.
  /// @throws InputError as start, but for the step, and if the run has started
  StepLimit limitAtStart(const RunOptions& options = {});
  /// Macro steps of K steps. The last one's end is an instant at which positions and velocities agree.
  /// @param withEnergies  false: there will be no ledger() at the end, which saves its energies
  /// @throws InputError if macroSteps is negative; NumericalError naming the particle, node or element that breaks down
  void advance(std::int64_t macroSteps = 1, bool withEnergies = true);
  /// advance, but for the half kick at the end: the velocities of particles lag behind their positions by half a step
  /// until dem::close(grains), which ledger() and save() call. Cheaper where steps are made one by one.
  void advanceOpen(std::int64_t macroSteps = 1, bool withEnergies = true);

  /// Load step number `step` of `steps` of all solids, between macro steps: from equilibrium to equilibrium, with what
  /// was out of balance before the first one held back in proportion to the load steps to come, while loads and
  /// prescribed motion go on by `time`, s, which may be 0. Solids are at rest after it; velocities before the first one
  /// are booked as "kinetic damping". Particles do not take part: they may touch no solid, before or after, and stand
  /// still if time passes. Ledger: work of loads, of supports and of what is held back, by trapezoidal sums.
  /// @return names of the solids whose equilibrium is not stable, as far as their solver tells
  /// @throws InputError for a connector that constrains; if particles touch a solid; for time that passes with
  ///         particles. NumericalError naming solid and load step where there is no equilibrium
  std::vector<std::string> loadStep(std::int64_t step, std::int64_t steps, double time);

  /// The next of the steps of equal arcs along the paths of equilibria of all solids, each as long as the first of
  /// `loadSteps` equal steps; no time passes. From what was out of balance before step 0 to equilibrium under the
  /// loads, which may fall and rise on the way (fem::followPath). @param step  counted from 0. Once loadFactor is 1 for
  /// a solid, it stays there. Otherwise as loadStep.
  std::vector<std::string> followLoads(std::int64_t step, std::int64_t loadSteps);
  /// Fraction of what was out of balance before load steps that has come on to solid k; 0 before the first ones.
  double loadFactor(std::size_t k) const;

  /// Changes parts of a started run between macro steps: gravity, laws, walls, functions of time of loads and supports,
  /// the constraints of solids. Forces are found anew; the energy that this adds at once is booked as
  /// "changes (minus)", momentum that goes with it as given by "changes". The step stays: one that is now beyond the
  /// limit is told in grains.passed.
  void change(const std::function<void()>& act);
  /// Sets all velocities to zero, between macro steps; the energy that this takes is booked as "kinetic damping".
  void stop();
  /// Switches numerical damping of implicit solids on or off, from the next macro step: it damps oscillations with
  /// periods of few macro steps; relax() uses it. In the ledger it is the dissipation of the scheme.
  void damp(bool on);
  /// Of particles, bodies and solids, J.
  double kineticEnergy() const;

  double time() const { return grains.time; }
  double dt() const;
  double macroStep() const;  ///< K dt, s

  // What follows needs forces: InputError before start().
  /// Sets all channels to the present state, and its extremes. Particles, solids and connectors by name; the baseline
  /// is the state at the first start.
  const EnergyLedger& ledger();
  Totals totals() const;
  /// Of solid k at the end of the last macro step: M a − f, with the accelerations a that the forces f and the motion
  /// of supports (second differences over a macro step) make. Sums of `supports` and of all loads are the rate of the
  /// momentum.
  Reactions reactions(std::size_t k) const;
  /// Forecast of the cost of the linear systems of solid k; empty for explicit steps.
  linalg::LinearForecast forecast(std::size_t k);
  /// The critical step with the present contacts, elements and connectors, and with the first contacts of particles
  /// that have none yet (dem::impactLimit). All connectors of a solid and its own forces share the same nodes; in macro
  /// steps of K steps see dem::criticalStep. A run checks its state now and then, and sets grains.passed when the step
  /// exceeds the limit.
  StepLimit criticalStep();

  /// The state between macro steps. A run that is set up in the same way and started continues from it with the same
  /// digits.
  std::vector<char> save();
  /// @throws InputError if the state is of another scene or damaged; the run is then as it was
  void load(const std::vector<char>& state);

  Profile profile;

  struct Impl;

private:
  std::unique_ptr<Impl> impl_;
};

/// Summary of a started run: sizes, time, step, its limit and what sets that, ledger, momenta, and the time per stage
/// if Profile is on.
void report(CoupledRun& run, std::ostream& out);

/// The bytes of the particles' model (dem::saveState) within those of CoupledRun::save.
/// @throws InputError if they are cut off
std::vector<char> particlesOf(const std::vector<char>& state);

struct SolidOfState {
  std::string name;
  fem::SavedMotion motion;
};
/// The solids within them, in their order. @throws InputError if they are cut off, or not finite
std::vector<SolidOfState> solidsOf(const std::vector<char>& state);

/// Relaxes a started run under its present loads by kinetic damping (Cundall 1976): all velocities are set to zero
/// after each peak of the kinetic energy. Contact springs evolve as in any other step, so friction carries load. Time
/// advances by the macro steps taken, also for loads that are functions of it. Accuracy on the way does not matter:
/// with a step of half the limit, rest takes a third of the macro steps that a fifth of it needs. Spheres without
/// rolling resistance may roll on for ever. The residual is the largest kinetic energy of the last oscillation, or
/// since, over the elastic energy, 0 where nothing moves at all, or the square of dem::unbalancedLoads if that is
/// larger; at rest it is within the tolerance in two successive oscillations. Steps are macro steps.
/// @throws InputError for a criterion out of range; NumericalError as advance
RestReport relax(CoupledRun& run, const RestCriterion& rest = {.tolerance = 1e-8});

}  // namespace dovetail::coupling
