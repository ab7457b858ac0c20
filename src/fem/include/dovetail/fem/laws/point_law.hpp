// Own laws: a small function of F, for any number type, becomes a PointMaterial.
//
//   struct Linear {                                                  // W = μ/2 (F:F − 3 − 2 ln J) + λ/2 (ln J)²
//     double lambda, mu;
//     template <class T>
//     T energy(const Tensor<T>& F) const {
//       using std::log;
//       const T logJ = log(determinant(F));
//       return 0.5 * mu * (contraction(F, F) - 3.0 - 2.0 * logJ) + 0.5 * lambda * logJ * logJ;
//     }
//   };
//   std::shared_ptr<const PointMaterial> material = elasticMaterial("mine", 1000.0, Linear{2e6, 1e6});
#pragma once

#include <concepts>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/fem/laws/jet.hpp"
#include "dovetail/fem/laws/point_material.hpp"
#include "dovetail/fem/laws/tensor.hpp"

namespace dovetail::fem {

/// Where a law writes ∂P_r/∂F_c, r = 3i + J and c = 3k + L, of one point (T = double) or four (T = Four).
template <class T>
class TangentOut {
public:
  explicit TangentOut(double* first) : first_(first) {}
  DOVETAIL_ALWAYS_INLINE void set(std::size_t r, std::size_t c, const T& value) const {
    double* entry = first_ + pointLanes * (9 * r + c);
    if constexpr (std::same_as<T, double>)
      *entry = value;
    else
      value.store(entry);
  }

private:
  double* first_;
};

namespace detail {

template <int order, class T>
Tensor<Jet<T, order>> variables(const Tensor<T>& F) {
  Tensor<Jet<T, order>> jets;
  for (std::size_t i = 0; i < 9; ++i) jets[i] = Jet<T, order>::variable(F[i], i);
  return jets;
}

/// Stress and tangent of a law that gives its energy.
template <class T, class Law>
T respondByEnergy(const Law& law, const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) {
  if (!tangent) {
    const Jet<T, 1> W = law.energy(variables<1>(F));
    P = W.gradient;
    return W.value;
  }
  const Jet<T, 2> W = law.energy(variables<2>(F));
  P = W.gradient;
  for (std::size_t r = 0; r < 9; ++r)
    for (std::size_t c = 0; c < 9; ++c) tangent->set(r, c, W.curvature[Jet<T, 2>::place(r, c)]);
  return W.value;
}

/// Tangent of a law that gives its stress.
template <class T, class Law>
T respondByStress(const Law& law, const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) {
  if (!tangent) {
    P = law.stress(F);
    return law.energy(F);
  }
  const Tensor<Jet<T, 1>> stress = law.stress(variables<1>(F));
  for (std::size_t r = 0; r < 9; ++r) {
    P[r] = stress[r].value;
    for (std::size_t c = 0; c < 9; ++c) tangent->set(r, c, stress[r].gradient[c]);
  }
  return law.energy(F);
}

template <class Law, class T>
concept HasResponse = requires(const Law& law, const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) {
  { law.respond(F, P, tangent) } -> std::convertible_to<T>;
};
template <class Law>
concept HasStress = requires(const Law& law, const Tensor<double>& F) {
  law.stress(F);
};
template <class Law>
concept SaysWhyInvalid = requires(const Law& law, const double* F) {
  law.whyInvalid(F);
};

template <class Law>
constexpr bool hasPotential() {
  if constexpr (requires { Law::hasPotential; })
    return Law::hasPotential;
  else
    return true;
}

/// The number type that a law is evaluated with.
template <class Law>
consteval auto numberOf() {
  if constexpr (requires { Law::branches; })
    return double{};
  else
    return Four{};
}

template <class T, class Law>
T respond(const Law& law, const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) {
  if constexpr (HasResponse<Law, T>)
    return law.respond(F, P, tangent);
  else if constexpr (HasStress<Law>)
    return respondByStress(law, F, P, tangent);
  else
    return respondByEnergy(law, F, P, tangent);
}

inline Four read(const double* p, Four*) { return Four::load(p); }
inline double read(const double* p, double*) { return *p; }
inline void write(const Four& x, double* p) { x.store(p); }
inline void write(double x, double* p) { *p = x; }

/// One group (T = Four) or one lane of it (T = double).
template <class T, class Law>
void evaluateAt(const Law& law, const PointBatch& batch, std::size_t group, std::size_t lane) {
  Tensor<T> F, P;
  for (std::size_t i = 0; i < 9; ++i)
    F[i] = read(batch.F + pointLanes * (9 * group + i) + lane, static_cast<T*>(nullptr));
  T energy;
  if (batch.tangent) {
    const TangentOut<T> tangent(batch.tangent + pointLanes * 81 * group + lane);
    energy = respond(law, F, P, &tangent);
  } else {
    energy = respond<T>(law, F, P, nullptr);
  }
  const T J = determinant(F);
  for (std::size_t i = 0; i < 9; ++i)
    write(wherePositive(J, P[i], std::numeric_limits<double>::quiet_NaN()),
          batch.P + pointLanes * (9 * group + i) + lane);
  if (batch.energy) write(energy, batch.energy + pointLanes * group + lane);
}

/// A law of some type as a material.
template <class Law>
class LawMaterial : public PointMaterial {
public:
  LawMaterial(std::string name, double density, Law law)
      : name_(std::move(name)), density_(requirePositive(density, "density")), law_(std::move(law)) {}
  std::string name() const override { return name_; }
  double density() const override { return density_; }
  std::string whyInvalid(const double* F) const override {
    std::string reason = whyInverted(F);
    if constexpr (SaysWhyInvalid<Law>)
      if (reason.empty()) reason = law_.whyInvalid(F);
    return reason;
  }

protected:
  const Law& law() const { return law_; }

private:
  std::string name_;
  double density_;
  Law law_;
};

template <class Law>
class ElasticMaterial final : public LawMaterial<Law> {
public:
  using LawMaterial<Law>::LawMaterial;
  bool isElastic() const override { return hasPotential<Law>(); }
  bool isSymmetric() const override { return hasPotential<Law>(); }
  void evaluate(const PointBatch& batch) const override {
    using T = decltype(numberOf<Law>());
    constexpr std::size_t step = std::same_as<T, double> ? 1 : pointLanes;
    withVectors([&] {
      for (std::size_t point = 0; point < pointLanes * batch.groups; point += step)
        evaluateAt<T>(this->law(), batch, point / pointLanes, point % pointLanes);
    });
    if (batch.dissipated)
      for (std::size_t point = 0; point < pointLanes * batch.groups; ++point) batch.dissipated[point] = 0.0;
  }
  std::optional<Material> brickLaw() const override {
    if constexpr (requires { this->law().brickLaw(); })
      return this->law().brickLaw();
    else
      return {};
  }
};

}  // namespace detail

/// Wraps an elastic law. It has, for T = double, Four and Jets of both (so: no branch on the values of T, and functions
/// found by `using std::sqrt, std::log …`):
///
///     template <class T> T energy(const Tensor<T>& F) const;           // J/m³; stress and tangent are differentiated
///
/// and may have
///
///     template <class T> Tensor<T> stress(const Tensor<T>& F) const;   // P, Pa; only the tangent is differentiated
///     static constexpr bool hasPotential = false;                      // stress is not the derivative of energy
///     static constexpr bool branches = true;                           // one point at a time: T is double or Jets of
///     it std::string whyInvalid(const double* F) const;
///
/// For speed it may do everything itself: write P, write the tangent unless the pointer is null, return the energy:
///
///     template <class T> T respond(const Tensor<T>& F, Tensor<T>& P, const TangentOut<T>* tangent) const;
///
/// Where det F ≤ 0 the stress becomes NaN, whatever the law says.
/// @param density  reference, kg/m³
/// @throws InputError unless density > 0
template <class Law>
std::shared_ptr<const PointMaterial> elasticMaterial(std::string name, double density, Law law) {
  return std::make_shared<const detail::ElasticMaterial<Law>>(std::move(name), density, std::move(law));
}

}  // namespace dovetail::fem
