// Static equilibrium: Newton's method with line search, adaptive load steps, and arc-length continuation.
#pragma once

#include <cstdint>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/solve/linear_solver.hpp"

namespace dovetail::fem {

struct NewtonOptions {
  /// Of the largest Euclidean norm of a term's forces. The resolution of those forces (ε K u, and that of
  /// strains, which are known to ε) is added.
  double relativeTolerance = 1e-9;
  double absoluteTolerance = 0.0;  ///< added to it, N
  int maxIterations = 25;          ///< per step
  bool lineSearch = true;
  /// Keeps the factors while each iteration shrinks the force out of balance below this fraction (modified Newton);
  /// 0 factorises in every iteration.
  double reuseContraction = 0.0;
  /// For tangents that are dear and not the derivative, as those of cells: of how many earlier increments with the same
  /// factors each new one is bettered, by the least squares of Anderson (1965; type II), until the force out of balance
  /// grows in the step; 0 = none. Factors are kept while so many iterations together, not each, shrink it below
  /// reuseContraction, which must be above 0, and from step to step while a step takes no more iterations than that: a
  /// call that goes on from a saved state makes its own, and has the same digits only if that state ended a call. For
  /// solveStatics.
  int mixing = 0;
  linalg::LinearOptions linear{};
};

struct StaticOptions {
  NewtonOptions newton{};
  double firstStep = 0.1;      ///< s of model time
  double largestStep = 1e300;  ///< s
  double smallestStep = 1e-6;  ///< s; below it the run stops
  int iterationTarget = 6;     ///< steps grow if fewer iterations were needed and shrink if more
  int maxAugmentations = 30;   ///< per step, for contact by augmented Lagrangian
  /// Where the smallest step fails, for materials that jump: the nodes move to rest at the end of that step as in
  /// relax(), with the histories accepted at every one of at most so many iterations; then Newton's method goes on from
  /// there. 0 = none, the run stops. Needs nodes.mass.
  int motionIterations = 0;
};

/// One accepted step.
struct StaticStep {
  double t;               ///< s
  int iterations;         ///< linear solves, of a motion evaluations of the forces
  double residual;        ///< force out of balance, N
  int negativePivots;     ///< of the tangent factorised last: more than 0 if unstable there, −1 if not known
  double tolerance = 0;   ///< of the residual, N
  bool byMotion = false;  ///< Newton's method had failed, and the nodes moved there
};

/// There is no equilibrium within the smallest step.
class NoEquilibrium : public NumericalError {
public:
  NoEquilibrium(const std::string& why, const std::string& where, const std::string& remedy)
      : NumericalError(why, where, remedy), reason(why) {}
  std::string reason;  ///< alone
};

struct StaticReport {
  std::vector<StaticStep> steps;
  int cuts = 0;  ///< steps that were tried again with a smaller one
  std::int64_t iterations = 0, factorisations = 0;
  double storedBefore = 0.0, storedAfter = 0.0;  ///< J
  double loadWork = 0.0;                         ///< J, by terms without energy (trapezoidal sum)
  double supportWork = 0.0;           ///< J, by prescribed motion and moving contact planes (trapezoidal sum)
  double dissipated = 0.0;            ///< J, by materials and friction
  int motions = 0;                    ///< steps that were gone by motion to rest
  std::int64_t motionIterations = 0;  ///< of them, in all; not among `iterations`
  double largestKinetic = 0.0;        ///< J, of any motion
  double damped = 0.0;                ///< J, by the damping of motions
  double seconds = 0.0, assemblySeconds = 0.0, solverSeconds = 0.0;
  std::string solver;                 ///< "CHOLMOD", …
  std::int64_t linearIterations = 0;  ///< of multigrid
  /// stored + dissipated + damped − work, J: what the trapezoidal sums leave, second order in the step.
  double energyResidual() const { return storedAfter - storedBefore + dissipated + damped - loadWork - supportWork; }
};

/// A page of text.
std::ostream& operator<<(std::ostream& out, const StaticReport& report);

/// Called after every accepted step; return false to stop.
using StaticObserver = std::function<bool(const Model& model, const StaticStep& step)>;

/// Takes the model from model.t to tEnd through equilibria; loads and prescribed motions are functions of t. Time is
/// real for laws that creep, relax or depend on rates; velocities mean nothing. tEnd = model.t: to the equilibrium of
/// that instant, in one step in which no time passes.
/// @throws NoEquilibrium, with the reason, if the smallest step fails, whatever the terms or the solver threw; what
///         else is thrown passes through: linalg::FactorMemoryError, InputError for tEnd < model.t, options out of
///         range, constraints at odds. The model is then in its last equilibrium.
StaticReport solveStatics(Model& model, double tEnd, const StaticOptions& options = {},
                          const StaticObserver& observer = {});

struct ArcLengthOptions {
  NewtonOptions newton{};
  double firstStep = 0.1;          ///< s of model time, for the first step only
  double largestStep = 0.0;        ///< of the arc or the displacement, m; 0 = eight times that of the first step
  double smallestFraction = 1e-4;  ///< of the first arc; below it the run stops
  int iterationTarget = 5;
  int maxSteps = 200;
  int maxAugmentations = 30;  ///< per step, for contact by augmented Lagrangian
  /// If this is a node, the length of a step is that of its displacement component, which goes on in the sense in which
  /// it starts: through snap-backs of localised bands, whose growth it should measure (de Borst 1987).
  int node = -1;
  int component = 0;
  /// Above 0: once a step has dissipated that much, J, the following ones all do, for bodies without prescribed motion
  /// under loads proportional to t that are damaged: they would unload towards u = 0, so a step from (t₀, u₀) costs
  /// ½ (t₀ Δu − Δt u₀)·∂f/∂t (Gutiérrez 2004). A step that does not succeed so is tried by its length.
  double dissipation = 0.0;
};

/// Follows the path of equilibria u(t) by its arc length through limit points of the load and back (Riks 1979,
/// Crisfield 1981, cylindrical): t is one of the unknowns and may fall, and is no time for laws that know rates. Stops
/// when the observer returns false, at tEnd exactly, or when maxSteps are done.
/// @throws as solveStatics
StaticReport followPath(Model& model, double tEnd, const ArcLengthOptions& options,
                        const StaticObserver& observer = {});

/// A path of a parameter of the caller's, from 0 on, which several calls may follow.
struct ParameterPath {
  std::function<void(double)> set;         ///< puts a value of the parameter in force
  double at = 0.0;                         ///< in the last equilibrium
  double length = 0.0, firstLength = 0.0;  ///< of the next and of the first step, m; 0: the path has not begun
  std::vector<Vec3> lastMove;              ///< m
};
/// The same for such a parameter in the place of t, which stands still; options count in its unit.
/// @throws as solveStatics
StaticReport followPath(Model& model, ParameterPath& path, double end, const ArcLengthOptions& options,
                        const StaticObserver& observer = {});

}  // namespace dovetail::fem
