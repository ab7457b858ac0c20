#include "gradients.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/vector_code.hpp"

namespace dovetail::rve {

namespace {

constexpr std::size_t perNode = perSphere, columns = BlockGradients::columns;
using Lanes = std::array<std::array<double, columns>, perNode>;
using Field = std::vector<Lanes>;
using Sums = std::array<double, columns>;

/// y ← y − A x.
[[gnu::always_inline]] inline void subtractProduct(const double* __restrict block, const Lanes& x, Lanes& y) {
  for (std::size_t c = 0; c < perNode; ++c)
    for (std::size_t r = 0; r < perNode; ++r)
      for (std::size_t l = 0; l < columns; ++l) y[r][l] -= block[perNode * c + r] * x[c][l];
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

BlockGradients::BlockGradients(const SphereRows& rows) : root_(rows.size()) {
  for (std::size_t i = 0; i < rows.size(); ++i) root_[i] = rootOf(rows[i].at(static_cast<int>(i)));
  for (std::size_t i = 0; i < rows.size(); ++i) addRow(rows, i);
}

void BlockGradients::addRow(const SphereRows& rows, std::size_t i) {
  for (const auto& [column, block] : rows[i]) {
    const auto j = static_cast<std::size_t>(column);
    const SphereBlock scaled = root_[i] * block * root_[j].transpose(),
                      opposite = root_[j] * rows[j].at(static_cast<int>(i)) * root_[i].transpose();
    for (const bool transposed : {false, true}) {
      Matrix& matrix = transposed ? transposed_ : plain_;
      const SphereBlock value = transposed ? SphereBlock(opposite.transpose()) : scaled;
      Numbers numbers;
      Eigen::Map<SphereBlock> map(numbers.data());
      if (i == j) {
        map = 2.0 * SphereBlock::Identity() - value;
        matrix.rest.push_back(numbers);
      } else {
        map = value;
        Triangle& triangle = j < i ? matrix.lower : matrix.upper;
        triangle.other.push_back(column);
        triangle.blocks.push_back(numbers);
      }
    }
  }
  for (Matrix* matrix : {&plain_, &transposed_})
    for (Triangle* triangle : {&matrix->lower, &matrix->upper})
      triangle->first.push_back(static_cast<int>(triangle->other.size()));
}

SphereBlock BlockGradients::rootOf(const SphereBlock& whole) {
  const SphereBlock symmetric = 0.5 * (whole + whole.transpose());
  const Eigen::LLT<SphereBlock> factor(symmetric);
  const auto pivots = factor.matrixLLT().diagonal().array().square();
  if (factor.info() == Eigen::Success && pivots.minCoeff() > 1e-6 * pivots.maxCoeff())
    return factor.matrixL().solve(SphereBlock::Identity());
  // held by their neighbours only
  const Eigen::SelfAdjointEigenSolver<SphereBlock> solver(symmetric);
  const double least = std::max(1e-2 * solver.eigenvalues().maxCoeff(), std::numeric_limits<double>::min());
  return solver.eigenvalues().array().max(least).rsqrt().matrix().asDiagonal() * solver.eigenvectors().transpose();
}

/// (1 + L) to = from.
void BlockGradients::down(const Triangle& lower, const Field& from, Field& to) {
  withVectors([&] {
    for (std::size_t i = 0; i < from.size(); ++i) {
      Lanes sum = from[i];
      for (int e = lower.first[i]; e < lower.first[i + 1]; ++e) {
        const auto at = static_cast<std::size_t>(e);
        subtractProduct(lower.blocks[at].data(), to[static_cast<std::size_t>(lower.other[at])], sum);
      }
      to[i] = sum;
    }
  });
}

/// (1 + U) to = from.
void BlockGradients::up(const Triangle& upper, const Field& from, Field& to) {
  withVectors([&] {
    for (std::size_t i = from.size(); i-- > 0;) {
      Lanes sum = from[i];
      for (int e = upper.first[i]; e < upper.first[i + 1]; ++e) {
        const auto at = static_cast<std::size_t>(e);
        subtractProduct(upper.blocks[at].data(), to[static_cast<std::size_t>(upper.other[at])], sum);
      }
      to[i] = sum;
    }
  });
}

/// The preconditioned matrix is (1 + L)⁻¹ K (1 + U)⁻¹, and its product with p is t + (1 + L)⁻¹ (p − (1 − O) t),
/// t = (1 + U)⁻¹ p.
void BlockGradients::product(const Matrix& matrix, const Field& way, Field& work, Field& image) {
  up(matrix.upper, way, work);
  withVectors([&] {
    for (std::size_t i = 0; i < way.size(); ++i) {
      Lanes sum = way[i];
      subtractProduct(matrix.rest[i].data(), work[i], sum);
      image[i] = sum;
    }
  });
  down(matrix.lower, image, image);
  combine(image, ones, work, ones);
}

BlockGradients::Field BlockGradients::scaled(const Eigen::MatrixXd& b) const {
  Field field(root_.size(), Lanes{});
  for (std::size_t i = 0; i < field.size(); ++i) {
    const Eigen::MatrixXd part = root_[i] * b.middleRows<perSphere>(static_cast<Eigen::Index>(perNode * i));
    for (std::size_t r = 0; r < perNode; ++r)
      for (Eigen::Index c = 0; c < b.cols(); ++c)
        field[i][r][static_cast<std::size_t>(c)] = part(static_cast<Eigen::Index>(r), c);
  }
  return field;
}

void BlockGradients::unscaled(const Field& x, Eigen::MatrixXd& b) const {
  Eigen::Matrix<double, perSphere, Eigen::Dynamic> part(static_cast<Eigen::Index>(perSphere), b.cols());
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t r = 0; r < perNode; ++r)
      for (Eigen::Index c = 0; c < b.cols(); ++c)
        part(static_cast<Eigen::Index>(r), c) = x[i][r][static_cast<std::size_t>(c)];
    b.middleRows<perSphere>(static_cast<Eigen::Index>(perNode * i)) = root_[i].transpose() * part;
  }
}

bool BlockGradients::solve(Eigen::MatrixXd& b, Eigen::MatrixXd& g, double tolerance, int iterations) const {
  const std::size_t n = root_.size();
  Field rest = scaled(b), restToo = scaled(g), x(n, Lanes{}), y = x, work(n), image(n), imageToo(n);
  down(plain_.lower, rest, rest);
  down(transposed_.lower, restToo, restToo);
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
    product(plain_, way, work, image);
    product(transposed_, wayToo, work, imageToo);
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
  up(plain_.upper, x, work);
  unscaled(work, b);
  up(transposed_.upper, y, work);
  unscaled(work, g);
  return true;
}

}  // namespace dovetail::rve
