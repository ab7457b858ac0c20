// Elastic laws in closed form, for one point or four.
#pragma once

#include "dovetail/fem/laws/point_law.hpp"
#include "green_moduli.hpp"

namespace dovetail::fem::detail {

/// P = shape F + volume G with G = F⁻ᵀ, and what the coefficients change by.
template <class T>
struct ShapeAndVolume {
  T shape, volume;
  T mixed;  ///< of F⊗G + G⊗F in the tangent
  T twice;  ///< of G⊗G
};

/// a δ_ik δ_JL + m (F_iJ G_kL + G_iJ F_kL) + t G_iJ G_kL − v G_iL G_kJ.
template <class T>
DOVETAIL_ALWAYS_INLINE void writeTangent(const ShapeAndVolume<T>& c, const Tensor<T>& F, const Tensor<T>& G,
                                         const TangentOut<T>& tangent) {
  for (std::size_t r = 0; r < 9; ++r) {
    const T byG = c.mixed * F[r] + c.twice * G[r], byF = c.mixed * G[r];
    for (std::size_t k = r; k < 9; ++k) {
      T entry = byG * G[k] + byF * F[k] - c.volume * G[3 * (r / 3) + k % 3] * G[3 * (k / 3) + r % 3];
      if (k == r) entry += c.shape;
      tangent.set(r, k, entry);
      if (k != r) tangent.set(k, r, entry);
    }
  }
}

template <class T>
DOVETAIL_ALWAYS_INLINE void writeStress(const ShapeAndVolume<T>& c, const Tensor<T>& F, const Tensor<T>& G,
                                        Tensor<T>& P) {
  for (std::size_t i = 0; i < 9; ++i) P[i] = c.shape * F[i] + c.volume * G[i];
}

struct NeoHookeanLaw {
  double kappa, mu;

  template <class T>
  T respond(const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) const {
    using std::exp, std::log;
    const Tensor<T> cof = cofactor(F);
    const T J = F[0] * cof[0] + F[1] * cof[1] + F[2] * cof[2], I = contraction(F, F), logJ = log(J);
    const Tensor<T> G = scaled(1.0 / J, cof);
    const T shape = mu * exp(-2.0 / 3.0 * logJ), deviation = shape * I / 3.0;
    const ShapeAndVolume<T> c{shape, 0.5 * kappa * (J * J - 1.0) - deviation, -2.0 / 3.0 * shape,
                              2.0 / 3.0 * deviation + kappa * J * J};
    writeStress(c, F, G, P);
    if (tangent) writeTangent(c, F, G, *tangent);
    return 1.5 * (deviation - mu) + 0.25 * kappa * (J * J - 1.0 - 2.0 * logJ);
  }
};

template <CoupledNeoHookean::Volume volume>
struct CoupledNeoHookeanLaw {
  double lambda, mu;

  template <class T>
  T respond(const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) const {
    using std::log;
    const Tensor<T> cof = cofactor(F);
    const T J = F[0] * cof[0] + F[1] * cof[1] + F[2] * cof[2], logJ = log(J);
    const Tensor<T> G = scaled(1.0 / J, cof);
    T slope, bend, energy;  // J U′, J (J U′)′ and U
    if constexpr (volume == CoupledNeoHookean::Volume::logarithm) {
      slope = lambda * logJ;
      bend = lambda;
      energy = 0.5 * lambda * logJ * logJ;
    } else {
      slope = 0.5 * lambda * (J * J - 1.0);
      bend = lambda * J * J;
      energy = 0.25 * lambda * (J * J - 1.0 - 2.0 * logJ);
    }
    const ShapeAndVolume<T> c{mu, slope - mu, 0.0, bend};
    writeStress(c, F, G, P);
    if (tangent) writeTangent(c, F, G, *tangent);
    return 0.5 * mu * (contraction(F, F) - 3.0 - 2.0 * logJ) + energy;
  }
};

struct StVenantKirchhoffLaw {
  StVenantKirchhoff constants;
  double lambda, mu;

  Material brickLaw() const { return constants; }
  std::string whyInvalid(const double* F) const;

  template <class T>
  T respond(const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) const {
    const Tensor<T> E = greenStrain(F);
    Tensor<T> S = scaled(2.0 * mu, E);
    for (const std::size_t i : {0, 4, 8}) S[i] += lambda * trace(E);
    P = product(F, S);
    if (tangent)
      forGreenModuli(F, S, T(lambda), T(mu), [&](std::size_t r, std::size_t c, const T& entry) {
        tangent->set(r, c, entry);
        tangent->set(c, r, entry);
      });
    return 0.5 * contraction(S, E);
  }
};

struct AxialSpringsLaw {
  AxialSprings constants;
  double young;

  Material brickLaw() const { return constants; }

  template <class T>
  T energy(const Tensor<T>& F) const {
    using std::sqrt;
    const Tensor<T> E = greenStrain(F);
    T normal = 0.0;
    for (const std::size_t i : {0, 4, 8}) {
      // λ − 1 without cancellation
      const T elongation = 2.0 * E[i] / (1.0 + sqrt(1.0 + 2.0 * E[i]));
      normal += elongation * elongation;
    }
    return 0.5 * young * normal + young * (E[1] * E[1] + E[2] * E[2] + E[5] * E[5]);
  }
};

struct DeformedMetricLaw {
  static constexpr bool hasPotential = false;
  DeformedMetricHooke constants;
  double lambda, mu;

  Material brickLaw() const { return constants; }

  template <class T>
  Tensor<T> secondStress(const Tensor<T>& F) const {
    const Tensor<T> C = gram(F), E = greenStrain(F), cof = cofactor(C);
    const Tensor<T> B = scaled(1.0 / determinant(C), cof), mixed = product(B, E);
    Tensor<T> S = scaled(2.0 * mu, product(mixed, B));
    const T pressure = lambda * trace(mixed);
    for (std::size_t i = 0; i < 9; ++i) S[i] += pressure * B[i];
    return S;
  }
  template <class T>
  Tensor<T> stress(const Tensor<T>& F) const {
    return product(F, secondStress(F));
  }
  template <class T>
  T energy(const Tensor<T>& F) const {
    return 0.5 * contraction(secondStress(F), greenStrain(F));
  }
};

}  // namespace dovetail::fem::detail
