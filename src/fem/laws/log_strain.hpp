// Logarithmic elastic strain in its principal frame, and the way back of its stress and stiffness to P and F
// (Miehe & Lambrecht 2001, Commun. Numer. Meth. Engng 17; here with divided differences of the logarithm).
#pragma once

#include <numbers>

#include "dovetail/fem/point_law.hpp"
#include "spectral.hpp"

namespace dovetail::fem::detail {

/// Symmetric tensors 11, 22, 33, √2·12, √2·23, √2·31, so that A:B is a dot product.
using Six = std::array<double, 6>;
using SixBySix = std::array<double, 36>;

inline constexpr std::array<std::array<std::size_t, 3>, 3> sixEntry = {{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
/// Tensor component per entry of a Six.
inline double sixWeight(std::size_t a, std::size_t b) { return a == b ? 1.0 : 1.0 / std::numbers::sqrt2; }

inline double dot(const Six& a, const Six& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}
inline double trace(const Six& a) { return a[0] + a[1] + a[2]; }
inline Six deviator(Six a) {
  const double mean = trace(a) / 3.0;
  for (std::size_t i = 0; i < 3; ++i) a[i] -= mean;
  return a;
}
inline Tensor<double> tensorOf(const Six& a) {
  Tensor<double> t;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) t[3 * i + j] = sixWeight(i, j) * a[sixEntry[i][j]];
  return t;
}
inline Six sixOf(const Tensor<double>& t) {
  constexpr double root = std::numbers::sqrt2;
  return {t[0], t[4], t[8], root * t[1], root * t[5], root * t[2]};
}

/// Hooke's law: κ tr ε 1 + 2μ dev ε.
struct HenckyElasticity {
  double kappa, mu;

  Six stress(const Six& strain) const {
    Six s = deviator(strain);
    for (std::size_t i = 0; i < 6; ++i) s[i] = 2.0 * mu * s[i] + (i < 3 ? kappa * trace(strain) : 0.0);
    return s;
  }
  double energy(const Six& strain) const { return 0.5 * dot(stress(strain), strain); }
};

/// bulk 1⊗1 + shear (1 − ⅓ 1⊗1).
inline SixBySix isotropicStiffness(double bulk, double shear) {
  SixBySix D{};
  for (std::size_t i = 0; i < 6; ++i) D[7 * i] = shear;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) D[6 * i + j] += bulk - shear / 3.0;
  return D;
}
/// D += a ⊗ b.
inline void addDyad(SixBySix& D, const Six& a, const Six& b) {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) D[6 * i + j] += a[i] * b[j];
}

/// ε = ½ ln(FₑᵀFₑ) with Fₑ = F Fₚ⁻¹, in the frame of its eigenvectors.
class LogStrain {
public:
  LogStrain(const Tensor<double>& F, const Tensor<double>& plasticInverse);

  Six strain() const;
  /// A symmetric tensor of the intermediate configuration in the frame, and back.
  Six toFrame(const Six& a) const { return sixOf(product(transposed(vectors_), product(tensorOf(a), vectors_))); }
  Six fromFrame(const Six& a) const { return sixOf(product(vectors_, product(tensorOf(a), transposed(vectors_)))); }

  /// P = ∂ψ/∂F for T = ∂ψ/∂ε in the frame.
  Tensor<double> firstStress(const Six& T) const;
  /// ∂P/∂F for that and ∂T/∂ε.
  void writeTangent(const Six& T, const SixBySix& stiffness, const TangentOut<double>& tangent) const;
  /// Fₚ⁻¹ after the elastic strain was brought to `strain` at constant F without rotation: Fₚ⁻¹ e^(−ε) e^strain.
  Tensor<double> plasticInverse(const Six& strain) const;

private:
  /// ∂ψ/∂C in the frame.
  Six metricStress(const Six& T) const;
  /// ∂²ψ/∂C∂C in the frame.
  SixBySix metricStiffness(const Six& T, const SixBySix& stiffness) const;

  std::array<double, 3> square_;      ///< eigenvalues of C = FₑᵀFₑ
  Tensor<double> vectors_;            ///< columns: its eigenvectors V
  Tensor<double> elastic_, plastic_;  ///< Fₑ V and Fₚ⁻¹ V
};

}  // namespace dovetail::fem::detail
