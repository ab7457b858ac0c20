// Motion of a model in time: explicit central differences, the Newmark family, energy and momentum conserving steps.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/impulses.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"

namespace dovetail::fem {

/// Steps that follow a solid.
struct StepRange {
  double shortest = 0.0, longest = 0.0;  ///< s, that were set; 0 if all steps are the same
  int element = -1;                      ///< that set the shortest, by its number in the mesh
  std::string solid;                     ///< its solid
};

/// What a run did, for people and programs. Energies are in the ledger.
struct DynamicsReport {
  std::string scheme, solver;
  double massFraction = 0.0;  ///< 0 lumped, 1 consistent
  double t = 0.0;             ///< s, reached
  double dt = 0.0;            ///< s, asked for; of steps that follow the solid the present one
  StepRange stepRange;        ///< of steps that follow the solid
  double criticalStep = 0.0;  ///< s, of the explicit step, when it was last looked at; 0 if it was not
  std::int64_t steps = 0;     ///< accepted, parts of cut ones included
  std::int64_t cuts = 0;      ///< attempts that were given up and tried again with half the step
  std::int64_t iterations = 0, factorisations = 0;
  double largestResidual = 0.0;  ///< force out of balance over its tolerance, of accepted steps; ≤ 1
  /// Terms whose energy the conserving scheme does not keep: their force is that at the mean state.
  std::vector<std::string> atMeanState;
  EnergyLedger ledger;
  Profile profile;
};
/// A page of text.
std::ostream& operator<<(std::ostream& out, const DynamicsReport& report);

struct ExplicitOptions {
  double massFraction = 0.0;  ///< of the consistent mass (ModelMass); 0 is the usual choice
  /// Refuse steps above the bound of the stiffest element, stableStep(model). (Springs and contact planes are in it;
  /// stiffening under load is not. Masses between lumped and consistent count with the least they can be, bricks'
  /// 1/27.)
  bool checkStep = true;
  int energyEvery = 1;  ///< steps between samples of stored energy; 0 = no ledger
  /// Steps between looks for inverted elements; run() looks once more at its end, and NaN is looked for in every step.
  /// 0 = never
  int checkEvery = 100;
  /// Above 0 the step follows the solid: it is this fraction of the bound above as elements are deformed then, and dt
  /// at the most. Velocity Verlet with ½(dt_old + dt_new) in the kick between two lengths: second order as before, but
  /// energy is no longer kept for ever. 0 = dt throughout.
  double safety = 0.0;
  /// Most steps from one look at the bound to the next; as many fewer as it takes for the bound to change by 2 % in
  /// between. A look costs as much as 70 to 400 steps of elastic elements. Impact after free flight crushes elements
  /// within the time they take to pass their length: looks must come sooner.
  int measureEvery = 20;
  double shortest = 1e-3;  ///< fraction of the first step below which one that follows gives up
};

/// Central differences as kick–drift–kick, second order. Forces that depend on the velocity see v + dt a of the last
/// step; ties by TᵀMT.
///
/// Works of terms without energy, of supports and of damping are booked as kicks do them, so the residual of the ledger
/// is the oscillation of the stored energy of a symplectic step and nothing else.
class ExplicitIntegrator {
public:
  /// The model must outlive the integrator; terms and constraints are read here.
  /// @param dt  s; the longest step if it follows the solid
  /// @throws InputError for dt ≤ 0 or above the stable one (the element is named), options out of range, nodes without
  /// mass
  ExplicitIntegrator(Model& model, double dt, const ExplicitOptions& options = {});
  ~ExplicitIntegrator();
  ExplicitIntegrator(ExplicitIntegrator&&) noexcept;

  /// @throws NumericalError naming node or element if the state breaks down, or the element that is crushed so far that
  ///         its step is below the shortest
  void step();
  void run(std::int64_t steps);
  /// Steps up to time t, s; the last two are shortened so as to end there. @throws InputError if t has passed
  void runUntil(double t);
  const EnergyLedger& ledger() const;
  DynamicsReport report() const;
  /// ½ vᵀMv with the mass in use, J.
  double kineticEnergy() const;

  /// State of model, terms and ledger; a run that goes on from it has the same digits.
  void save(ByteWriter& archive) const;
  /// @throws InputError if the state is that of another kind of run or model, is damaged, not finite, or not all of the
  /// archive; model and integrator are then as they were
  void load(ByteReader& archive);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Parameters of an implicit scheme; made by the functions below.
struct Scheme {
  std::string name;
  bool conserving = false;
  double alphaM = 0.0, alphaF = 0.0, beta = 0.25, gamma = 0.5;
};
/// Newmark (1959). Second order for γ = ½ only.
/// @throws InputError unless 2β ≥ γ ≥ ½ (unconditionally stable for linear solids)
Scheme newmark(double beta = 0.25, double gamma = 0.5);
/// Hilber, Hughes & Taylor (1977), second order; dissipates high frequencies for α < 0.
/// @param alpha  −⅓ … 0
Scheme hht(double alpha);
/// Chung & Hulbert (1993), second order; the highest frequencies shrink by ρ∞ per step.
/// @param rhoInfinity  0 … 1
Scheme generalisedAlpha(double rhoInfinity);
/// Simo & Tarnow (1992), Gonzalez (2000): M (v₁ − v₀) = dt f, u₁ − u₀ = ½ dt (v₀ + v₁) with f = addConservingForces of
/// the terms, or their force at the mean state. Second order; energy and both momenta of a free body of elastic solids
/// stay to the tolerance for any dt that Newton's method solves. Standard elements take the stress at the mean metric,
/// which does not see turns; the others take the force at the mean state, with forces between their nodes that make its
/// work right, and feel a turn by θ in a step as a strain of θ²/8. Of solids that remember (plastic, viscous), and of
/// following pressure and friction, momenta alone are kept; DynamicsReport::atMeanState names those with an energy.
Scheme energyMomentum();

struct ImplicitOptions {
  Scheme scheme = generalisedAlpha(0.8);
  double massFraction = 1.0;         ///< of the consistent mass
  double relativeTolerance = 1e-9;   ///< of the largest norm of a term's forces and of inertia
  double absoluteTolerance = 0.0;    ///< added to it, N (the resolution of the forces always is)
  int maxIterations = 25;            ///< per step
  int refactorAfter = 8;             ///< iterations of a step with one factorisation
  double refactorContraction = 0.3;  ///< factor again when an iteration shrinks the residual by less than this
  int maxCuts = 10;                  ///< halvings of a step that fails
  int maxAugmentations = 30;         ///< per step, for contact by augmented Lagrangian
  int energyEvery = 1;               ///< steps between samples of stored energy; 0 = no ledger
  linalg::LinearOptions linear{};
};

/// Implicit steps by Newton's method that keeps its factors for as long as they serve.
///
/// Ledger: works of terms without energy and of supports, dissipation of materials and friction, and the dissipation of
/// the scheme: −(M (v₁ − v₀)/dt − f̄) · du over the free components, f̄ the mean force of both ends of the step
/// (conserving: the force of the step). What remains in the residual is the error of the mean force of curved energies,
/// and nothing but the tolerance for the conserving scheme.
class ImplicitIntegrator {
public:
  /// The model must outlive the integrator; terms and constraints are read here.
  /// @throws InputError for dt ≤ 0, options out of range, nodes without mass
  ImplicitIntegrator(Model& model, double dt, const ImplicitOptions& options = {});
  ~ImplicitIntegrator();
  ImplicitIntegrator(ImplicitIntegrator&&) noexcept;

  /// Advances by dt, in parts if it must.
  /// @throws NumericalError with the reason (the element, the residual) if the smallest part fails; the model is then
  /// as
  ///         at the end of the last accepted part, model.t
  void step();
  void run(std::int64_t steps);
  const EnergyLedger& ledger() const;
  DynamicsReport report() const;
  /// What the linear systems of the steps are going to take, before the first of them.
  linalg::LinearForecast forecast();
  /// Starts anew from the model as it is now, which someone else has moved; the ledger continues.
  void restart();
  /// Terms that want other nodes get them, as at the start of every step; what this takes is booked. @return whether
  /// any did: nodes and masses are then others
  bool renewNodes();
  /// Takes another scheme of Newmark's from the next step on. @throws InputError if either is of another family
  void use(const Scheme& scheme);
  const ModelMass& mass() const;
  double kineticEnergy() const;
  /// What supports and the terms but the elements have given, if there is a ledger: the means of both ends of a step
  /// (conserving: the force of the step) at the mean positions.
  const ImpulseLedger& impulses() const;
  /// M v in total, kg m/s, and its moment about the origin, kg m²/s, with the mass in use.
  Vec3 momentum() const;
  Vec3 angularMomentum() const;

  /// With the matrix of the factors in use: a run that goes on from the state has the same digits.
  void save(ByteWriter& archive) const;
  /// @throws InputError if the state is that of another kind of run or model, is damaged, not finite, or not all of the
  /// archive; model and integrator are then as they were
  void load(ByteReader& archive);

private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dovetail::fem
