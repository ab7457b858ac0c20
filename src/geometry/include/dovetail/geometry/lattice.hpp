// Periodic space with period vectors at any angle, which may change in time.
#pragma once

#include <array>

#include "dovetail/core/vec3.hpp"

namespace dovetail::geometry {

/// Which image of a point: numbers of periods.
using Image = std::array<int, 3>;
/// Integer matrix, by rows.
using IntegerMatrix = std::array<Image, 3>;

/// Period vectors (m), linearly independent. Along axes that do not repeat they only span the frame of reduced
/// coordinates s, x = Σ s_k period_k.
struct Lattice {
  std::array<Vec3, 3> period{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  std::array<bool, 3> axes{true, true, true};

  friend bool operator==(const Lattice&, const Lattice&) = default;

  /// |det H|, m³.
  double volume() const;
  /// H n: what an image is away from the point itself. With rates of the periods for periods, how fast it moves away.
  Vec3 shift(const Image& n) const {
    return double(n[0]) * period[0] + double(n[1]) * period[1] + double(n[2]) * period[2];
  }
  /// x = H s, m.
  Vec3 position(const Vec3& s) const { return s.x * period[0] + s.y * period[1] + s.z * period[2]; }
  /// Distances of opposite faces, m.
  std::array<double, 3> widths() const;
};

/// Rows of H⁻¹, so that s_k = row_k · x. @throws InputError if the periods are not finite or span no volume
std::array<Vec3, 3> inverse(const Lattice& lattice);

/// Which period a point lies in: floor(s) along axes that repeat, else 0.
/// @param rows of inverse(lattice)
Image periodOf(const Lattice& lattice, const std::array<Vec3, 3>& rows, const Vec3& x);

/// The matrix that leaves all images as they are.
inline constexpr IntegerMatrix sameImages{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Replaces periods by shorter ones that span the same lattice of points, until no two make an angle below 60° or above
/// 120° (Lagrange and Gauss's reduction, pair by pair): faces then are as far apart as they can be.
/// @return M with n′ = M n: what numbered an image before, and what does now
IntegerMatrix reduce(Lattice& lattice);

/// M n.
Image product(const IntegerMatrix& m, const Image& n);

}  // namespace dovetail::geometry
