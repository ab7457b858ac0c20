// Own laws that remember: one step at one point, for any number type, becomes a PointMaterial.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "dovetail/fem/laws/point_law.hpp"

namespace dovetail::fem {

/// One step at one point.
template <class T>
struct PointStep {
  Tensor<T> F;                      ///< at the end of the step
  double dt;                        ///< s; 0 where no time passes
  std::span<const double> history;  ///< at its start
  Tensor<T> P;                      ///< out: first Piola–Kirchhoff stress at the end, Pa
  std::span<double> newHistory;     ///< out: at the end
  double energy = 0.0;              ///< out: stored, J/m³
  double dissipated = 0.0;          ///< out: in this step, J/m³, ≥ 0
};

namespace detail {

template <class Law>
concept HasOwnTangent = requires(const Law& law, PointStep<double>& step, const TangentOut<double>* tangent) {
  law.step(step, tangent);
};
template <class Law>
concept StartsHistory = requires(const Law& law, std::span<double> history) {
  law.start(history);
};

template <class Law>
void stepAt(const Law& law, PointStep<double>& step, const TangentOut<double>* tangent) {
  if constexpr (HasOwnTangent<Law>) {
    law.step(step, tangent);
  } else if (!tangent) {
    law.step(step);
  } else {
    PointStep<Jet<double, 1>> jets{variables<1>(step.F), step.dt, step.history, {}, step.newHistory};
    law.step(jets);
    step.energy = jets.energy;
    step.dissipated = jets.dissipated;
    for (std::size_t r = 0; r < 9; ++r) {
      step.P[r] = jets.P[r].value;
      for (std::size_t c = 0; c < 9; ++c) tangent->set(r, c, jets.P[r].gradient[c]);
    }
  }
}

template <class Law>
class HistoryMaterial final : public LawMaterial<Law> {
public:
  using LawMaterial<Law>::LawMaterial;
  std::size_t historySize() const override { return this->law().historySize(); }
  void startHistory(std::span<double> history) const override {
    if constexpr (StartsHistory<Law>)
      this->law().start(history);
    else
      std::fill(history.begin(), history.end(), 0.0);
  }
  bool isElastic() const override { return false; }
  bool isSymmetric() const override {
    if constexpr (requires { this->law().isSymmetric(); })
      return this->law().isSymmetric();
    else
      return false;
  }
  void evaluate(const PointBatch& batch) const override {
    for (std::size_t point = 0; point < pointLanes * batch.groups; ++point) evaluatePoint(batch, point);
  }

private:
  void evaluatePoint(const PointBatch& batch, std::size_t point) const {
    const std::size_t group = point / pointLanes, lane = point % pointLanes, size = this->law().historySize();
    PointStep<double> step{
        {}, batch.dt, {batch.history + point * size, size}, {}, {batch.newHistory + point * size, size}};
    for (std::size_t i = 0; i < 9; ++i) step.F[i] = batch.F[pointLanes * (9 * group + i) + lane];
    if (determinant(step.F) > 0.0) {
      const TangentOut<double> tangent(batch.tangent ? batch.tangent + pointLanes * 81 * group + lane : nullptr);
      stepAt(this->law(), step, batch.tangent ? &tangent : nullptr);
    } else {
      step.P.fill(std::numeric_limits<double>::quiet_NaN());
      std::copy(step.history.begin(), step.history.end(), step.newHistory.begin());
    }
    for (std::size_t i = 0; i < 9; ++i) batch.P[pointLanes * (9 * group + i) + lane] = step.P[i];
    if (batch.energy) batch.energy[point] = step.energy;
    if (batch.dissipated) batch.dissipated[point] = step.dissipated;
  }
};

}  // namespace detail

/// Wraps a law with history. It has
///
///     std::size_t historySize() const;
///     template <class T> void step(PointStep<T>& step) const;   // T = double and Jet<double, 1>; may branch
///
/// reads step.F, dt and history, and writes P, newHistory (through valueOf()), energy and dissipated. The tangent is
/// differentiated, through iterations too if they do one more round after they have converged. It may have
///
///     void start(std::span<double> history) const;              // of a point never loaded; otherwise zeros
///   bool isSymmetric() const;                                 // otherwise false
///     std::string whyInvalid(const double* F) const;
///
/// For speed it may have, in place of the template, a step that writes the tangent unless the pointer is null:
///
///   void step(PointStep<double>& step, const TangentOut<double>* tangent) const;
///
/// Where det F ≤ 0 it is not asked: the stress is NaN.
/// @param density  reference, kg/m³
/// @throws InputError unless density > 0
template <class Law>
std::shared_ptr<const PointMaterial> historyMaterial(std::string name, double density, Law law) {
  return std::make_shared<const detail::HistoryMaterial<Law>>(std::move(name), density, std::move(law));
}

}  // namespace dovetail::fem
