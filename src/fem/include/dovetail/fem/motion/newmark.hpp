// Implicit time step: Newmark's average acceleration with modified Newton iterations.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/elements/elements.hpp"
#include "dovetail/fem/solve/sparse.hpp"

namespace dovetail::fem {

struct NewmarkOptions {
  /// Share of the consistent mass: M = diag(nodes.mass) + share (M_consistent − its row sums). 0 lumped, 1 consistent.
  double consistentShare = 0.0;
  double relativeTolerance = 1e-10;  ///< of the largest of load, internal force and inertia (Euclidean norms)
  double absoluteTolerance = 0.0;    ///< added to it, N (the resolution of the internal force always is)
  int maxIterations = 40;            ///< per step
  int refactorAfter = 8;             ///< iterations with one factorisation in one step
  double refactorContraction = 0.3;  ///< factor again when an iteration shrinks the residual by less than this
};

struct NewmarkReport {
  int iterations;      ///< linear solves
  int factorisations;  ///< in this step
  double residual;     ///< Euclidean norm of the force that is out of balance, N
};

/// Newmark with β = ¼, γ = ½ (paper, sec. 3); owns the factorisation of 2M/dt² + ½K and keeps it over iterations and
/// steps for as long as it converges well.
///
/// The load is constant over the step, and so is the state between steps just u and v: in the average-acceleration
/// form M (v₁ − v₀) = dt [f_ext − ½(f_int(u₀) + f_int(u₁))], u₁ − u₀ = ½dt (v₀ + v₁). For a linear solid the energy
/// then changes by exactly f_ext · (u₁ − u₀). For second order in time the caller gives the mean load of the step. Held
/// components move with their velocity.
class NewmarkSolver {
public:
  /// The block is shared (see ElementBlock). Which components are held is read here, once.
  /// @throws InputError for dt ≤ 0, options out of range, or a node without mass
  NewmarkSolver(const ElementBlock& block, const Nodes& nodes, double dt, const NewmarkOptions& options = {});

  /// Advances u and v by dt; on return f = f_ext − f_int(u₁). If it throws, u and v are as before.
  /// @param externalForce  load per node, N; empty for none
  /// @throws NumericalError, with step, iteration and residual, if the iteration does not converge
  NewmarkReport step(Nodes& nodes, std::span<const Vec3> externalForce);

  /// Drops the factorisation: the next step is then bitwise that of a new solver (for checkpoints).
  void reset() { factored_ = false; }
  /// ½ vᵀMv with the mass matrix in use, J.
  double kineticEnergy(const Nodes& nodes) const;
  std::int64_t stepsDone() const { return steps_; }
  std::int64_t factorisationsDone() const { return factorisations_; }
  double dt() const { return dt_; }

private:
  void checkInput(const Nodes& nodes, std::span<const Vec3> externalForce) const;
  void listNodalMass();
  void factorAt(const Nodes& nodes);
  void evaluateForces(Nodes& nodes) const;
  std::vector<double> inertia(std::span<const double> field) const;
  double balance(const Nodes& nodes, std::span<const Vec3> load);
  void correct(Nodes& nodes, std::span<const Vec3> start);
  bool needsFactor(double residual, double before, int solves) const;
  NewmarkReport iterate(Nodes& nodes, std::span<const Vec3> load, std::span<const Vec3> start);
  [[noreturn]] void fail(const std::string& problem, int iteration, double residual) const;

  ElementBlock block_;
  double dt_;
  NewmarkOptions options_;
  std::vector<double> mass_;     // per dof
  SparseMatrix massCorrection_;  // share · (M_consistent − its row sums); empty if lumped
  SparseMatrix nodalMass_;       // the same per node
  std::vector<int> freeRow_;     // per dof: row among the free ones, −1 if held
  SparseCholesky cholesky_;
  bool factored_ = false;
  double largestStiffness_ = 0.0;   // on the diagonal, N/m
  std::vector<Vec3> startForce_;    // −f_int(u₀)
  std::vector<double> correction_;  // per dof: u₁ − u₀ − dt v₀
  std::vector<double> residual_;    // per free dof
  double tolerance_ = 0.0;
  std::int64_t steps_ = 0, factorisations_ = 0;
};

}  // namespace dovetail::fem
