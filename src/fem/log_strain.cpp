#include "laws/log_strain.hpp"

namespace dovetail::fem::detail {

LogStrain::LogStrain(const Tensor<double>& F, const Tensor<double>& plasticInverse) {
  const Tensor<double> elastic = product(F, plasticInverse);
  const Spectrum C = spectrum(gram(elastic));
  square_ = C.value;
  vectors_ = C.vectors;
  elastic_ = product(elastic, vectors_);
  plastic_ = product(plasticInverse, vectors_);
}

Six LogStrain::strain() const {
  return {0.5 * std::log(square_[0]), 0.5 * std::log(square_[1]), 0.5 * std::log(square_[2]), 0.0, 0.0, 0.0};
}

Six LogStrain::metricStress(const Six& T) const {
  Six s = T;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b) s[sixEntry[a][b]] *= logDifference(square_[a], square_[b]);
  return s;
}

Tensor<double> LogStrain::firstStress(const Six& T) const {
  const Tensor<double> S = scaled(2.0, tensorOf(metricStress(T)));
  return product(elastic_, product(S, transposed(plastic_)));
}

SixBySix LogStrain::metricStiffness(const Six& T, const SixBySix& stiffness) const {
  Six first;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b) first[sixEntry[a][b]] = logDifference(square_[a], square_[b]);
  SixBySix D;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) D[6 * i + j] = first[i] * stiffness[6 * i + j] * first[j];
  // T:∂²ε/∂C∂C [H, K] = 2 Σ_abc T_ab f[a, b, c] H_ac K_cb
  const Tensor<double> t = tensorOf(T);
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) {
      if (t[3 * a + b] == 0.0) continue;
      for (std::size_t c = 0; c < 3; ++c)
        D[6 * sixEntry[a][c] + sixEntry[c][b]] += 2.0 * t[3 * a + b] *
                                                  logSecondDifference(square_[a], square_[b], square_[c]) *
                                                  sixWeight(a, c) * sixWeight(c, b);
    }
  return D;
}

void LogStrain::writeTangent(const Six& T, const SixBySix& stiffness, const TangentOut<double>& tangent) const {
  const SixBySix D = metricStiffness(T, stiffness);
  std::array<std::array<double, 9>, 6> B{}, DB{};  // ∂C/∂F and D of it
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t J = 0; J < 3; ++J)
          B[sixEntry[a][b]][3 * i + J] =
              (plastic_[3 * J + a] * elastic_[3 * i + b] + elastic_[3 * i + a] * plastic_[3 * J + b]) *
              (a == b ? 1.0 : std::numbers::sqrt2);
  for (std::size_t m = 0; m < 6; ++m)
    for (std::size_t n = 0; n < 6; ++n)
      for (std::size_t c = 0; c < 9; ++c) DB[m][c] += D[6 * m + n] * B[n][c];
  const Tensor<double> S = scaled(2.0, tensorOf(metricStress(T)));
  const Tensor<double> geometric = product(plastic_, product(S, transposed(plastic_)));
  for (std::size_t r = 0; r < 9; ++r) {
    std::array<double, 9> row{};
    for (std::size_t m = 0; m < 6; ++m)
      for (std::size_t c = 0; c < 9; ++c) row[c] += B[m][r] * DB[m][c];
    for (std::size_t L = 0; L < 3; ++L) row[r - r % 3 + L] += geometric[3 * (r % 3) + L];
    for (std::size_t c = 0; c < 9; ++c) tangent.set(r, c, row[c]);
  }
}

Tensor<double> LogStrain::plasticInverse(const Six& strain) const {
  Tensor<double> left = plastic_;  // Fₚ⁻¹ V e^(−ε)
  for (std::size_t i = 0; i < 9; ++i) left[i] /= std::sqrt(square_[i % 3]);
  const Spectrum elastic = spectrum(tensorOf(strain));
  Tensor<double> scaledVectors = elastic.vectors;
  for (std::size_t i = 0; i < 9; ++i) scaledVectors[i] *= std::exp(elastic.value[i % 3]);
  const Tensor<double> exponential = product(scaledVectors, transposed(elastic.vectors));
  return product(left, product(exponential, transposed(vectors_)));
}

}  // namespace dovetail::fem::detail
