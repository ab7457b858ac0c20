// Kinematics of four points at a time, flow point by point.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/vector_code.hpp"
#include "log_laws.hpp"

namespace dovetail::fem::detail {
namespace {

/// Fₚ⁻¹ row-major, then what the flow rule remembers.
constexpr std::size_t tensorSize = 9;

Tensor<double> laneOf(const Tensor<Four>& a, int lane) {
  Tensor<double> t;
  for (std::size_t i = 0; i < 9; ++i) t[i] = a[i].v[lane];
  return t;
}

/// Fₚ⁻¹ V e^(−ε_trial) e^ε Vᵀ: the elastic strain went from trial to ε at constant F without rotation.
Tensor<double> plasticInverse(const LogStrain<Four>& trial, int lane, const Six& strain) {
  Tensor<double> left = laneOf(trial.plasticVectors(), lane);
  for (std::size_t i = 0; i < 9; ++i) left[i] /= std::sqrt(trial.squares()[i % 3].v[lane]);
  const Spectrum<double> elastic = spectrum(tensorOf(strain));
  Tensor<double> stretched = elastic.vectors;
  for (std::size_t i = 0; i < 9; ++i) stretched[i] *= std::exp(elastic.value[i % 3]);
  const Tensor<double> exponential = product(stretched, transposed(elastic.vectors));
  return product(left, product(exponential, transposed(laneOf(trial.vectors(), lane))));
}

template <class Flow>
class PlasticMaterial final : public PointMaterial {
public:
  PlasticMaterial(double density, Flow flow) : density_(requirePositive(density, "density")), flow_(std::move(flow)) {}
  std::string name() const override { return flow_.name(); }
  double density() const override { return density_; }
  std::size_t historySize() const override { return tensorSize + flow_.variables(); }
  void startHistory(std::span<double> history) const override {
    std::fill(history.begin(), history.end(), 0.0);
    history[0] = history[4] = history[8] = 1.0;
  }
  bool isElastic() const override { return false; }
  bool isSymmetric() const override { return flow_.isSymmetric(); }
  void evaluate(const PointBatch& batch) const override {
    withVectors([&] {
      for (std::size_t group = 0; group < batch.groups; ++group) evaluateGroup(batch, group);
    });
  }

private:
  /// Stress and stiffness of four points in their frames.
  struct Group {
    SixOf<Four> stress;
    SixBySixOf<Four> stiffness;
  };

  void evaluateGroup(const PointBatch& batch, std::size_t group) const {
    const std::size_t size = historySize(), first = pointLanes * group;
    Tensor<Four> F, inverse;
    for (std::size_t i = 0; i < 9; ++i) {
      F[i] = Four::load(batch.F + pointLanes * (9 * group + i));
      for (std::size_t lane = 0; lane < pointLanes; ++lane)
        inverse[i].v[static_cast<int>(lane)] = batch.history[(first + lane) * size + i];
    }
    const LogStrain<Four> trial(F, inverse);
    const std::array<Four, 3> strain = trial.strain();
    Group answers;
    for (int lane = 0; lane < static_cast<int>(pointLanes); ++lane)
      flow(batch, group, lane, trial,
           {{strain[0].v[lane], strain[1].v[lane], strain[2].v[lane], 0.0, 0.0, 0.0}, laneOf(trial.vectors(), lane)},
           answers);
    const Tensor<Four> P = trial.firstStress(answers.stress);
    const Four J = determinant(F);
    for (std::size_t i = 0; i < 9; ++i)
      wherePositive(J, P[i], std::numeric_limits<double>::quiet_NaN()).store(batch.P + pointLanes * (9 * group + i));
    if (batch.tangent)
      trial.writeTangent(answers.stress, answers.stiffness, flow_.isCoaxial(),
                         TangentOut<Four>(batch.tangent + pointLanes * 81 * group));
  }

  void flow(const PointBatch& batch, std::size_t group, int lane, const LogStrain<Four>& frame,
            const TrialStrain& trial, Group& answers) const {
    const std::size_t size = historySize(), point = pointLanes * group + static_cast<std::size_t>(lane);
    const std::span<const double> history(batch.history + point * size, size);
    const std::span<double> newHistory(batch.newHistory + point * size, size);
    SixBySix stiffness;
    const FlowAnswer answer = flow_.advance(trial, history.subspan(tensorSize), newHistory.subspan(tensorSize),
                                            batch.tangent ? &stiffness : nullptr);
    if (answer.flows) {
      const Tensor<double> inverse = plasticInverse(frame, lane, answer.elasticStrain);
      std::copy(inverse.begin(), inverse.end(), newHistory.begin());
    } else {
      std::copy_n(history.begin(), tensorSize, newHistory.begin());
    }
    for (std::size_t i = 0; i < 6; ++i) answers.stress[i].v[lane] = answer.stress[i];
    if (batch.tangent)
      for (std::size_t i = 0; i < 36; ++i) answers.stiffness[i].v[lane] = stiffness[i];
    if (batch.energy) batch.energy[point] = answer.stored;
    if (batch.dissipated) batch.dissipated[point] = answer.dissipated;
  }

  double density_;
  Flow flow_;
};

}  // namespace

std::shared_ptr<const PointMaterial> plasticMaterial(double density, J2Flow flow) {
  return std::make_shared<const PlasticMaterial<J2Flow>>(density, std::move(flow));
}
std::shared_ptr<const PointMaterial> plasticMaterial(double density, DruckerPragerFlow flow) {
  return std::make_shared<const PlasticMaterial<DruckerPragerFlow>>(density, std::move(flow));
}

}  // namespace dovetail::fem::detail
