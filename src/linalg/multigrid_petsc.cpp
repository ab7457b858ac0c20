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

namespace dovetail::linalg {

namespace {

/// What PETSc makes, and destroys.
template <class T, PetscErrorCode (*destroy)(T*)>
class Owned {
public:
  Owned() = default;
  ~Owned() { reset(); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
  void reset() {
    if (it_) destroy(&it_);
  }
  operator T() const { return it_; }
  T* fresh() {
    reset();
    return &it_;
  }

private:
  T it_ = nullptr;
};

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
  std::vector<double> x;
  Owned<Mat, MatDestroy> matrix;
  Owned<KSP, KSPDestroy> solver;

  void wrap(const RowMatrix& A);
  void setModes(std::span<const double> modes);
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
void Multigrid::Impl::wrap(const RowMatrix& A) {
  using ranks::require;
  const auto at = [](const std::vector<int>& a) { return const_cast<PetscInt*>(a.data()); };
  require(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, A.size, A.size, at(A.offsets), at(A.column),
                                    const_cast<double*>(A.value.data()), matrix.fresh()),
          "matrix of a solid");
  require(MatSetBlockSize(matrix, 3), "matrix of a solid");
}

void Multigrid::Impl::setModes(std::span<const double> modes) {
  using ranks::require;
  constexpr const char* doing = "rigid motions of a solid";
  PetscInt size = 0;
  require(MatGetSize(matrix, &size, nullptr), doing);
  std::vector<Vec> raw;
  std::array<Owned<Vec, VecDestroy>, 6> basis;
  for (std::size_t k = 0; k < modes.size() / static_cast<std::size_t>(size); ++k) {
    require(VecCreateSeq(PETSC_COMM_SELF, size, basis[k].fresh()), doing);
    require(VecSetBlockSize(basis[k], 3), doing);
    PetscScalar* to = nullptr;
    require(VecGetArray(basis[k], &to), doing);
    std::copy_n(modes.begin() + static_cast<std::ptrdiff_t>(k) * size, size, to);
    require(VecRestoreArray(basis[k], &to), doing);
    for (const Vec other : raw) {
      PetscScalar along = 0.0;
      require(VecDot(basis[k], other, &along), doing);
      require(VecAXPY(basis[k], -along, other), doing);
    }
    require(VecNormalize(basis[k], nullptr), doing);
    raw.push_back(basis[k]);
  }
  Owned<MatNullSpace, MatNullSpaceDestroy> space;
  require(
      MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, static_cast<PetscInt>(raw.size()), raw.data(), space.fresh()),
      doing);
  require(MatSetNearNullSpace(matrix, space), doing);
}

/// By GMRES, for matrices that are not symmetric positive definite, or by conjugate gradients.
void Multigrid::Impl::minimiseResiduals(bool minimises) {
  using ranks::require;
  constexpr const char* doing = "multigrid of a solid";
  require(KSPSetType(solver, minimises ? KSPGMRES : KSPCG), doing);
  require(KSPSetPCSide(solver, minimises ? PC_RIGHT : PC_LEFT), doing);
  require(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED), doing);
  if (minimises) require(KSPGMRESSetRestart(solver, 60), doing);
}

bool Multigrid::Impl::isIndefinite() const {
  KSPConvergedReason reason{};
  ranks::require(KSPGetConvergedReason(solver, &reason), "multigrid of a solid");
  return reason == KSP_DIVERGED_INDEFINITE_MAT || reason == KSP_DIVERGED_INDEFINITE_PC;
}

void Multigrid::Impl::make() {
  using ranks::require;
  constexpr const char* doing = "multigrid of a solid";
  require(KSPCreate(PETSC_COMM_SELF, solver.fresh()), doing);
  require(KSPSetOptionsPrefix(solver, prefix), doing);
  PC pc = nullptr;
  require(KSPGetPC(solver, &pc), doing);
  require(PCSetType(pc, PCGAMG), doing);
  suggest("-dovetail_pc_gamg_agg_nsmooths", "1");
  suggest("-dovetail_mg_levels_pc_type", "jacobi");
  require(KSPSetFromOptions(solver), doing);
}

void Multigrid::take(const RowMatrix& A, std::size_t pattern, bool symmetric, std::span<const double> modes) {
  using ranks::require;
  constexpr const char* doing = "multigrid of a solid";
  Impl& m = *impl_;
  const bool same = m.solver && m.pattern == pattern && m.symmetric == symmetric;
  m.makesLevels = !same || m.cost > 1.5 * m.costAtFirst;
  if (same) {
    require(MatAssemblyBegin(m.matrix, MAT_FINAL_ASSEMBLY), doing);
    require(MatAssemblyEnd(m.matrix, MAT_FINAL_ASSEMBLY), doing);
  } else {
    m.symmetric = symmetric;
    m.pattern = pattern;
    m.make();
    m.wrap(A);
  }
  m.minimiseResiduals(!symmetric);
  require(MatSetOption(m.matrix, MAT_SPD, symmetric ? PETSC_TRUE : PETSC_FALSE), doing);
  if (m.makesLevels) m.setModes(modes);
  require(KSPSetOperators(m.solver, m.matrix, m.matrix), doing);
}

bool Multigrid::Impl::iterate(std::span<double> b, double tolerance) {
  using ranks::require;
  constexpr const char* doing = "multigrid of a solid";
  const auto size = static_cast<PetscInt>(b.size());
  Owned<Vec, VecDestroy> right, left;
  x.assign(b.size(), 0.0);
  require(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, size, b.data(), right.fresh()), doing);
  require(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, size, x.data(), left.fresh()), doing);
  require(KSPSetTolerances(solver, tolerance, 1e-300, 1e10, maxIterations), doing);
  require(KSPSetReusePreconditioner(solver, makesLevels ? PETSC_FALSE : PETSC_TRUE), doing);
  require(KSPSolve(solver, right, left), doing);
  require(KSPGetIterationNumber(solver, &last), doing);
  iterations += last;
  cost = last / -std::log10(tolerance);
  if (std::exchange(makesLevels, false)) ++setUps, costAtFirst = cost;
  KSPConvergedReason reason{};
  require(KSPGetConvergedReason(solver, &reason), doing);
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
