// Integrates the kernel over one facet, adaptively.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "dovetail/cg/kernel.hpp"

namespace dovetail::cg {

/// Integrals over a facet with barycentric coordinates λ0 + λ1 + λ2 = 1 and the (unnormalised) profile w as weight.
struct FacetIntegral {
  double w = 0.0, w1 = 0.0, w2 = 0.0, w11 = 0.0, w12 = 0.0, w22 = 0.0;  ///< ∫ w, ∫ w λ1, …, ∫ w λ2², m²

  /// ∫ w λ_k.
  std::array<double, 3> first() const { return {w - w1 - w2, w1, w2}; }
  /// ∫ w λ_k λ_l.
  std::array<std::array<double, 3>, 3> second() const {
    const double w01 = w1 - w11 - w12, w02 = w2 - w12 - w22;
    const double w00 = w - w1 - w2 - w01 - w02;
    return {{{w00, w01, w02}, {w01, w11, w12}, {w02, w12, w22}}};
  }
};

/// The symmetric seven-point rule of degree 5 on a triangle (Radon 1948), as two tables: the monomials 1, p, r, p², pr,
/// r² of each point's barycentric coordinates (p, r), and the same times the point's weight.
/// An eighth point of weight zero rounds the loops to whole vector registers.
struct TriangleRule {
  static constexpr int size = 8;
  std::array<std::array<double, size>, 6> monomial{};
  std::array<std::array<double, 6>, size> weighted{};

  TriangleRule() {
    const double root = std::sqrt(15.0);
    const double a = (6.0 - root) / 21.0, b = (6.0 + root) / 21.0;
    const double wa = (155.0 - root) / 1200.0, wb = (155.0 + root) / 1200.0;
    const std::array<std::array<double, 3>, size> points{{{1.0 / 3.0, 1.0 / 3.0, 9.0 / 40.0},
                                                          {a, a, wa},
                                                          {1.0 - 2.0 * a, a, wa},
                                                          {a, 1.0 - 2.0 * a, wa},
                                                          {b, b, wb},
                                                          {1.0 - 2.0 * b, b, wb},
                                                          {b, 1.0 - 2.0 * b, wb},
                                                          {1.0 / 3.0, 1.0 / 3.0, 0.0}}};
    for (std::size_t i = 0; i < size; ++i) {
      const auto [p, r, w] = points[i];
      const std::array<double, 6> terms{1.0, p, r, p * p, p * r, r * r};
      for (std::size_t m = 0; m < 6; ++m) {
        monomial[m][i] = terms[m];
        weighted[i][m] = w * terms[m];
      }
    }
  }
};

/// Cuts a facet in two until its pieces are not slender, and these in four until they are small against the width, and
/// sums the rule over those inside the support.
class FacetIntegrator {
public:
  explicit FacetIntegrator(const Kernel& kernel) : shape_(kernel.shape), width_(kernel.width) {}

  /// @param corner  the facet's corners relative to the centre of the kernel, m
  FacetIntegral integrate(const std::array<Vec3, 3>& corner) {
    integral_ = {};
    const double area = 0.5 * norm(cross(corner[1] - corner[0], corner[2] - corner[0]));
    if (area > 0.0) halve({corner[0], 0.0, 0.0}, {corner[1], 1.0, 0.0}, {corner[2], 0.0, 1.0}, area);
    return integral_;
  }

private:
  static constexpr double pieceSize = 0.125;  ///< largest piece over the width
  static constexpr double slender = 8.0;      ///< longest edge over the height on it

  struct Corner {
    Vec3 d;
    double l1, l2;
  };
  static Corner middle(const Corner& a, const Corner& b) {
    return {0.5 * (a.d + b.d), 0.5 * (a.l1 + b.l1), 0.5 * (a.l2 + b.l2)};
  }

  struct Piece {
    double area, radius;  ///< radius of the ball around its centroid that holds it, m
    int levels;           ///< cuts still to come
  };

  void halve(const Corner& a, const Corner& b, const Corner& c, double area) {
    const double ab = squaredNorm(b.d - a.d), bc = squaredNorm(c.d - b.d), ca = squaredNorm(a.d - c.d);
    const double longest = std::sqrt(std::fmax(ab, std::fmax(bc, ca)));
    const Vec3 centroid = (1.0 / 3.0) * (a.d + b.d + c.d);
    const double radius = std::sqrt(
        std::fmax(squaredNorm(a.d - centroid), std::fmax(squaredNorm(b.d - centroid), squaredNorm(c.d - centroid))));
    if (longest <= pieceSize * width_ || longest * longest <= slender * 2.0 * area) {
      int levels = 0;
      for (double size = longest; size > pieceSize * width_; size *= 0.5) ++levels;
      return refine(a, b, c, {area, radius, levels});
    }
    const double reach = width_ + radius;
    if (squaredNorm(centroid) > reach * reach) return;
    if (bc > ab && bc >= ca) return halve(b, c, a, area);
    if (ca > ab) return halve(c, a, b, area);
    const Corner m = middle(a, b);
    halve(a, m, c, 0.5 * area);
    halve(m, b, c, 0.5 * area);
  }

  void refine(const Corner& a, const Corner& b, const Corner& c, const Piece& piece) {
    const Vec3 centroid = (1.0 / 3.0) * (a.d + b.d + c.d);
    const double reach = width_ + piece.radius;
    if (squaredNorm(centroid) > reach * reach) return;
    if (piece.levels == 0) return sum(a, b, c, piece.area);
    // The four pieces are similar to the whole, half as large.
    const Piece quarter{0.25 * piece.area, 0.5 * piece.radius, piece.levels - 1};
    const Corner ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    refine(a, ab, ca, quarter);
    refine(ab, b, bc, quarter);
    refine(ca, bc, c, quarter);
    refine(bc, ca, ab, quarter);
  }

  /// Profile at the points of a piece: q² is a quadratic in the piece's own coordinates.
  std::array<double, TriangleRule::size> profileAt(const Vec3& origin, const Vec3& e1, const Vec3& e2) const {
    const double scale = 1.0 / (width_ * width_);
    const std::array<double, 6> term{squaredNorm(origin) * scale,   2.0 * dot(origin, e1) * scale,
                                     2.0 * dot(origin, e2) * scale, squaredNorm(e1) * scale,
                                     2.0 * dot(e1, e2) * scale,     squaredNorm(e2) * scale};
    std::array<double, TriangleRule::size> value{};
    for (std::size_t m = 0; m < 6; ++m)
      for (std::size_t i = 0; i < TriangleRule::size; ++i) value[i] += term[m] * rule_.monomial[m][i];
    for (double& q : value) q = std::sqrt(q > 0.0 ? q : 0.0);
    if (shape_ == KernelShape::lucy) {
      for (double& q : value) {
        const double t = q < 1.0 ? 1.0 - q : 0.0;
        q = t * t * t * (1.0 + 3.0 * q);
      }
    } else {
      for (double& q : value) q = profile(shape_, q);
    }
    return value;
  }

  void sum(const Corner& a, const Corner& b, const Corner& c, double area) {
    const auto value = profileAt(a.d, b.d - a.d, c.d - a.d);
    std::array<double, 6> s{};
    for (std::size_t i = 0; i < TriangleRule::size; ++i)
      for (std::size_t m = 0; m < 6; ++m) s[m] += rule_.weighted[i][m] * value[i];
    for (double& term : s) term *= area;
    // From the piece's coordinates to the facet's: λ = origin + p first + r second.
    const double o1 = a.l1, p1 = b.l1 - a.l1, r1 = c.l1 - a.l1;
    const double o2 = a.l2, p2 = b.l2 - a.l2, r2 = c.l2 - a.l2;
    const double linear1 = p1 * s[1] + r1 * s[2], linear2 = p2 * s[1] + r2 * s[2];
    integral_.w += s[0];
    integral_.w1 += o1 * s[0] + linear1;
    integral_.w2 += o2 * s[0] + linear2;
    integral_.w11 += o1 * (o1 * s[0] + 2.0 * linear1) + p1 * (p1 * s[3] + 2.0 * r1 * s[4]) + r1 * r1 * s[5];
    integral_.w22 += o2 * (o2 * s[0] + 2.0 * linear2) + p2 * (p2 * s[3] + 2.0 * r2 * s[4]) + r2 * r2 * s[5];
    integral_.w12 +=
        o1 * o2 * s[0] + o1 * linear2 + o2 * linear1 + p1 * p2 * s[3] + (p1 * r2 + r1 * p2) * s[4] + r1 * r2 * s[5];
  }

  TriangleRule rule_;
  KernelShape shape_;
  double width_;
  FacetIntegral integral_;
};

}  // namespace dovetail::cg
