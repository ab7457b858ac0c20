#include "dovetail/fem/laws/viscosity.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/laws/lanes.hpp"
#include "dovetail/fem/laws/materials.hpp"
#include "dovetail/fem/laws/vector_code.hpp"
#include "green_moduli.hpp"

namespace dovetail::fem {
namespace {

constexpr std::size_t metricSize = 6;
constexpr std::array<std::size_t, metricSize> metricEntry = {0, 4, 8, 1, 5, 2};  // of a Tensor

class ViscousMaterial final : public PointMaterial {
public:
  explicit ViscousMaterial(KelvinVoigt law)
      : base_(std::move(law.base)),
        lambda_(law.bulkViscosity - 2.0 / 3.0 * law.shearViscosity),
        mu_(law.shearViscosity) {}

  std::string name() const override { return "viscous " + base_->name(); }
  double density() const override { return base_->density(); }
  std::size_t historySize() const override { return metricSize + base_->historySize(); }
  void startHistory(std::span<double> history) const override {
    std::fill_n(history.begin(), metricSize, 0.0);
    std::fill_n(history.begin(), 3, 1.0);
    base_->startHistory(history.subspan(metricSize));
  }
  bool isElastic() const override { return false; }
  bool isSymmetric() const override { return base_->isSymmetric(); }
  std::string whyInvalid(const double* F) const override { return base_->whyInvalid(F); }

  void evaluate(const PointBatch& batch) const override {
    evaluateBase(batch);
    detail::withVectors([&] {
      for (std::size_t group = 0; group < batch.groups; ++group) addViscous(batch, group);
    });
  }

private:
  void evaluateBase(const PointBatch& batch) const {
    PointBatch inner = batch;
    if (batch.dissipated) std::fill_n(batch.dissipated, pointLanes * batch.groups, 0.0);
    const std::size_t size = base_->historySize(), points = pointLanes * batch.groups;
    if (size == 0) return base_->evaluate(inner);
    std::vector<double> history(size * points), newHistory(size * points);
    for (std::size_t p = 0; p < points; ++p)
      std::copy_n(batch.history + p * historySize() + metricSize, size, &history[p * size]);
    inner.history = history.data();
    inner.newHistory = newHistory.data();
    base_->evaluate(inner);
    for (std::size_t p = 0; p < points; ++p)
      std::copy_n(&newHistory[p * size], size, batch.newHistory + p * historySize() + metricSize);
  }

  /// C of the group to the new history; returns C − C_start.
  Tensor<Four> metricChange(const PointBatch& batch, std::size_t group, const Tensor<Four>& F) const {
    const Tensor<Four> C = gram(F);
    Tensor<Four> change;
    for (std::size_t lane = 0; lane < pointLanes; ++lane)
      for (std::size_t k = 0; k < metricSize; ++k) {
        const std::size_t entry = metricEntry[k], place = (pointLanes * group + lane) * historySize() + k;
        const double now = C[entry].v[static_cast<int>(lane)];
        change[entry].v[static_cast<int>(lane)] = now - batch.history[place];
        batch.newHistory[place] = now;
      }
    change[3] = change[1];
    change[6] = change[2];
    change[7] = change[5];
    return change;
  }

  void addViscous(const PointBatch& batch, std::size_t group) const {
    Tensor<Four> F;
    for (std::size_t i = 0; i < 9; ++i) F[i] = Four::load(batch.F + pointLanes * (9 * group + i));
    const Tensor<Four> change = scaled(0.5, metricChange(batch, group, F));
    if (!(batch.dt > 0.0)) return;
    const Four lambda = lambda_ / batch.dt, mu = mu_ / batch.dt;
    Tensor<Four> S = scaled(2.0 * mu, change);
    for (const std::size_t i : {0, 4, 8}) S[i] += lambda * trace(change);
    const Tensor<Four> P = product(F, S);
    const auto add = [](double* place, const Four& x) { (Four::load(place) + x).store(place); };
    for (std::size_t i = 0; i < 9; ++i) add(batch.P + pointLanes * (9 * group + i), P[i]);
    if (batch.dissipated) add(batch.dissipated + pointLanes * group, contraction(S, change));
    if (!batch.tangent) return;
    detail::forGreenModuli(F, S, lambda, mu, [&](std::size_t r, std::size_t c, const Four& entry) {
      double* tangent = batch.tangent + pointLanes * 81 * group;
      add(tangent + pointLanes * (9 * r + c), entry);
      if (c != r) add(tangent + pointLanes * (9 * c + r), entry);
    });
  }

  std::shared_ptr<const PointMaterial> base_;
  double lambda_, mu_;
};

}  // namespace

KelvinVoigt kelvinVoigt(std::shared_ptr<const PointMaterial> base, double time, double youngsModulus,
                        double poissonRatio) {
  requireNonNegative(time, "time");
  validate(Material(StVenantKirchhoff{youngsModulus, poissonRatio, 1.0}));
  const LameConstants lame = lameConstants(youngsModulus, poissonRatio);
  return {std::move(base), time * (lame.lambda + 2.0 / 3.0 * lame.mu), time * lame.mu};
}

std::shared_ptr<const PointMaterial> pointMaterial(const KelvinVoigt& law) {
  if (!law.base)
    throw InputError("there is no base material", "KelvinVoigt", "give the law that viscosity is added to");
  requireNonNegative(law.bulkViscosity, "bulkViscosity");
  requireNonNegative(law.shearViscosity, "shearViscosity");
  return std::make_shared<const ViscousMaterial>(law);
}

}  // namespace dovetail::fem
