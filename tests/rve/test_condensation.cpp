// Grains with few neighbours eliminated from the network of a cell.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "tangent/condensation.hpp"

namespace dovetail::rve::test {
namespace {

using Matrix = Eigen::MatrixXd;

Matrix random(Eigen::Index rows, Eigen::Index columns, std::mt19937_64& engine) {
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  return Matrix::NullaryExpr(rows, columns, [&] { return within(engine); });
}

/// A ring with some chords, with pairs and lone ends that hang on it; nearly symmetric.
SphereRows network(int nodes, std::mt19937_64& engine) {
  SphereRows rows(static_cast<std::size_t>(nodes));
  const auto couple = [&](int i, int j) {
    const Matrix block = random(6, 6, engine);
    rows[static_cast<std::size_t>(i)][j] = block;
    rows[static_cast<std::size_t>(j)][i] = block.transpose() + 1e-3 * random(6, 6, engine);
  };
  const int ring = nodes - 4;
  for (int i = 0; i < ring; ++i) couple(i, (i + 1) % ring);
  for (int i = 0; i + 5 < ring; i += 2) couple(i, i + 5);
  for (int i = 0; i + 7 < ring; i += 3) couple(i, i + 7);
  for (int i = ring; i + 1 < nodes; ++i) couple(i, i - ring);  // one neighbour each; the last touches nobody
  for (int i = 0; i < nodes; ++i)
    rows[static_cast<std::size_t>(i)][i] = 8.0 * SphereBlock::Identity() + random(6, 6, engine);
  return rows;
}

Matrix dense(const SphereRows& rows) {
  const auto size = static_cast<Eigen::Index>(6 * rows.size());
  return product(rows, Matrix::Identity(size, size));
}

TEST(Condensation, KeepsWhatIsAskedOfTheNetwork) {
  std::mt19937_64 engine(3);
  const SphereRows rows = network(24, engine);
  const Matrix K = dense(rows), b = random(K.rows(), 9, engine), g = random(K.rows(), 9, engine);
  const Matrix whole = g.transpose() * K.partialPivLu().solve(b);
  std::size_t before = rows.size() + 1;
  for (const std::size_t most : {std::size_t{0}, std::size_t{2}, std::size_t{3}, std::size_t{4}}) {
    const CondensedNetwork left = condensed(rows, b, g, most);
    EXPECT_LT(left.rows.size(), before) << most;
    before = left.rows.size();
    Matrix sum = left.solved;
    if (!left.rows.empty()) sum += left.g.transpose() * dense(left.rows).partialPivLu().solve(left.b);
    EXPECT_LT((sum - whole).norm(), 1e-12 * whole.norm()) << most;
  }
}

/// A node whose block is almost singular where its neighbours press: products with its inverse would lose ten digits.
TEST(Condensation, KeepsDigitsOfGrainsThatHardlyAnythingHolds) {
  std::mt19937_64 engine(4);
  SphereRows rows = network(24, engine);
  const int loose = 22;
  const Eigen::Matrix<double, 6, 1> free = random(6, 1, engine).normalized();
  const SphereBlock held = SphereBlock::Identity() - free * free.transpose();
  SphereBlock& own = rows[loose][loose];
  own = held * own * held + 1e-10 * free * free.transpose();
  for (auto& [other, block] : rows[loose])
    if (other != loose) {
      block = held * block;
      SphereBlock& from = rows[static_cast<std::size_t>(other)][loose];
      from = from * held;
    }
  const Matrix K = dense(rows);
  Matrix b = random(K.rows(), 3, engine), g = random(K.rows(), 3, engine);
  for (Matrix* const side : {&b, &g}) side->middleRows<6>(6 * loose) = held * side->middleRows<6>(6 * loose);
  const Matrix whole = g.transpose() * K.fullPivLu().solve(b);
  const CondensedNetwork left = condensed(rows, b, g, 3);
  const Matrix sum = left.solved + left.g.transpose() * dense(left.rows).partialPivLu().solve(left.b);
  EXPECT_LT((sum - whole).norm(), 1e-9 * whole.norm());
}

TEST(Condensation, ProductsAreAdjoint) {
  std::mt19937_64 engine(5);
  const SphereRows rows = network(12, engine);
  const Matrix x = random(72, 2, engine), y = random(72, 2, engine);
  EXPECT_LT((y.transpose() * product(rows, x) - transposedProduct(rows, y).transpose() * x).norm(), 1e-12);
}

}  // namespace
}  // namespace dovetail::rve::test
