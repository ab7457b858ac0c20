#include "dovetail/fem/motion/newmark.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

namespace {

void validate(const NewmarkOptions& options) {
  requirePositive(options.relativeTolerance, "relativeTolerance");
  requireNonNegative(options.absoluteTolerance, "absoluteTolerance");
  requirePositive(options.refactorContraction, "refactorContraction");
  if (!(options.consistentShare >= 0.0 && options.consistentShare <= 1.0))
    throw InputError("consistentShare is " + formatNumber(options.consistentShare), "NewmarkOptions",
                     "give 0 (lumped) to 1 (consistent)");
  if (options.maxIterations < 1 || options.refactorAfter < 1)
    throw InputError("no iterations are allowed", "NewmarkOptions",
                     "give maxIterations and refactorAfter of 1 or more");
}

/// share · (M − its row sums on the diagonal).
SparseMatrix scaledCorrection(SparseMatrix M, double share) {
  const std::vector<double> ones(static_cast<std::size_t>(M.size), 1.0), sums = multiply(M, ones);
  for (std::size_t column = 0; column < sums.size(); ++column)
    for (int k = M.offsets[column]; k < M.offsets[column + 1]; ++k) {
      if (static_cast<std::size_t>(M.row[k]) == column) M.value[k] -= sums[column];
      M.value[k] *= share;
    }
  return M;
}

double norm(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

}  // namespace

NewmarkSolver::NewmarkSolver(const ElementBlock& block, const Nodes& nodes, double dt, const NewmarkOptions& options)
    : block_(block), dt_(requirePositive(dt, "dt")), options_(options) {
  validate(options);
  requireMass(nodes);
  if (nodes.u.size() != block.nodeCount())
    throw InputError("the nodes are not those of the elements", "NewmarkSolver", "use the nodes of the same mesh");
  int rows = 0;
  for (std::size_t dof = 0; dof < 3 * nodes.u.size(); ++dof) {
    mass_.push_back(nodes.mass[dof / 3]);
    freeRow_.push_back(nodes.fixed[dof / 3] >> dof % 3 & 1 ? -1 : rows++);
  }
  residual_.resize(static_cast<std::size_t>(rows));
  if (options.consistentShare > 0.0) {
    massCorrection_ = scaledCorrection(consistentMass(block), options.consistentShare);
    listNodalMass();
  }
}

/// The same for each component: one number per pair of nodes is enough for products.
void NewmarkSolver::listNodalMass() {
  nodalMass_.offsets.assign(1, 0);
  for (std::size_t column = 0; column < mass_.size(); column += 3) {
    for (int k = massCorrection_.offsets[column]; k < massCorrection_.offsets[column + 1]; ++k)
      if (massCorrection_.row[k] % 3 == 0) {
        nodalMass_.row.push_back(massCorrection_.row[k] / 3);
        nodalMass_.value.push_back(massCorrection_.value[k]);
      }
    nodalMass_.offsets.push_back(static_cast<int>(nodalMass_.row.size()));
  }
  nodalMass_.size = static_cast<int>(mass_.size() / 3);
}

void NewmarkSolver::checkInput(const Nodes& nodes, std::span<const Vec3> externalForce) const {
  if (3 * nodes.u.size() != mass_.size())
    throw InputError("the nodes are not those of the solver", "NewmarkSolver::step", "use the nodes it was made with");
  if (!externalForce.empty() && externalForce.size() != nodes.u.size())
    throw InputError(
        "there are " + std::to_string(externalForce.size()) + " loads for " + std::to_string(nodes.u.size()) + " nodes",
        "NewmarkSolver::step", "give one per node, or none");
}

void NewmarkSolver::fail(const std::string& problem, int iteration, double residual) const {
  throw NumericalError(problem,
                       "Newmark step " + std::to_string(steps_) + ", iteration " + std::to_string(iteration) +
                           ", residual " + formatNumber(residual) + " N, tolerance " + formatNumber(tolerance_) + " N",
                       "take a smaller step");
}

/// Factorises 2M/dt² + ½K (its symmetric part) of the free components.
void NewmarkSolver::factorAt(const Nodes& nodes) {
  const SparseMatrix K = tangent(block_, nodes);
  const double massFactor = 2.0 / (dt_ * dt_);
  SparseMatrix reduced;
  reduced.size = static_cast<int>(residual_.size());
  largestStiffness_ = 0.0;
  for (std::size_t column = 0; column < mass_.size(); ++column) {
    if (freeRow_[column] < 0) continue;
    for (int k = K.offsets[column]; k < K.offsets[column + 1]; ++k) {
      const auto row = static_cast<std::size_t>(K.row[k]);
      if (row < column || freeRow_[row] < 0) continue;
      double value = 0.5 * K.value[k];
      if (row == column) {
        largestStiffness_ = std::max(largestStiffness_, K.value[k]);
        value += massFactor * mass_[column];
      }
      if (massCorrection_.size > 0) value += massFactor * massCorrection_.value[k];
      reduced.row.push_back(freeRow_[row]);
      reduced.value.push_back(value);
    }
    reduced.offsets.push_back(static_cast<int>(reduced.row.size()));
  }
  factored_ = cholesky_.factor(reduced);
  ++factorisations_;
}

void NewmarkSolver::evaluateForces(Nodes& nodes) const {
  clearForces(nodes);
  addInternalForces(block_, nodes);
}

std::vector<double> NewmarkSolver::inertia(std::span<const double> field) const {
  std::vector<double> result(field.size());
  for (std::size_t dof = 0; dof < field.size(); ++dof) result[dof] = mass_[dof] * field[dof];
  for (std::size_t n = 0; n < static_cast<std::size_t>(nodalMass_.size); ++n) {
    Vec3 sum;  // the matrix is symmetric: columns are rows
    for (int k = nodalMass_.offsets[n]; k < nodalMass_.offsets[n + 1]; ++k) {
      const double* const other = &field[3 * static_cast<std::size_t>(nodalMass_.row[k])];
      sum += nodalMass_.value[k] * Vec3{other[0], other[1], other[2]};
    }
    for (int c = 0; c < 3; ++c) result[3 * n + static_cast<std::size_t>(c)] += sum[c];
  }
  return result;
}

/// Fills residual_ = f_ext − ½(f_int(u₀) + f_int(u₁)) − (2/dt²) M correction, sets the tolerance; returns the norm.
double NewmarkSolver::balance(const Nodes& nodes, std::span<const Vec3> load) {
  const std::vector<double> massTerm = inertia(correction_);
  const double massFactor = 2.0 / (dt_ * dt_);
  double loadSum = 0.0, startSum = 0.0, forceSum = 0.0, inertiaSum = 0.0, displacementSum = 0.0;
  for (std::size_t dof = 0; dof < mass_.size(); ++dof) {
    if (freeRow_[dof] < 0) continue;
    const std::size_t n = dof / 3;
    const int c = static_cast<int>(dof % 3);
    const double external = load.empty() ? 0.0 : load[n][c];
    const double start = startForce_[n][c], force = nodes.f[n][c], inertial = massFactor * massTerm[dof];
    residual_[static_cast<std::size_t>(freeRow_[dof])] = external + 0.5 * (start + force) - inertial;
    loadSum += external * external;
    startSum += start * start;
    forceSum += force * force;
    inertiaSum += inertial * inertial;
    displacementSum += nodes.u[n][c] * nodes.u[n][c];
  }
  // Displacements are known to a relative ε, hence forces to no better than ε K u.
  const double resolution =
      2.0 * std::numeric_limits<double>::epsilon() * largestStiffness_ * std::sqrt(displacementSum);
  tolerance_ = options_.relativeTolerance * std::sqrt(std::max({loadSum, startSum, forceSum, inertiaSum})) +
               options_.absoluteTolerance + resolution;
  return norm(residual_);
}

/// Solves for the correction and moves the nodes to u₀ + dt v₀ + correction.
void NewmarkSolver::correct(Nodes& nodes, std::span<const Vec3> start) {
  cholesky_.solve(residual_);
  for (std::size_t dof = 0; dof < mass_.size(); ++dof) {
    if (freeRow_[dof] < 0) continue;
    const std::size_t n = dof / 3;
    const int c = static_cast<int>(dof % 3);
    correction_[dof] += residual_[static_cast<std::size_t>(freeRow_[dof])];
    nodes.u[n][c] = start[n][c] + (dt_ * nodes.v[n][c] + correction_[dof]);
  }
}

bool NewmarkSolver::needsFactor(double residual, double before, int solves) const {
  return !factored_ || solves >= options_.refactorAfter ||
         (solves > 0 && residual > options_.refactorContraction * before);
}

NewmarkReport NewmarkSolver::iterate(Nodes& nodes, std::span<const Vec3> load, std::span<const Vec3> start) {
  NewmarkReport report{0, 0, 0.0};
  double before = 0.0;
  int solves = 0;  // with the present factorisation in this step
  while (true) {
    evaluateForces(nodes);
    report.residual = balance(nodes, load);
    if (!std::isfinite(report.residual)) fail("the forces are not finite", report.iterations, report.residual);
    if (report.residual <= tolerance_) return report;
    if (report.iterations == options_.maxIterations)
      fail("the iteration does not converge", report.iterations, report.residual);
    if (needsFactor(report.residual, before, solves)) {
      factorAt(nodes);
      ++report.factorisations;
      solves = 0;
      if (!factored_) fail("the tangent is not positive definite", report.iterations, report.residual);
    }
    before = report.residual;
    correct(nodes, start);
    ++report.iterations;
    ++solves;
  }
}

NewmarkReport NewmarkSolver::step(Nodes& nodes, std::span<const Vec3> externalForce) {
  checkInput(nodes, externalForce);
  const std::vector<Vec3> start = nodes.u;
  evaluateForces(nodes);
  startForce_ = nodes.f;
  correction_.assign(mass_.size(), 0.0);
  drift(nodes, dt_);
  NewmarkReport report{};
  try {
    report = iterate(nodes, externalForce, start);
  } catch (const NumericalError&) {
    nodes.u = start;
    nodes.f = startForce_;
    factored_ = false;
    throw;
  }
  for (std::size_t dof = 0; dof < mass_.size(); ++dof)
    nodes.v[dof / 3][static_cast<int>(dof % 3)] += 2.0 / dt_ * correction_[dof];
  if (!externalForce.empty())
    for (std::size_t n = 0; n < nodes.f.size(); ++n) nodes.f[n] += externalForce[n];
  ++steps_;
  return report;
}

double NewmarkSolver::kineticEnergy(const Nodes& nodes) const {
  std::vector<double> v(mass_.size());
  for (std::size_t dof = 0; dof < v.size(); ++dof) v[dof] = nodes.v[dof / 3][static_cast<int>(dof % 3)];
  const std::vector<double> momentumOfDof = inertia(v);
  double sum = 0.0;
  for (std::size_t dof = 0; dof < v.size(); ++dof) sum += 0.5 * v[dof] * momentumOfDof[dof];
  return sum;
}

}  // namespace dovetail::fem
