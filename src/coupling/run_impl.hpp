// What a run keeps.
#pragma once

#include <optional>

#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/model/impact.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "outside.hpp"
#include "solid_stepper.hpp"

namespace dovetail::coupling {

/// In the list of the particles' terms: opens an evaluation of forces for all connectors.
class SolidsTerm final : public dem::Term {
public:
  explicit SolidsTerm(CoupledRun::Impl* run) : run_(run) {}
  SolidsTerm(const SolidsTerm&) : run_(nullptr) {}  // a copy of the particles' model asks nothing of the solids

  std::string name() const override { return "solids"; }
  std::unique_ptr<dem::Term> clone() const override { return std::make_unique<SolidsTerm>(*this); }
  Order order() const override { return Order::partners; }
  double move(dem::Model& m, const dem::Step& step) override;
  void addForces(dem::Model& m, const dem::Step& step) override;
  void book(dem::Model& m, const dem::Step& step) override;
  double renumber(std::span<const int> newNumber, const dem::Particles& before) override;
  bool of(const CoupledRun::Impl* run) const { return run_ == run; }

private:
  bool isAwake() const;
  bool ownForcesDue(const dem::Step& step) const;
  CoupledRun::Impl* run_;
};

struct CoupledRun::Impl {
  dem::Model& grains;
  Profile& profile;
  std::vector<std::unique_ptr<SolidStepper>> solids;
  RunOptions options;
  double dt = 0.0;
  bool started = false;
  EnergyLedger ledger;
  Outside outside;  ///< impulses on the particles, and what there was at the first start

  // Of the evaluation under way.
  bool ownForcesDue = false;  ///< the macro step ends with it
  bool sampled = true;        ///< energies are wanted

  std::vector<fem::StableStep> elements;  ///< as last looked at, of explicit solids; infinite: of none

  // Of constraints in macro steps of several steps.
  std::vector<Vec3> macroForce;  ///< on particles, N; empty without constraints

  Impl(dem::Model& g, Profile& p) : grains(g), profile(p) {}

  struct State;
  std::vector<char> save();
  State read(const std::vector<char>& bytes) const;
  std::optional<State> readOwn();
  void adopt(State state);

  /// Whether loads kick explicit solids together with their own forces: without sub-steps and without a lag.
  bool kicksTogether() const { return K() == 1 && options.lag == Lag::none; }
  int K() const { return options.stepsPerMacroStep; }
  double macroStep() const { return K() * dt; }
  /// Solids have a step: until then the particles' model steps alone.
  bool hasStep() const { return dt > 0.0; }
  bool anyImplicit() const;
  /// Momentum and mass now.
  Totals sums() const;
  void open();
  /// Of the state alone. @param looksAtElements  anew: it costs as much as hundreds of steps
  StepLimit limitNow(dem::ContactDemand& demand, bool looksAtElements);
  double rateOf(const void* model) const;
  /// Of particles that stand for parts of the solid, to what is asked of them.
  void addOwnForces(const SolidSide& side, double rate, dem::ContactDemand& demand) const;
  std::vector<dem::SolidPart> solidParts() const;
  StepLimit criticalStep();
  void lookAtLimit(bool failed = false);
  bool joined() const;
  void joinParticles();
  void requireSides() const;
  void requireStarted(const char* what) const;
  /// Of the particles, solids and connectors as they are, for steps that long.
  void findForces(double step, const RunOptions& with);

  void macroStep(bool wantsEnergies);
  void stepParticles(bool last);
  double placeParticles(bool timeless);
  void renewNodes();
  void requireKept(Lag lag) const;
  void jumpBetweenSteps();
  void constrainMacroStep();
  void reportVelocities();
  void kickByMacroForce();
  void lagMacroStep();
  void rememberLoads();
  void requireApart(const char* when) const;
  void requireLoadSteps(double time) const;
  void beginLoadStep(bool first);
  void endLoadStep(double time);
  void stopSolids();
  Momenta lateLoads() const;
  std::vector<NodalLoad> loadBefore;  ///< per solid: of the evaluation before the last; only with a lag
  std::vector<std::vector<Vec3>> lagFrom, lagTo, lagSeen;  ///< u at the ends of its step, and as last seen; m
  double broughtToRest = 0.0;                              ///< J, taken by stop()
  double changed = 0.0;                                    ///< J, added by change()
  double madeByLag = 0.0;  ///< J: work of lagging loads on the nodes less that of the present ones
};

}  // namespace dovetail::coupling
