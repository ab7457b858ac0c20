#include "dovetail/linalg/multifrontal_lu.hpp"

#include <Eigen/Core>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "dense_panel.hpp"

namespace dovetail::linalg {

namespace {

using Eigen::Index;

constexpr Index panelWidth = 16;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A dense matrix by columns, whose first `own` unknowns are eliminated.
struct DenseFront {
  double* values;
  Index size, own;
  double* column(Index c) const { return values + c * size; }
  detail::Panel part(Index row, Index column, Index rows, Index columns) const {
    const auto unsignedOf = [](Index n) { return static_cast<std::size_t>(n); };
    return {values + column * size + row, unsignedOf(size), unsignedOf(rows), unsignedOf(columns)};
  }
};

/// Columns c … c + count − 1 behind the panel of columns first … end − 1: U₁₂ = L₁₁⁻¹ A₁₂, and A₂₂ − L₂₁ U₁₂ below.
template <int count>
[[gnu::always_inline]] inline void subtractPanel(const DenseFront& front, Index first, Index end, Index c) {
  const detail::Vectors<count> entry{front.column(c), static_cast<std::size_t>(front.size)};
  for (Index k = first; k + 1 < end; ++k)
    detail::panel::subtractColumns<1>(front.part(k + 1, k, end - k - 1, 1), 0, entry.from(static_cast<std::size_t>(k)),
                                      entry.from(static_cast<std::size_t>(k) + 1));
  detail::panel::subtractProduct(front.part(end, first, front.size - end, end - first),
                                 entry.from(static_cast<std::size_t>(first)),
                                 entry.from(static_cast<std::size_t>(end)));
}

/// Moves the largest entry of column k among the own rows to the diagonal. @return the row that it was in, −1 if there
/// is none but zeros, or one that is not finite
[[gnu::always_inline]] inline Index pivot(const DenseFront& front, Index k) {
  const double* const column = front.column(k);
  Index best = k;
  for (Index r = k + 1; r < front.own; ++r)
    if (!(std::abs(column[r]) <= std::abs(column[best]))) best = r;
  if (column[best] == 0.0 || !std::isfinite(column[best])) return -1;
  if (best != k)
    for (Index c = 0; c < front.size; ++c) std::swap(front.column(c)[k], front.column(c)[best]);
  return best;
}

/// P A = L U of the own unknowns, L₂₁ and U₁₂ in their places, and what is left of the others in theirs.
/// @param swaps  the row that each own one was exchanged with @return false if a pivot is zero
bool eliminateOwn(const DenseFront& front, int* swaps) {
  constexpr int together = 4;
  for (Index first = 0; first < front.own; first += panelWidth) {
    const Index end = std::min(first + panelWidth, front.own);
    for (Index k = first; k < end; ++k) {
      const Index from = pivot(front, k);
      if (from < 0) return false;
      swaps[k] = static_cast<int>(from);
      double* const lower = front.column(k);
      for (Index r = k + 1; r < front.size; ++r) lower[r] /= lower[k];
      for (Index c = k + 1; c < end; ++c) subtractPanel<1>(front, k, k + 1, c);
    }
    Index c = end;
    for (; c + together <= front.size; c += together) subtractPanel<together>(front, first, end, c);
    for (; c < front.size; ++c) subtractPanel<1>(front, first, end, c);
  }
  return true;
}

}  // namespace

struct MultifrontalLu::Impl {
  struct Part {
    std::array<int, 2> node;
    std::size_t at;  // in values_, by columns
  };
  struct Front {
    std::vector<int> own, later;  // places in the order of elimination
    int parent = -1;
    std::vector<int> unknowns;               // own ones first
    std::vector<int> swaps;                  // of own rows, one after the other
    Eigen::MatrixXd diagonal, lower, upper;  // L₁₁ and U₁₁, L₂₁, U₁₂
    Eigen::MatrixXd left;                    // what the parent takes, behind what was eliminated
    Index eliminated() const { return static_cast<Index>(swaps.size()); }
  };

  int size() const { return first_.back(); }
  int sizeOf(int node) const { return node < 0 ? 0 : first_[at(node) + 1] - first_[at(node)]; }
  Eigen::Map<const Eigen::MatrixXd> matrixOf(const Part& part) const;
  template <class Visit>
  void forUnknowns(const Part& part, const Visit& visit) const;
  bool factor();
  void chooseOrder();
  void makeFronts();
  int frontThatTakes(const std::vector<int>& children, std::size_t later) const;
  void sortFronts();
  void addLeft(Front& from, Eigen::MatrixXd& dense);
  bool eliminate(Front& front, const std::vector<int>& children, const std::vector<int>& parts);
  void substitute(Eigen::MatrixXd& x) const;

  std::vector<int> first_;
  int last_;
  std::vector<Part> parts_;
  std::vector<double> values_;
  std::vector<int> order_, place_;  // node at a place of the order, and back
  std::vector<Front> fronts_;       // children before parents
  std::vector<int> local_;          // by unknown: where it is in the front at hand
};

MultifrontalLu::MultifrontalLu(std::vector<int> first, int last)
    : impl_(std::make_unique<Impl>(Impl{std::move(first), last, {}, {}, {}, {}, {}, {}})) {}
MultifrontalLu::~MultifrontalLu() = default;
MultifrontalLu::MultifrontalLu(MultifrontalLu&&) noexcept = default;
MultifrontalLu& MultifrontalLu::operator=(MultifrontalLu&&) noexcept = default;

void MultifrontalLu::add(int a, int b, std::span<const double> part) {
  impl_->parts_.push_back({{a, b}, impl_->values_.size()});
  impl_->values_.insert(impl_->values_.end(), part.begin(), part.end());
}

Eigen::Map<const Eigen::MatrixXd> MultifrontalLu::Impl::matrixOf(const Part& part) const {
  const int n = sizeOf(part.node[0]) + sizeOf(part.node[1]);
  return {values_.data() + part.at, n, n};
}

/// visit(row of the part, unknown).
template <class Visit>
void MultifrontalLu::Impl::forUnknowns(const Part& part, const Visit& visit) const {
  int row = 0;
  for (const int node : part.node)
    for (int k = 0; k < sizeOf(node); ++k) visit(row++, first_[at(node)] + k);
}

bool MultifrontalLu::factor() { return impl_->factor(); }

bool MultifrontalLu::Impl::factor() {
  chooseOrder();
  makeFronts();
  std::vector<std::vector<int>> children(fronts_.size()), parts(fronts_.size());
  std::vector<std::size_t> frontOf(order_.size());
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    for (const int place : fronts_[f].own) frontOf[at(place)] = f;
    if (fronts_[f].parent >= 0) children[at(fronts_[f].parent)].push_back(static_cast<int>(f));
  }
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const auto [a, b] = parts_[p].node;
    const int earlier = b < 0 ? place_[at(a)] : std::min(place_[at(a)], place_[at(b)]);
    parts[frontOf[at(earlier)]].push_back(static_cast<int>(p));
  }
  local_.assign(at(size()), 0);
  for (std::size_t f = 0; f < fronts_.size(); ++f)
    if (!eliminate(fronts_[f], children[f], parts[f])) return false;
  return true;
}

void MultifrontalLu::Impl::chooseOrder() {
  const int nodes = static_cast<int>(first_.size()) - 1;
  if (nodes == 0) return;
  std::vector<Eigen::Triplet<double>> pairs;
  for (const Part& part : parts_) {
    const auto [a, b] = part.node;
    if (b < 0 || a == b || a == last_ || b == last_) continue;
    pairs.emplace_back(a, b, 1.0);
    pairs.emplace_back(b, a, 1.0);
  }
  Eigen::SparseMatrix<double> graph(nodes, nodes);
  graph.setFromTriplets(pairs.begin(), pairs.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> found;
  Eigen::AMDOrdering<int>()(graph, found);
  order_.assign(found.indices().data(), found.indices().data() + nodes);
  if (last_ >= 0) {
    order_.erase(std::find(order_.begin(), order_.end(), last_));
    order_.push_back(last_);
  }
  place_.resize(at(nodes));
  for (int p = 0; p < nodes; ++p) place_[at(order_[at(p)])] = p;
}

void MultifrontalLu::Impl::makeFronts() {
  const std::size_t nodes = order_.size();
  std::vector<std::vector<int>> later(nodes), children(nodes);
  for (const Part& part : parts_) {
    if (part.node[1] < 0 || part.node[0] == part.node[1]) continue;
    const int a = place_[at(part.node[0])], b = place_[at(part.node[1])];
    later[at(std::min(a, b))].push_back(std::max(a, b));
  }
  fronts_.clear();
  for (std::size_t p = 0; p < nodes; ++p) {
    std::vector<int>& reached = later[p];
    for (const int c : children[p])
      reached.insert(reached.end(), fronts_[at(c)].later.begin() + 1, fronts_[at(c)].later.end());
    std::sort(reached.begin(), reached.end());
    reached.erase(std::unique(reached.begin(), reached.end()), reached.end());
    int front = frontThatTakes(children[p], reached.size());
    if (front < 0) {
      front = static_cast<int>(fronts_.size());
      fronts_.emplace_back();
    }
    for (const int c : children[p])
      if (c != front) fronts_[at(c)].parent = front;
    fronts_[at(front)].own.push_back(static_cast<int>(p));
    if (!reached.empty()) children[at(reached.front())].push_back(front);
    fronts_[at(front)].later = std::move(reached);
  }
  sortFronts();
}

/// The child that takes the next place in, if that adds few zeros; else −1.
int MultifrontalLu::Impl::frontThatTakes(const std::vector<int>& children, std::size_t later) const {
  for (const int c : children) {
    const Front& front = fronts_[at(c)];
    if ((later + 1 - front.later.size()) * front.own.size() <= 8) return c;
  }
  return -1;
}

void MultifrontalLu::Impl::sortFronts() {
  std::vector<int> sequence(fronts_.size()), rank(fronts_.size());
  std::iota(sequence.begin(), sequence.end(), 0);
  std::sort(sequence.begin(), sequence.end(),
            [&](int a, int b) { return fronts_[at(a)].own.back() < fronts_[at(b)].own.back(); });
  std::vector<Front> sorted;
  for (const int f : sequence) {
    rank[at(f)] = static_cast<int>(sorted.size());
    sorted.push_back(std::move(fronts_[at(f)]));
  }
  for (Front& front : sorted)
    if (front.parent >= 0) front.parent = rank[at(front.parent)];
  fronts_ = std::move(sorted);
}

/// To the front at hand. Unknowns of both stand in the order of elimination: most of them side by side.
void MultifrontalLu::Impl::addLeft(Front& from, Eigen::MatrixXd& dense) {
  struct Run {
    Index from, to, count;
  };
  std::vector<Run> runs;
  const auto count = static_cast<Index>(from.unknowns.size());
  const auto place = [&](Index k) -> Index { return local_[at(from.unknowns[static_cast<std::size_t>(k)])]; };
  for (Index k = from.eliminated(); k < count; ++k)
    if (runs.empty() || place(k) != runs.back().to + runs.back().count)
      runs.push_back({k, place(k), 1});
    else
      ++runs.back().count;
  for (Index c = from.eliminated(); c < count; ++c) {
    const double* const left = from.left.col(c).data();
    double* const to = dense.col(place(c)).data();
    for (const Run& run : runs)
      for (Index k = 0; k < run.count; ++k) to[run.to + k] += left[run.from + k];
  }
  from.left.resize(0, 0);
}

bool MultifrontalLu::Impl::eliminate(Front& front, const std::vector<int>& children, const std::vector<int>& parts) {
  Index own = 0;
  for (const std::vector<int>* places : {&front.own, &front.later}) {
    for (const int place : *places)
      for (int u = first_[at(order_[at(place)])]; u < first_[at(order_[at(place)]) + 1]; ++u) {
        local_[at(u)] = static_cast<int>(front.unknowns.size());
        front.unknowns.push_back(u);
      }
    if (places == &front.own) own = static_cast<Index>(front.unknowns.size());
  }
  const auto all = static_cast<Index>(front.unknowns.size()), rest = all - own;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(all, all);
  for (const int p : parts) {
    const auto part = matrixOf(parts_[at(p)]);
    forUnknowns(parts_[at(p)], [&](int c, int column) {
      forUnknowns(parts_[at(p)], [&](int r, int row) { dense(local_[at(row)], local_[at(column)]) += part(r, c); });
    });
  }
  for (const int child : children) addLeft(fronts_[at(child)], dense);
  front.swaps.resize(static_cast<std::size_t>(own));
  bool done = false;
  withVectors([&] { done = eliminateOwn({dense.data(), all, own}, front.swaps.data()); });
  if (!done) return false;
  front.diagonal = dense.topLeftCorner(own, own);
  front.lower = dense.bottomLeftCorner(rest, own);
  front.upper = dense.topRightCorner(own, rest);
  if (rest > 0) front.left = std::move(dense);
  return true;
}

void MultifrontalLu::Impl::substitute(Eigen::MatrixXd& x) const {
  Eigen::MatrixXd own, later;
  const auto gather = [&x](Eigen::MatrixXd& to, const int* unknown, Index rows) {
    to.resize(rows, x.cols());
    for (Index r = 0; r < rows; ++r) to.row(r) = x.row(unknown[r]);
  };
  const auto scatter = [&x](const Eigen::MatrixXd& from, const int* unknown) {
    for (Index r = 0; r < from.rows(); ++r) x.row(unknown[r]) = from.row(r);
  };
  for (const Front& front : fronts_) {
    const int* const unknown = front.unknowns.data();
    gather(own, unknown, front.lower.cols());
    for (Index k = 0; k < own.rows(); ++k) own.row(k).swap(own.row(front.swaps[static_cast<std::size_t>(k)]));
    front.diagonal.triangularView<Eigen::UnitLower>().solveInPlace(own);
    scatter(own, unknown);
    gather(later, unknown + own.rows(), front.lower.rows());
    later.noalias() -= front.lower * own;
    scatter(later, unknown + own.rows());
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    const int* const unknown = front->unknowns.data();
    gather(own, unknown, front->lower.cols());
    gather(later, unknown + own.rows(), front->lower.rows());
    own.noalias() -= front->upper * later;
    front->diagonal.triangularView<Eigen::Upper>().solveInPlace(own);
    scatter(own, unknown);
  }
}

bool MultifrontalLu::solve(std::span<double> b, int columns) const {
  const Impl& m = *impl_;
  Eigen::Map<Eigen::MatrixXd> solution(b.data(), m.size(), columns);
  const Eigen::MatrixXd rightSide = solution;
  Eigen::MatrixXd x = rightSide;
  m.substitute(x);
  double error = 0.0;
  for (int refinement = 0; refinement < 4; ++refinement) {
    // Componentwise backward error (Oettli and Prager).
    Eigen::MatrixXd residual = rightSide, size = rightSide.cwiseAbs();
    // A row that is to make nothing of next to nothing is compared with what the largest unknown would make there.
    const Eigen::RowVectorXd little = 1e-6 * x.cwiseAbs().colwise().maxCoeff();
    for (const Impl::Part& part : m.parts_) {
      const auto matrix = m.matrixOf(part);
      m.forUnknowns(part, [&](int c, int column) {
        m.forUnknowns(part, [&](int r, int row) {
          residual.row(row) -= matrix(r, c) * x.row(column);
          size.row(row) += std::abs(matrix(r, c)) * x.row(column).cwiseAbs().cwiseMax(little);
        });
      });
    }
    error = (residual.array().abs() > 0.0).select(residual.array().abs() / size.array(), 0.0).maxCoeff();
    if (error < 1e-14) break;
    m.substitute(residual);
    x += residual;
  }
  solution = x;
  return error < 1e-8;
}

}  // namespace dovetail::linalg
