#include "dovetail/fem/solve/linear_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "dovetail/core/error.hpp"
#include "node_rows.hpp"
#include "rank_rows.hpp"

namespace dovetail::fem {

namespace {

enum class Kind { none, definite, lu, multigrid };

/// Unknowns from which factors of solids are taken for too large without a look.
constexpr int tooManyForFactors = 1'000'000;

}  // namespace

struct LinearSolver::Impl {
  ReducedMatrix reduced;
  linalg::LinearOptions options;
  const Nodes* nodes;
  linalg::DefiniteSolver definite;
  linalg::SparseLu lu{};
  std::shared_ptr<detail::NodeRows> rows{};    // of multigrid, which is taken if they are there
  std::optional<detail::RankRows> rankRows{};  // instead, where ranks share the elements
  std::optional<linalg::Multigrid> multigrid{};
  std::size_t chosenFor = 0;  // pattern
  bool chosenSymmetric = true;
  Kind kind = Kind::none;
  bool wasIndefinite = false;
  int negative = -1;
  double largestDiagonal = 0.0;
  std::int64_t factorisations = 0, solves = 0;

  linalg::LinearForecast forecastDirect(const linalg::BlockMatrix& K, bool symmetric) {
    const linalg::LinearForecast forecast = definite.analyse(reduced.update(K, true));
    if (symmetric) return forecast;
    // L and U, and fronts that pivoting may widen.
    return {linalg::LinearMethod::direct, 3.0 * forecast.bytes, 2.0 * forecast.operations, forecast.factors};
  }
  /// Of the rows and of levels and products that make them, measured on boxes of 47³ to 100³ bricks.
  linalg::LinearForecast forecastMultigrid(const linalg::BlockMatrix& K) const {
    const double entries = 9.0 * static_cast<double>(K.columns().size());
    return {linalg::LinearMethod::multigrid, 25.0 * entries, 100.0 * 8.0 * entries, 0.0};
  }
  linalg::LinearForecast forecast(const linalg::BlockMatrix& K, bool symmetric) {
    if (K.isPart()) return forecastMultigrid(K);  // of this rank
    const bool may = nodes && linalg::Multigrid::available();
    if (options.method == linalg::LinearMethod::multigrid && nodes) return forecastMultigrid(K);
    const bool automatic = options.method == linalg::LinearMethod::automatic;
    if (automatic && may && reduced.dofs().size() > tooManyForFactors) return forecastMultigrid(K);
    linalg::LinearForecast forecast = forecastDirect(K, symmetric);
    if (!automatic || !may || forecast.factors * (symmetric ? 1.0 : 3.0) <= options.largestFactors) return forecast;
    const double factors = forecast.factors;
    forecast = forecastMultigrid(K);
    forecast.factors = factors;
    return forecast;
  }
  /// Between multigrid and the others, once for each pattern.
  bool choosesMultigrid(const linalg::BlockMatrix& K, bool symmetric) {
    if (chosenFor == K.patternId() && chosenSymmetric == symmetric) return rows != nullptr;
    chosenFor = K.patternId();
    chosenSymmetric = symmetric;
    const bool asked = options.method == linalg::LinearMethod::multigrid ||
                       (options.method == linalg::LinearMethod::automatic && linalg::Multigrid::available());
    const bool takes = nodes && asked && forecast(K, symmetric).method == linalg::LinearMethod::multigrid;
    if (!takes) {
      rows.reset();
      multigrid.reset();
    } else if (!rows) {
      chooseMultigrid(std::make_shared<detail::NodeRows>(reduced.dofs()));
    }
    return takes;
  }
  void chooseMultigrid(std::shared_ptr<detail::NodeRows> taken) {
    reduced = ReducedMatrix(reduced.dofs());
    rows = std::move(taken);
    multigrid.emplace(options.relativeTolerance, options.maxIterations);
  }
  /// Where ranks share the elements there is no choice.
  bool takeParts(const linalg::BlockMatrix& K, bool symmetric) {
    if (nodes == nullptr)
      throw InputError("elements are shared by ranks", "linear solver", "this is solved by one process only");
    if (options.method != linalg::LinearMethod::automatic && options.method != linalg::LinearMethod::multigrid)
      throw InputError("elements are shared by ranks, and the linear solver is not multigrid", "linear solver",
                       "take multigrid, or one process");
    if (!rankRows) {
      rankRows.emplace(reduced.dofs());
      multigrid.emplace(options.relativeTolerance, options.maxIterations);
    }
    rankRows->update(K);
    largestDiagonal = rankRows->largestDiagonal();
    if (!rankRows->isFinite()) return false;
    multigrid->take(rankRows->matrix(), rankRows->patternId(), symmetric,
                    detail::rigidModes(*nodes, reduced.dofs(), rankRows->nodes()));
    kind = Kind::multigrid;
    negative = -1;
    return true;
  }
  bool takeRows() {
    linalg::RowMatrix& A = rows->matrix();
    largestDiagonal = rows->largestDiagonal();
    if (!std::ranges::all_of(A.value, [](double v) { return std::isfinite(v); })) return false;
    std::vector<int> all(nodes->X.size());
    std::iota(all.begin(), all.end(), 0);
    multigrid->take(A, rows->patternId(), rows->symmetric(), detail::rigidModes(*nodes, reduced.dofs(), all));
    kind = Kind::multigrid;
    negative = -1;
    return true;
  }
  void iterate(std::span<double> x, double loosest) {
    const auto by = [&](const auto& taken) {
      std::vector<double> values = taken.expanded(x);
      multigrid->solve(values, loosest);
      taken.gather(values, x);
    };
    rankRows ? by(*rankRows) : by(*rows);
  }

  /// A matrix that follows an indefinite one is taken for indefinite too: a failed Cholesky factorisation may cost as
  /// much as one that succeeds.
  bool factorSymmetric(const linalg::SparseMatrix& A) {
    if (!wasIndefinite && definite.factor(A)) {
      kind = Kind::definite;
      negative = definite.iterates() ? -1 : 0;
      return true;
    }
    if (definite.iterates() || !factorLu(A, true)) return false;
    wasIndefinite = negative != 0;
    return true;
  }
  bool factorLu(const linalg::SparseMatrix& A, bool symmetric) {
    if (!lu.factor(A, symmetric)) return false;
    kind = Kind::lu;
    negative = lu.negativePivots();
    return true;
  }
};

LinearSolver::LinearSolver(const DofMap& dofs, const linalg::LinearOptions& options, const Nodes* nodes)
    : impl_(std::make_unique<Impl>(Impl{ReducedMatrix(dofs), options, nodes, linalg::DefiniteSolver(options)})) {
  if (options.method == linalg::LinearMethod::multigrid) linalg::Multigrid::require("linear solver");
}
LinearSolver::~LinearSolver() = default;
LinearSolver::LinearSolver(LinearSolver&&) noexcept = default;

linalg::LinearForecast LinearSolver::forecast(const linalg::BlockMatrix& K, bool symmetric) {
  return impl_->forecast(K, symmetric);
}

bool LinearSolver::factor(const linalg::BlockMatrix& K, bool symmetric) {
  Impl& m = *impl_;
  m.kind = Kind::none;
  ++m.factorisations;
  m.largestDiagonal = 0.0;
  if (K.isPart()) return m.takeParts(K, symmetric);
  if (m.choosesMultigrid(K, symmetric)) {
    m.rows->update(K, symmetric);
    return m.takeRows();
  }
  const linalg::SparseMatrix& A = m.reduced.update(K, symmetric);
  for (std::size_t column = 0; column < static_cast<std::size_t>(A.size); ++column)
    for (int k = A.offsets[column]; k < A.offsets[column + 1]; ++k)
      if (A.row[static_cast<std::size_t>(k)] == static_cast<int>(column))
        m.largestDiagonal = std::max(m.largestDiagonal, std::abs(A.value[static_cast<std::size_t>(k)]));
  if (!std::all_of(A.value.begin(), A.value.end(), [](double v) { return std::isfinite(v); })) return false;
  if (A.size == 0) return m.kind = Kind::definite, true;
  return symmetric ? m.factorSymmetric(A) : m.factorLu(A, false);
}

void LinearSolver::solve(std::span<const double> r, std::span<double> x, double loosest) {
  Impl& m = *impl_;
  ++m.solves;
  if (r.empty()) return;
  if (m.kind == Kind::none) throw InputError("there is no factorisation", "LinearSolver::solve", "call factor() first");
  if (x.data() != r.data()) std::copy(r.begin(), r.end(), x.begin());
  switch (m.kind) {
    case Kind::lu:
      return m.lu.solve(x);
    case Kind::multigrid:
      return m.iterate(x, loosest);
    default:
      return m.definite.solve(x);
  }
}

void LinearSolver::save(ByteWriter& archive) const {
  const Impl& m = *impl_;
  const Kind kind = m.rankRows ? Kind::none : m.kind;  // rows of ranks are made anew
  archive(static_cast<int>(kind), m.wasIndefinite);
  if (kind == Kind::multigrid)
    m.rows->save(archive);
  else if (kind != Kind::none)
    m.reduced.save(archive);
}

LinearSolver::Factored LinearSolver::read(ByteReader& archive, const linalg::BlockMatrix& K) const {
  Factored state{0, false, ReducedMatrix(impl_->reduced.dofs()), nullptr};
  archive(state.kind, state.wasIndefinite);
  const bool rows = state.kind == static_cast<int>(Kind::multigrid);
  if (state.kind < 0 || state.kind > static_cast<int>(Kind::multigrid))
    throw InputError("a kind of factors has the number " + std::to_string(state.kind), "LinearSolver",
                     "load it into the run that saved it");
  if (K.isPart() && state.kind != static_cast<int>(Kind::none)) {  // what one process has factorised is made anew
    bool symmetric = false;
    std::vector<double> values;
    archive(symmetric, values);
    state.kind = static_cast<int>(Kind::none);
    return state;
  }
  if (rows && !linalg::Multigrid::available())
    throw InputError("the state was saved by a run with multigrid, which this build has not", "LinearSolver",
                     "load it by a build with -D DOVETAIL_RANKS=ON");
  if (rows) {
    state.rows = std::make_shared<detail::NodeRows>(impl_->reduced.dofs());
    state.rows->load(archive, K);
  } else if (state.kind != static_cast<int>(Kind::none)) {
    state.matrix.load(archive, K);
  }
  return state;
}

void LinearSolver::adopt(Factored state) {
  Impl& m = *impl_;
  m.kind = Kind::none;
  m.wasIndefinite = state.wasIndefinite;
  if (state.kind == static_cast<int>(Kind::none)) return;
  if (state.rows) {
    m.chooseMultigrid(std::move(state.rows));
    m.takeRows();
    return;
  }
  m.reduced = std::move(state.matrix);
  const linalg::SparseMatrix& A = m.reduced.matrix();
  if (A.size == 0)
    m.kind = Kind::definite;
  else if (state.kind == static_cast<int>(Kind::lu))
    m.factorLu(A, m.reduced.symmetric());
  else if (m.definite.factor(A))
    m.kind = Kind::definite;
}

bool LinearSolver::factored() const { return impl_->kind != Kind::none; }
bool LinearSolver::iterates() const { return impl_->definite.iterates() || hasMultigrid(); }
bool LinearSolver::hasMultigrid() const { return impl_->rows != nullptr || impl_->rankRows.has_value(); }
void LinearSolver::drop() { impl_->kind = Kind::none; }
int LinearSolver::negativePivots() const { return impl_->negative; }
double LinearSolver::largestDiagonal() const { return impl_->largestDiagonal; }
std::int64_t LinearSolver::factorisations() const { return impl_->factorisations; }
std::int64_t LinearSolver::solves() const { return impl_->solves; }
std::int64_t LinearSolver::iterations() const { return impl_->multigrid ? impl_->multigrid->iterations() : 0; }
std::string LinearSolver::method() const {
  if (impl_->kind == Kind::multigrid) return "multigrid";
  if (impl_->kind == Kind::lu) return linalg::SparseLu::name();
  if (impl_->kind == Kind::none) return "none";
  return impl_->definite.iterates() ? "conjugate gradients" : linalg::SparseCholesky::name();
}

}  // namespace dovetail::fem
