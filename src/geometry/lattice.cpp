#include "dovetail/geometry/lattice.hpp"

#include <cmath>

#include "dovetail/core/error.hpp"

namespace dovetail::geometry {

namespace {
double determinant(const Lattice& l) { return dot(l.period[0], cross(l.period[1], l.period[2])); }
}  // namespace

double Lattice::volume() const { return std::abs(determinant(*this)); }

std::array<Vec3, 3> inverse(const Lattice& lattice) {
  const auto& [a, b, c] = lattice.period;
  const double det = determinant(lattice), scale = norm(a) * norm(b) * norm(c);
  if (!std::isfinite(scale) || !(std::abs(det) > 1e-12 * scale))
    throw InputError("the periods span no volume", "lattice", "give three finite vectors that are not in one plane");
  return {cross(b, c) / det, cross(c, a) / det, cross(a, b) / det};
}

std::array<double, 3> Lattice::widths() const {
  const std::array<Vec3, 3> rows = inverse(*this);
  return {1.0 / norm(rows[0]), 1.0 / norm(rows[1]), 1.0 / norm(rows[2])};
}

Image periodOf(const Lattice& lattice, const std::array<Vec3, 3>& rows, const Vec3& x) {
  Image n{};
  for (std::size_t k = 0; k < 3; ++k)
    if (lattice.axes[k]) n[k] = static_cast<int>(std::floor(dot(rows[k], x)));
  return n;
}

IntegerMatrix reduce(Lattice& lattice) {
  IntegerMatrix map = sameImages;
  // An angle of 60° is left as it is, whatever the round-off.
  constexpr double slack = 1e-9;
  bool shorter = true;
  while (shorter) {
    shorter = false;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) {
        if (a == b || !lattice.axes[a] || !lattice.axes[b]) continue;
        const double fraction = dot(lattice.period[a], lattice.period[b]) / squaredNorm(lattice.period[a]);
        if (!(std::abs(fraction) > 0.5 + slack)) continue;
        const int k = static_cast<int>(std::lround(fraction));
        lattice.period[b] -= double(k) * lattice.period[a];
        for (std::size_t column = 0; column < 3; ++column) map[a][column] += k * map[b][column];
        shorter = true;
      }
  }
  return map;
}

Image product(const IntegerMatrix& m, const Image& n) {
  Image result{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) result[i] += m[i][k] * n[k];
  return result;
}

}  // namespace dovetail::geometry
