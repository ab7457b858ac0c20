#include <petscksp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/linalg/multigrid.hpp"
#include "dovetail/ranks/session.hpp"
#include "petsc_owned.hpp"

namespace dovetail::linalg {

namespace {

/// Options of PETSc by its own names, unless the environment (PETSC_OPTIONS) says them.
void suggest(const char* name, const char* value) {
  PetscBool said = PETSC_FALSE;
  ranks::require(PetscOptionsHasName(nullptr, nullptr, name, &said), "options of PETSc");
  if (!said) ranks::require(PetscOptionsSetValue(nullptr, name, value), "options of PETSc");
}

constexpr const char* prefix = "dovetail_";

}  // namespace

struct Multigrid::Impl {
  double relativeTolerance;
  int maxIterations;
  std::size_t pattern = 0;
  bool symmetric = true, makesLevels = true;
  std::int64_t iterations = 0, setUps = 0;
  PetscInt last = 0;                     // iterations of the last solve
  double costAtFirst = 0.0, cost = 0.0;  // iterations a decade, of the first solve with these levels and of the last
  MPI_Comm comm = PETSC_COMM_SELF;       // that have rows
  std::vector<double> x;
  Owned<Mat, MatDestroy> matrix;
  Owned<KSP, KSPDestroy> solver;

  template <class Wrap>
  void take(std::size_t id, bool isSymmetric, std::span<const std::vector<double>> modes, Wrap&& wrap);
  void wrap(RowMatrix& A);
  void wrap(SharedRows& A);
  Vec vectorOf(double* values, std::size_t size) const;
  void setModes(std::span<const std::vector<double>> modes);
  void make();
  void minimiseResiduals(bool minimises);
  bool isIndefinite() const;
  bool iterate(std::span<double> b, double tolerance);
};

bool Multigrid::available() { return true; }
void Multigrid::require(const std::string&) {}

Multigrid::Multigrid(double relativeTolerance, int maxIterations) : impl_(std::make_unique<Impl>()) {
  impl_->relativeTolerance = relativeTolerance;
  impl_->maxIterations = maxIterations;
  ranks::start();
}
Multigrid::~Multigrid() = default;
Multigrid::Multigrid(Multigrid&&) noexcept = default;

/// The arrays themselves, not copies.
void Multigrid::Impl::wrap(RowMatrix& A) {
  comm = PETSC_COMM_SELF;
  ranks::require(MatCreateSeqAIJWithArrays(comm, A.size, A.size, A.offsets.data(), A.column.data(), A.value.data(),
                                           matrix.fresh()),
                 "matrix of a solid");
}

void Multigrid::Impl::wrap(SharedRows& A) {
  comm = PETSC_COMM_WORLD;
  ranks::require(MatCreateMPIAIJWithSplitArrays(comm, A.own.size, A.own.size, A.firsts.back(), A.firsts.back(),
                                                A.own.offsets.data(), A.own.column.data(), A.own.value.data(),
                                                A.others.offsets.data(), A.others.column.data(), A.others.value.data(),
                                                matrix.fresh()),
                 "matrix of a solid on ranks");
}

/// On these numbers, not a copy.
Vec Multigrid::Impl::vectorOf(double* values, std::size_t size) const {
  Vec vector = nullptr;
  const auto own = static_cast<PetscInt>(size);
  ranks::require(comm == PETSC_COMM_SELF ? VecCreateSeqWithArray(comm, 3, own, values, &vector)
                                         : VecCreateMPIWithArray(comm, 3, own, PETSC_DECIDE, values, &vector),
                 "vector of a solid");
  return vector;
}

void Multigrid::Impl::setModes(std::span<const std::vector<double>> modes) {
  constexpr const char* doing = "rigid motions of a solid";
  std::vector<Vec> raw;
  std::array<Owned<Vec, VecDestroy>, 6> basis;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    ranks::require(MatCreateVecs(matrix, basis[k].fresh(), nullptr), doing);
    PetscScalar* to = nullptr;
    ranks::require(VecGetArray(basis[k], &to), doing);
    std::ranges::copy(modes[k], to);
    ranks::require(VecRestoreArray(basis[k], &to), doing);
    for (const Vec other : raw) {
      PetscScalar along = 0.0;
      ranks::require(VecDot(basis[k], other, &along), doing);
      ranks::require(VecAXPY(basis[k], -along, other), doing);
    }
    ranks::require(VecNormalize(basis[k], nullptr), doing);
    raw.push_back(basis[k]);
  }
  Owned<MatNullSpace, MatNullSpaceDestroy> space;
  ranks::require(MatNullSpaceCreate(comm, PETSC_FALSE, static_cast<PetscInt>(raw.size()), raw.data(), space.fresh()),
                 doing);
  ranks::require(MatSetNearNullSpace(matrix, space), doing);
}

/// By GMRES, for matrices that are not symmetric positive definite, or by conjugate gradients.
void Multigrid::Impl::minimiseResiduals(bool minimises) {
  constexpr const char* doing = "multigrid of a solid";
  ranks::require(KSPSetType(solver, minimises ? KSPGMRES : KSPCG), doing);
  ranks::require(KSPSetPCSide(solver, minimises ? PC_RIGHT : PC_LEFT), doing);
  ranks::require(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED), doing);
  if (minimises) ranks::require(KSPGMRESSetRestart(solver, 60), doing);
}

bool Multigrid::Impl::isIndefinite() const {
  KSPConvergedReason reason{};
  ranks::require(KSPGetConvergedReason(solver, &reason), "multigrid of a solid");
  return reason == KSP_DIVERGED_INDEFINITE_MAT || reason == KSP_DIVERGED_INDEFINITE_PC;
}

void Multigrid::Impl::make() {
  constexpr const char* doing = "multigrid of a solid";
  ranks::require(KSPCreate(comm, solver.fresh()), doing);
  ranks::require(KSPSetOptionsPrefix(solver, prefix), doing);
  PC pc = nullptr;
  ranks::require(KSPGetPC(solver, &pc), doing);
  ranks::require(PCSetType(pc, PCGAMG), doing);
  suggest("-dovetail_pc_gamg_agg_nsmooths", "1");
  suggest("-dovetail_mg_levels_pc_type", "jacobi");
  ranks::require(KSPSetFromOptions(solver), doing);
}

template <class Wrap>
void Multigrid::Impl::take(std::size_t id, bool isSymmetric, std::span<const std::vector<double>> modes, Wrap&& wrap) {
  constexpr const char* doing = "multigrid of a solid";
  const bool samePattern = matrix && pattern == id;
  const bool same = samePattern && symmetric == isSymmetric;
  makesLevels = !same || cost > 1.5 * costAtFirst;
  symmetric = isSymmetric;
  pattern = id;
  if (samePattern) {
    ranks::require(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY), doing);
    ranks::require(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY), doing);
  } else {
    solver.reset();
    wrap();
    ranks::require(MatSetBlockSize(matrix, 3), doing);
  }
  if (!same) make();
  minimiseResiduals(!symmetric);
  ranks::require(MatSetOption(matrix, MAT_SPD, symmetric ? PETSC_TRUE : PETSC_FALSE), doing);
  if (makesLevels) setModes(modes);
  ranks::require(KSPSetOperators(solver, matrix, matrix), doing);
}

void Multigrid::take(RowMatrix& A, std::size_t pattern, bool symmetric, std::span<const std::vector<double>> modes) {
  impl_->take(pattern, symmetric, modes, [&] { impl_->wrap(A); });
}
void Multigrid::take(SharedRows& A, std::size_t pattern, bool symmetric, std::span<const std::vector<double>> modes) {
  impl_->take(pattern, symmetric, modes, [&] { impl_->wrap(A); });
}

bool Multigrid::Impl::iterate(std::span<double> b, double tolerance) {
  constexpr const char* doing = "multigrid of a solid";
  Owned<Vec, VecDestroy> right, left;
  x.assign(b.size(), 0.0);
  *right.fresh() = vectorOf(b.data(), b.size());
  *left.fresh() = vectorOf(x.data(), x.size());
  ranks::require(KSPSetTolerances(solver, tolerance, 1e-300, 1e10, maxIterations), doing);
  ranks::require(KSPSetReusePreconditioner(solver, makesLevels ? PETSC_FALSE : PETSC_TRUE), doing);
  ranks::require(KSPSolve(solver, right, left), doing);
  ranks::require(KSPGetIterationNumber(solver, &last), doing);
  iterations += last;
  cost = last / -std::log10(tolerance);
  if (std::exchange(makesLevels, false)) ++setUps, costAtFirst = cost;
  KSPConvergedReason reason{};
  ranks::require(KSPGetConvergedReason(solver, &reason), doing);
  return reason > 0;
}

void Multigrid::solve(std::span<double> b, double loosest) {
  Impl& m = *impl_;
  const double tolerance = std::max(m.relativeTolerance, loosest);
  const bool keeps = !m.makesLevels;
  bool done = m.iterate(b, tolerance);
  if (!done && m.isIndefinite()) {
    m.minimiseResiduals(true);
    done = m.iterate(b, tolerance);
  }
  if (!done && keeps) {
    m.makesLevels = true;
    done = m.iterate(b, tolerance);
  }
  if (!done) {
    PetscReal norm = 0.0;
    ranks::require(KSPGetResidualNorm(m.solver, &norm), "multigrid of a solid");
    throw NumericalError(
        "multigrid stops after " + std::to_string(m.last) + " iterations at a residual of " + formatNumber(norm),
        "linear solver", "take the direct method, a smaller step, or more iterations");
  }
  std::ranges::copy(m.x, b.begin());
}

std::int64_t Multigrid::iterations() const { return impl_->iterations; }
std::int64_t Multigrid::setUps() const { return impl_->setUps; }

}  // namespace dovetail::linalg
