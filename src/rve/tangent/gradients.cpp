#include "gradients.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/vector_code.hpp"

namespace dovetail::rve {

namespace {

constexpr std::size_t perNode = BlockGradients::perNode, columns = BlockGradients::columns;
using Lanes = std::array<std::array<double, columns>, perNode>;
using Field = std::vector<Lanes>;
using Sums = std::array<double, columns>;
using Square = Eigen::Matrix<double, BlockGradients::perNode, BlockGradients::perNode>;

/// y ← y + f A x, or Aᵀ x.
template <bool transposed>
[[gnu::always_inline]] inline void addProduct(double f, const double* __restrict block, const Lanes& x, Lanes& y) {
  for (std::size_t r = 0; r < perNode; ++r)
    for (std::size_t c = 0; c < perNode; ++c) {
      const double a = f * block[transposed ? perNode * c + r : perNode * r + c];
      for (std::size_t l = 0; l < columns; ++l) y[r][l] += a * x[c][l];
    }
}

Sums innerProducts(const Field& a, const Field& b) {
  Sums sum{};
  withVectors([&] {
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t r = 0; r < perNode; ++r)
        for (std::size_t l = 0; l < columns; ++l) sum[l] += a[i][r][l] * b[i][r][l];
  });
  return sum;
}

/// a ← f a + g b, column by column.
void combine(Field& a, const Sums& f, const Field& b, const Sums& g) {
  withVectors([&] {
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t r = 0; r < perNode; ++r)
        for (std::size_t l = 0; l < columns; ++l) a[i][r][l] = f[l] * a[i][r][l] + g[l] * b[i][r][l];
  });
}

constexpr Sums allOf(double value) {
  Sums sums{};
  sums.fill(value);
  return sums;
}
constexpr Sums ones = allOf(1.0);

/// a/b where there is something to divide.
Sums ratio(const Sums& a, const Sums& b, double sign = 1.0) {
  Sums quotient{};
  for (std::size_t l = 0; l < columns; ++l) quotient[l] = a[l] != 0.0 ? sign * a[l] / b[l] : 0.0;
  return quotient;
}

}  // namespace

BlockGradients::BlockGradients(const std::vector<Block>& diagonal, const std::vector<Pair>& pairs)
    : root_(diagonal.size()),
      off_(diagonal.size()),
      first_(diagonal.size() + 1, 0),
      other_(pairs.size()),
      lower_(pairs.size()),
      upper_(pairs.size()) {
  for (std::size_t i = 0; i < diagonal.size(); ++i) takeRoot(i, diagonal[i]);
  for (const Pair& pair : pairs) ++first_[static_cast<std::size_t>(pair.row) + 1];
  for (std::size_t i = 0; i < diagonal.size(); ++i) first_[i + 1] += first_[i];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (const Pair& pair : pairs) {
    const auto i = static_cast<std::size_t>(pair.row), j = static_cast<std::size_t>(pair.column);
    const auto at = static_cast<std::size_t>(next[i]++);
    other_[at] = pair.column;
    Eigen::Map<Block>(lower_[at].data()) = root_[i] * pair.lower * root_[j].transpose();
    Eigen::Map<Block>(upper_[at].data()) = root_[j] * pair.upper * root_[i].transpose();
  }
}

void BlockGradients::takeRoot(std::size_t node, const Block& whole) {
  const Square symmetric = 0.5 * (whole + whole.transpose());
  const Eigen::LLT<Square> factor(symmetric);
  const auto pivots = factor.matrixLLT().diagonal().array().square();
  if (factor.info() == Eigen::Success && pivots.minCoeff() > 1e-6 * pivots.maxCoeff()) {
    root_[node] = factor.matrixL().solve(Block::Identity());
  } else {  // grains that few touch are held by their neighbours only
    const Eigen::SelfAdjointEigenSolver<Square> solver(symmetric);
    const double least = std::max(1e-2 * solver.eigenvalues().maxCoeff(), std::numeric_limits<double>::min());
    root_[node] =
        solver.eigenvalues().array().max(least).rsqrt().matrix().asDiagonal() * solver.eigenvectors().transpose();
  }
  Eigen::Map<Block>(off_[node].data()) = root_[node] * whole * root_[node].transpose() - Block::Identity();
}

/// (1 + L) to = from; transposed: (1 + Uᵀ) to = from.
template <BlockGradients::Use use>
void BlockGradients::down(const Field& from, Field& to) const {
  constexpr bool transposed = use == Use::transposed;
  const std::vector<Numbers>& blocks = transposed ? upper_ : lower_;
  withVectors([&] {
    for (std::size_t i = 0; i < from.size(); ++i) {
      Lanes sum = from[i];
      for (int e = first_[i]; e < first_[i + 1]; ++e) {
        const auto at = static_cast<std::size_t>(e);
        addProduct<transposed>(-1.0, blocks[at].data(), to[static_cast<std::size_t>(other_[at])], sum);
      }
      to[i] = sum;
    }
  });
}

/// (1 + U) to = from; transposed: (1 + Lᵀ) to = from.
template <BlockGradients::Use use>
void BlockGradients::up(const Field& from, Field& to) const {
  constexpr bool transposed = use == Use::transposed;
  const std::vector<Numbers>& blocks = transposed ? lower_ : upper_;
  withVectors([&] {
    to = from;
    for (std::size_t i = from.size(); i-- > 0;)
      for (int e = first_[i]; e < first_[i + 1]; ++e) {
        const auto at = static_cast<std::size_t>(e);
        addProduct<transposed>(-1.0, blocks[at].data(), to[i], to[static_cast<std::size_t>(other_[at])]);
      }
  });
}

/// With K = 1 + O + L + U the preconditioned matrix is (1 + L)⁻¹ K (1 + U)⁻¹, and its product with p is t + (1 + L)⁻¹
/// (p − t + O t), t = (1 + U)⁻¹ p.
template <BlockGradients::Use use>
void BlockGradients::product(const Field& way, Field& work, Field& image) const {
  up<use>(way, work);
  withVectors([&] {
    for (std::size_t i = 0; i < way.size(); ++i) {
      for (std::size_t r = 0; r < perNode; ++r)
        for (std::size_t l = 0; l < columns; ++l) image[i][r][l] = way[i][r][l] - work[i][r][l];
      addProduct<use == Use::transposed>(1.0, off_[i].data(), work[i], image[i]);
    }
  });
  down<use>(image, image);
  combine(image, ones, work, ones);
}

BlockGradients::Field BlockGradients::scaled(const Eigen::MatrixXd& b) const {
  Field field(root_.size(), Lanes{});
  for (std::size_t i = 0; i < field.size(); ++i) {
    const Eigen::MatrixXd part = root_[i] * b.middleRows<perNode>(static_cast<Eigen::Index>(perNode * i));
    for (std::size_t r = 0; r < perNode; ++r)
      for (Eigen::Index c = 0; c < b.cols(); ++c)
        field[i][r][static_cast<std::size_t>(c)] = part(static_cast<Eigen::Index>(r), c);
  }
  return field;
}

void BlockGradients::unscaled(const Field& x, Eigen::MatrixXd& b) const {
  Eigen::Matrix<double, perNode, Eigen::Dynamic> part(static_cast<Eigen::Index>(perNode), b.cols());
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t r = 0; r < perNode; ++r)
      for (Eigen::Index c = 0; c < b.cols(); ++c)
        part(static_cast<Eigen::Index>(r), c) = x[i][r][static_cast<std::size_t>(c)];
    b.middleRows<perNode>(static_cast<Eigen::Index>(perNode * i)) = root_[i].transpose() * part;
  }
}

bool BlockGradients::solve(Eigen::MatrixXd& b, Eigen::MatrixXd& g, double tolerance, int iterations) const {
  const std::size_t n = root_.size();
  Field rest = scaled(b), restToo = scaled(g), x(n, Lanes{}), y = x, work(n), image(n), imageToo(n);
  down<Use::plain>(rest, rest);
  down<Use::transposed>(restToo, restToo);
  Field way = rest, wayToo = restToo;
  const auto size2 = [&] {
    Sums both = innerProducts(rest, rest);
    const Sums other = innerProducts(restToo, restToo);
    for (std::size_t l = 0; l < columns; ++l) both[l] = std::sqrt(both[l] * other[l]);
    return both;
  };
  const Sums start = size2();
  const auto isThere = [&](const Sums& now) {
    for (std::size_t l = 0; l < columns; ++l)
      if (!(now[l] <= tolerance * tolerance * start[l])) return false;
    return true;
  };
  Sums both = innerProducts(restToo, rest);
  for (int k = 0; !isThere(size2()); ++k) {
    if (k == iterations) return false;
    product<Use::plain>(way, work, image);
    product<Use::transposed>(wayToo, work, imageToo);
    const Sums curvature = innerProducts(wayToo, image), step = ratio(both, curvature),
               back = ratio(both, curvature, -1.0);
    combine(x, ones, way, step);
    combine(y, ones, wayToo, step);
    combine(rest, ones, image, back);
    combine(restToo, ones, imageToo, back);
    const Sums now = innerProducts(restToo, rest), keep = ratio(now, both);
    combine(way, keep, rest, ones);
    combine(wayToo, keep, restToo, ones);
    both = now;
  }
  up<Use::plain>(x, work);
  unscaled(work, b);
  up<Use::transposed>(y, work);
  unscaled(work, g);
  return true;
}

}  // namespace dovetail::rve
