// How several facets or patches share the overlap with one particle: the small quadratic programme of
// projectWallContacts.
#pragma once

#include <array>
#include <span>

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

/// s(g) and s′(g), g = cosine between two contact normals: g from 0.2 on, 0 below 0, continuous slope between.
inline constexpr double couplingBlend = 0.2;
inline double coupling(double g) {
  if (g >= couplingBlend) return g;
  return g <= 0.0 ? 0.0 : g * g * (2.0 * couplingBlend - g) / (couplingBlend * couplingBlend);
}
inline double couplingSlope(double g) {
  if (g >= couplingBlend) return 1.0;
  return g <= 0.0 ? 0.0 : g * (4.0 * couplingBlend - 3.0 * g) / (couplingBlend * couplingBlend);
}

/// Whether two contacts have one overlap (1) or each its own (0); between, 0 < g < 0.1, a smooth step. For laws that
/// are not linear: there the energy of walls at right angles is the sum of two, that of flatter valleys one.
inline double together(double g) {
  constexpr double whole = 0.1;
  if (g >= whole) return 1.0;
  const double t = g > 0.0 ? g / whole : 0.0;
  return t * t * (3.0 - 2.0 * t);
}

/// One facet's linearised constraint and what it carries.
struct Fraction {
  Vec3 normal;
  double overlap = 0.0;  // δ, m
  double carried = 0.0;  // λ, m
};

/// Solves max_{λ ≥ 0} Σ λᵢ δᵢ − ½ Σ λᵢ λⱼ s(nᵢ·nⱼ) with the dual active-set method of Goldfarb & Idnani (Math. Prog.
/// 27, 1983): the most violated constraint comes in, those whose λ would turn negative go out.
class EdgeContactSolver {
public:
  static constexpr std::size_t capacity = 12;  ///< of those that carry something

  /// @param tolerance violations up to it (m) count as none
  void solve(std::span<Fraction> fractions, double tolerance);

private:
  using Row = std::array<double, capacity>;

  int mostViolated(double tolerance) const;
  bool bringIn(std::size_t entering);
  double violation(std::size_t i) const;
  void factor();
  void solveActive(Row& x) const;
  void drop(std::size_t place);

  std::span<Fraction> fractions_;
  std::array<std::size_t, capacity> active_{};
  std::array<Row, capacity> lower_{};  // Cholesky factor of the active couplings
  std::size_t count_ = 0;
  std::array<std::size_t, capacity> refused_{};
  std::size_t refusedCount_ = 0;
};

}  // namespace dovetail::dem
