#include "dovetail/linalg/multifrontal_lu.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace dovetail::linalg {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

struct MultifrontalLu::Impl {
  struct Part {
    std::array<int, 2> node;
    std::size_t at;  // in values_, by columns
  };
  struct Front {
    std::vector<int> own, later;  // places in the order of elimination
    int parent = -1;
    std::vector<int> unknowns;  // own ones first
    Eigen::PartialPivLU<Eigen::MatrixXd> pivots;
    Eigen::MatrixXd lower, upper;  // L₂₁, U₁₂
    Eigen::MatrixXd left;          // for the parent, until that has it
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
  if (nodes > 0) Eigen::AMDOrdering<int>()(graph, found);
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
    if ((later + 1 - front.later.size()) * front.own.size() <= 4) return c;
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

bool MultifrontalLu::Impl::eliminate(Front& front, const std::vector<int>& children, const std::vector<int>& parts) {
  Eigen::Index own = 0;
  for (const std::vector<int>* places : {&front.own, &front.later}) {
    for (const int place : *places)
      for (int u = first_[at(order_[at(place)])]; u < first_[at(order_[at(place)]) + 1]; ++u) {
        local_[at(u)] = static_cast<int>(front.unknowns.size());
        front.unknowns.push_back(u);
      }
    if (places == &front.own) own = static_cast<Eigen::Index>(front.unknowns.size());
  }
  const auto all = static_cast<Eigen::Index>(front.unknowns.size()), rest = all - own;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(all, all);
  for (const int p : parts) {
    const auto part = matrixOf(parts_[at(p)]);
    forUnknowns(parts_[at(p)], [&](int c, int column) {
      forUnknowns(parts_[at(p)], [&](int r, int row) { dense(local_[at(row)], local_[at(column)]) += part(r, c); });
    });
  }
  for (const int child : children) {
    const Front& from = fronts_[at(child)];
    const int* const unknown = from.unknowns.data() + from.lower.cols();
    for (Eigen::Index c = 0; c < from.left.cols(); ++c)
      for (Eigen::Index r = 0; r < from.left.rows(); ++r)
        dense(local_[at(unknown[r])], local_[at(unknown[c])]) += from.left(r, c);
    fronts_[at(child)].left.resize(0, 0);
  }
  front.pivots.compute(dense.topLeftCorner(own, own));
  const auto& factors = front.pivots.matrixLU();
  if (!factors.allFinite() || (factors.diagonal().array() == 0.0).any()) return false;
  front.upper = front.pivots.permutationP() * dense.topRightCorner(own, rest);
  front.lower = dense.bottomLeftCorner(rest, own);
  if (rest == 0) return true;
  factors.triangularView<Eigen::UnitLower>().solveInPlace(front.upper);
  factors.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(front.lower);
  front.left = dense.bottomRightCorner(rest, rest);
  front.left.noalias() -= front.lower * front.upper;
  return true;
}

void MultifrontalLu::Impl::substitute(Eigen::MatrixXd& x) const {
  Eigen::MatrixXd own, later;
  const auto gather = [&x](Eigen::MatrixXd& to, const int* unknown, Eigen::Index rows) {
    to.resize(rows, x.cols());
    for (Eigen::Index r = 0; r < rows; ++r) to.row(r) = x.row(unknown[r]);
  };
  const auto scatter = [&x](const Eigen::MatrixXd& from, const int* unknown) {
    for (Eigen::Index r = 0; r < from.rows(); ++r) x.row(unknown[r]) = from.row(r);
  };
  for (const Front& front : fronts_) {
    const int* const unknown = front.unknowns.data();
    gather(own, unknown, front.lower.cols());
    own = front.pivots.permutationP() * own;
    front.pivots.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(own);
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
    front->pivots.matrixLU().triangularView<Eigen::Upper>().solveInPlace(own);
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
