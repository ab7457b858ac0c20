// Logarithmic elastic strain in its principal frame, and the way back of its stress and stiffness to P and F
// (Miehe & Lambrecht 2001, Commun. Numer. Meth. Engng 17; here with divided differences of the logarithm).
#pragma once

#include "dovetail/fem/laws/point_law.hpp"
#include "six.hpp"
#include "spectral.hpp"

namespace dovetail::fem::detail {

/// ε = ½ ln(FₑᵀFₑ) with Fₑ = F Fₚ⁻¹, in the frame of its eigenvectors; at one point or four.
template <class T>
class LogStrain {
public:
  LogStrain(const Tensor<T>& F, const Tensor<T>& plasticInverse)
      : LogStrain(product(F, plasticInverse), plasticInverse, 0) {}

  /// ε in the frame; it has no shear there.
  std::array<T, 3> strain() const {
    using std::log;
    return {0.5 * log(square_[0]), 0.5 * log(square_[1]), 0.5 * log(square_[2])};
  }
  /// Eigenvalues of FₑᵀFₑ, and its eigenvectors as columns.
  const std::array<T, 3>& squares() const { return square_; }
  const Tensor<T>& vectors() const { return vectors_; }
  /// Fₚ⁻¹ V.
  const Tensor<T>& plasticVectors() const { return plastic_; }

  /// P = ∂ψ/∂F for S = ∂ψ/∂ε in the frame.
  Tensor<T> firstStress(const SixOf<T>& S) const {
    return product(elastic_, product(scaled(2.0, tensorOf(metricStress(S))), transposed(plastic_)));
  }
  /// ∂P/∂F for that and ∂S/∂ε. `coaxial`: S has no shear in the frame.
  void writeTangent(const SixOf<T>& S, const SixBySixOf<T>& stiffness, bool coaxial, const TangentOut<T>& out) const {
    const SixBySixOf<T> D = metricStiffness(S, stiffness, coaxial);
    std::array<std::array<T, 9>, 6> B, DB;  // ∂C/∂F and D of it
    metricGradient(B);
    for (std::size_t m = 0; m < 6; ++m)
      for (std::size_t c = 0; c < 9; ++c) {
        T sum = D[6 * m] * B[0][c];
        for (std::size_t n = 1; n < 6; ++n) sum += D[6 * m + n] * B[n][c];
        DB[m][c] = sum;
      }
    const Tensor<T> metric = scaled(2.0, tensorOf(metricStress(S)));
    const Tensor<T> geometric = product(plastic_, product(metric, transposed(plastic_)));
    for (std::size_t r = 0; r < 9; ++r)
      for (std::size_t c = 0; c < 9; ++c) {
        T sum = B[0][r] * DB[0][c];
        for (std::size_t m = 1; m < 6; ++m) sum += B[m][r] * DB[m][c];
        if (r / 3 == c / 3) sum += geometric[3 * (r % 3) + c % 3];
        out.set(r, c, sum);
      }
  }

private:
  LogStrain(const Tensor<T>& elastic, const Tensor<T>& plasticInverse, int)
      : LogStrain(elastic, plasticInverse, spectrum(gram(elastic))) {}
  LogStrain(const Tensor<T>& elastic, const Tensor<T>& plasticInverse, const Spectrum<T>& C)
      : square_(C.value),
        vectors_(C.vectors),
        elastic_(product(elastic, C.vectors)),
        plastic_(product(plasticInverse, C.vectors)),
        difference_(C.value) {}

  /// ∂ψ/∂C in the frame.
  SixOf<T> metricStress(SixOf<T> S) const {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a; b < 3; ++b) S[sixEntry[a][b]] *= difference_(a, b);
    return S;
  }
  /// ∂²ψ/∂C∂C in the frame.
  SixBySixOf<T> metricStiffness(const SixOf<T>& S, const SixBySixOf<T>& stiffness, bool coaxial) const {
    SixOf<T> first;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a; b < 3; ++b) first[sixEntry[a][b]] = difference_(a, b);
    SixBySixOf<T> D;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j) D[6 * i + j] = first[i] * stiffness[6 * i + j] * first[j];
    // S:∂²ε/∂C∂C [H, K] = 2 Σ_abc S_ab f[a, b, c] H_ac K_cb
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        for (std::size_t c = 0; c < 3; ++c) {
          if (coaxial && a != b) continue;
          const double weight = 2.0 * sixWeight(a, b) * sixWeight(a, c) * sixWeight(c, b);
          D[6 * sixEntry[a][c] + sixEntry[c][b]] += weight * S[sixEntry[a][b]] * difference_(a, b, c);
        }
    return D;
  }
  /// ∂C/∂F in the frame.
  void metricGradient(std::array<std::array<T, 9>, 6>& B) const {
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = a; b < 3; ++b)
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t J = 0; J < 3; ++J)
            B[sixEntry[a][b]][3 * i + J] =
                (plastic_[3 * J + a] * elastic_[3 * i + b] + elastic_[3 * i + a] * plastic_[3 * J + b]) *
                (a == b ? 1.0 : std::numbers::sqrt2);
  }

  std::array<T, 3> square_;
  Tensor<T> vectors_;
  Tensor<T> elastic_, plastic_;  ///< Fₑ V and Fₚ⁻¹ V
  LogDifferences<T> difference_;
};

}  // namespace dovetail::fem::detail
