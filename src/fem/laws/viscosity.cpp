#include "dovetail/fem/laws/viscosity.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/fem/laws/lanes.hpp"
#include "dovetail/fem/laws/material_probe.hpp"
#include "dovetail/fem/laws/materials.hpp"
#include "green_moduli.hpp"

namespace dovetail::fem {
namespace {

constexpr std::size_t metricSize = 6;
static_assert(viscousHistory == 2 * metricSize + 1);
/// C at the start of the step; the mean rate of ½C in the step before it, and its length (0: there was none).
constexpr std::size_t ownSize = 2 * metricSize + 1, ratePlace = metricSize, lengthPlace = 2 * metricSize;
constexpr std::array<std::size_t, metricSize> metricEntry = {0, 4, 8, 1, 5, 2};  // of a Tensor

class ViscousMaterial final : public PointMaterial {
public:
  explicit ViscousMaterial(KelvinVoigt law)
      : base_(std::move(law.base)),
        size_(ownSize + base_->historySize()),
        lambda_(law.bulkViscosity - 2.0 / 3.0 * law.shearViscosity),
        mu_(law.shearViscosity) {}

  std::string name() const override { return "viscous " + base_->name(); }
  double density() const override { return base_->density(); }
  std::size_t historySize() const override { return size_; }
  void startHistory(std::span<double> history) const override {
    std::fill_n(history.begin(), ownSize, 0.0);
    std::fill_n(history.begin(), 3, 1.0);
    base_->startHistory(history.subspan(ownSize));
  }
  bool isElastic() const override { return false; }
  double dampingTime() const override {
    const auto [confined, shear] = moduliAtRest(*base_);
    return std::max((lambda_ + 2.0 * mu_) / confined, mu_ / shear);
  }
  bool feelsRates() const override { return true; }
  bool isSymmetric() const override { return base_->isSymmetric(); }
  std::string whyInvalid(const double* F) const override { return base_->whyInvalid(F); }

  void evaluate(const PointBatch& batch) const override {
    evaluateBase(batch);
    withVectors([&] {
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
    for (std::size_t p = 0; p < points; ++p) std::copy_n(batch.history + p * size_ + ownSize, size, &history[p * size]);
    inner.history = history.data();
    inner.newHistory = newHistory.data();
    base_->evaluate(inner);
    for (std::size_t p = 0; p < points; ++p)
      std::copy_n(&newHistory[p * size], size, batch.newHistory + p * size_ + ownSize);
  }

  /// Entry k of what the points of a group remember, and where the new ones go.
  Four remembered(const PointBatch& batch, std::size_t group, std::size_t k) const {
    Four value;
    for (std::size_t lane = 0; lane < pointLanes; ++lane)
      value.v[static_cast<int>(lane)] = batch.history[(pointLanes * group + lane) * size_ + k];
    return value;
  }
  void remember(const PointBatch& batch, std::size_t group, std::size_t k, const Four& value) const {
    for (std::size_t lane = 0; lane < pointLanes; ++lane)
      batch.newHistory[(pointLanes * group + lane) * size_ + k] = value.v[static_cast<int>(lane)];
  }

  static void fillSymmetric(Tensor<Four>& tensor) {
    tensor[3] = tensor[1];
    tensor[6] = tensor[2];
    tensor[7] = tensor[5];
  }

  /// C of the group to the new history; returns C − C_start.
  Tensor<Four> metricChange(const PointBatch& batch, std::size_t group, const Tensor<Four>& F) const {
    const Tensor<Four> C = gram(F);
    Tensor<Four> change;
    for (std::size_t k = 0; k < metricSize; ++k) {
      change[metricEntry[k]] = C[metricEntry[k]] - remembered(batch, group, k);
      remember(batch, group, k, C[metricEntry[k]]);
    }
    fillSymmetric(change);
    return change;
  }

  /// The rate of this step to the new history; where no time passes the old one stays. Only steps that ask for rates at
  /// their end keep one.
  void keepRate(const PointBatch& batch, std::size_t group, const Tensor<Four>& change) const {
    const bool moves = batch.dt > 0.0;
    if (moves && !batch.rateAtEnd) return forgetRate(batch, group);
    for (std::size_t k = 0; k < metricSize; ++k)
      remember(batch, group, ratePlace + k,
               moves ? change[metricEntry[k]] / batch.dt : remembered(batch, group, ratePlace + k));
    remember(batch, group, lengthPlace, moves ? Four(batch.dt) : remembered(batch, group, lengthPlace));
  }
  void forgetRate(const PointBatch& batch, std::size_t group) const {
    for (std::size_t lane = 0; lane < pointLanes; ++lane)
      std::fill_n(batch.newHistory + (pointLanes * group + lane) * size_ + ratePlace, metricSize + 1, 0.0);
  }

  /// S of a rate of Green's strain. @param lambda, mu  viscosities, over the time that `strain` took
  static Tensor<Four> stressOf(const Tensor<Four>& strain, const Four& lambda, const Four& mu) {
    Tensor<Four> S = scaled(2.0 * mu, strain);
    for (const std::size_t i : {0, 4, 8}) S[i] += lambda * trace(strain);
    return S;
  }

  /// How far the line through the mean rates of two steps goes on behind the middle of the second one, in parts of
  /// their difference: to its end, or nowhere.
  Four beyond(const PointBatch& batch, std::size_t group) const {
    Four part(0.0);
    for (std::size_t lane = 0; batch.rateAtEnd && lane < pointLanes; ++lane)
      if (const double before = remembered(batch, group, lengthPlace).v[static_cast<int>(lane)]; before > 0.0)
        part.v[static_cast<int>(lane)] = batch.dt / (batch.dt + before);
    return part;
  }

  void addViscous(const PointBatch& batch, std::size_t group) const {
    Tensor<Four> F;
    for (std::size_t i = 0; i < 9; ++i) F[i] = Four::load(batch.F + pointLanes * (9 * group + i));
    const Tensor<Four> change = scaled(0.5, metricChange(batch, group, F));
    keepRate(batch, group, change);
    if (!(batch.dt > 0.0)) return;
    Four lambda = lambda_ / batch.dt, mu = mu_ / batch.dt;
    Tensor<Four> S = stressOf(change, lambda, mu);
    const auto add = [](double* place, const Four& x) { (Four::load(place) + x).store(place); };
    if (batch.dissipated) add(batch.dissipated + pointLanes * group, contraction(S, change));
    if (batch.rateAtEnd) {
      const Four part = beyond(batch, group);
      Tensor<Four> before;
      for (std::size_t k = 0; k < metricSize; ++k) before[metricEntry[k]] = remembered(batch, group, ratePlace + k);
      fillSymmetric(before);
      const Tensor<Four> rate = stressOf(before, lambda_, mu_);
      for (std::size_t i = 0; i < 9; ++i) S[i] += part * (S[i] - rate[i]);
      lambda = (1.0 + part) * lambda, mu = (1.0 + part) * mu;
    }
    const Tensor<Four> P = product(F, S);
    for (std::size_t i = 0; i < 9; ++i) add(batch.P + pointLanes * (9 * group + i), P[i]);
    if (!batch.tangent) return;
    detail::forGreenModuli(F, S, lambda, mu, [&](std::size_t r, std::size_t c, const Four& entry) {
      double* tangent = batch.tangent + pointLanes * 81 * group;
      add(tangent + pointLanes * (9 * r + c), entry);
      if (c != r) add(tangent + pointLanes * (9 * c + r), entry);
    });
  }

  std::shared_ptr<const PointMaterial> base_;
  std::size_t size_;  // numbers per point
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
