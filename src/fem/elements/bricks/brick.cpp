#include "brick.hpp"

namespace dovetail::fem::detail {

BrickCorners cornersOf(const std::array<int, 8>& element, std::span<const Vec3> X) {
  BrickCorners corners;
  for (std::size_t a = 0; a < 8; ++a) corners[a] = X[static_cast<std::size_t>(element[a])];
  return corners;
}

Vec3 gaussPoint(int p) {
  const auto side = [](int bit) { return bit ? gaussDistance : -gaussDistance; };
  return {side(p & 1), side(p & 2), side(p & 4)};
}

Matrix3 jacobian(const BrickCorners& corners, const Vec3& xi) {
  const std::array<Vec3, 8> gradient = parentGradients(xi);
  Matrix3 J{};
  for (std::size_t a = 0; a < 8; ++a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) J[static_cast<std::size_t>(3 * i + j)] += corners[a][i] * gradient[a][j];
  return J;
}

double determinant(const Matrix3& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

Matrix3 inverse(const Matrix3& m) {
  const double s = 1.0 / determinant(m);
  return {s * (m[4] * m[8] - m[5] * m[7]), s * (m[2] * m[7] - m[1] * m[8]), s * (m[1] * m[5] - m[2] * m[4]),
          s * (m[5] * m[6] - m[3] * m[8]), s * (m[0] * m[8] - m[2] * m[6]), s * (m[2] * m[3] - m[0] * m[5]),
          s * (m[3] * m[7] - m[4] * m[6]), s * (m[1] * m[6] - m[0] * m[7]), s * (m[0] * m[4] - m[1] * m[3])};
}

Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      c[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
  return c;
}

CornerValues cornerValues(const std::array<int, 8>& element, std::span<const double> field) {
  CornerValues values;
  for (std::size_t a = 0; a < 8; ++a) values[a] = field.empty() ? 1.0 : field[static_cast<std::size_t>(element[a])];
  return values;
}

double interpolated(const CornerValues& values, const Vec3& xi) {
  const CornerValues psi = shapeValues(xi);
  double sum = values[0];
  for (std::size_t a = 1; a < 8; ++a) sum += psi[a] * (values[a] - values[0]);
  return sum;
}

std::array<double, 8> nodalVolumes(const BrickCorners& corners, const CornerValues& fraction) {
  std::array<double, 8> volume{};
  const std::array<double, 64> products = shapeProducts(corners, fraction);
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t b = 0; b < 8; ++b) volume[a] += products[8 * a + b];
  return volume;
}

std::array<double, 64> shapeProducts(const BrickCorners& corners, const CornerValues& fraction) {
  const double outer = std::sqrt(0.6);
  const std::array<double, 3> point = {-outer, 0.0, outer}, weight = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  std::array<double, 64> products{};
  for (std::size_t i = 0; i < 27; ++i) {
    const std::size_t x = i % 3, y = i / 3 % 3, z = i / 9;
    const Vec3 xi = {point[x], point[y], point[z]};
    const double w =
        weight[x] * weight[y] * weight[z] * interpolated(fraction, xi) * determinant(jacobian(corners, xi));
    const std::array<double, 8> psi = shapeValues(xi);
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t b = 0; b < 8; ++b) products[8 * a + b] += w * psi[a] * psi[b];
  }
  return products;
}

std::array<double, 108> stressModes(const Vec3& xi) {
  std::array<double, 108> modes{};
  const auto put = [&](std::size_t row, std::size_t first, std::initializer_list<double> values) {
    for (const double value : values) modes[18 * row + first++] = value;
  };
  put(0, 0, {1.0, xi.y, xi.z, xi.y * xi.z});
  put(1, 4, {1.0, xi.x, xi.z, xi.x * xi.z});
  put(2, 8, {1.0, xi.x, xi.y, xi.x * xi.y});
  put(3, 12, {1.0, xi.z});
  put(4, 14, {1.0, xi.x});
  put(5, 16, {1.0, xi.y});
  return modes;
}

}  // namespace dovetail::fem::detail
