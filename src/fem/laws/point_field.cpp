#include "dovetail/fem/laws/point_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/laws/field_history.hpp"
#include "dovetail/fem/laws/point_material.hpp"
#include "dovetail/fem/laws/point_tasks.hpp"
#include "law_of_field.hpp"

namespace dovetail::fem {

namespace {

constexpr std::size_t lanes = pointLanes;

/// Points of a law in groups of four; lanes beyond the last point repeat it.
class LawField final : public PointField {
public:
  explicit LawField(std::shared_ptr<const PointMaterial> law) : law_(std::move(law)), size_(law_->historySize()) {}

  const PointMaterial& law() const { return *law_; }
  std::span<const double> history() const { return std::span(history_).first(points_ * size_); }
  std::string name() const override { return law_->name(); }
  double density() const override { return law_->density(); }
  bool isSymmetric() const override { return law_->isSymmetric(); }
  bool feelsRates() const override { return law_->feelsRates(); }
  bool hasEnergy() const override { return law_->isElastic() || size_ > 0; }

  void open(std::span<const PointPlace> places) override {
    points_ = places.size();
    history_.resize(groups() * lanes * size_);
    for (std::size_t p = 0; size_ > 0 && p < groups() * lanes; ++p)
      law_->startHistory(std::span(history_).subspan(p * size_, size_));
    newHistory_ = history_;
  }

  void evaluate(const FieldRequest& request) override {
    if (!request.moved && request.tangent.empty() && !request.withEnergy) return;
    parallelFor(groups(), 16, [&](std::size_t begin, std::size_t end) {
      Group group;
      for (std::size_t g = begin; g < end; ++g) {
        if (!evaluate(g, request, group)) continue;
        for (std::size_t lane = 0; lane < lanes && lanes * g + lane < points_; ++lane)
          hand(group, lane, lanes * g + lane, request);
      }
    });
  }

  void commit() override { history_.swap(newHistory_); }
  void revert() override {}
  void save(ByteWriter& archive) const override { archive(history_); }
  void load(ByteReader& archive) override {
    std::vector<double> values;
    archive(values);
    if (values.size() != history_.size() || !std::ranges::all_of(values, [](double v) { return std::isfinite(v); }))
      throw InputError("the state is not one of " + std::to_string(points_) + " points", name(),
                       "load it into the model that wrote it");
    history_ = std::move(values);
  }
  std::size_t memory() const override { return sizeof(double) * (history_.capacity() + newHistory_.capacity()); }

private:
  struct alignas(32) Group {
    std::array<double, 9 * lanes> F, P;
    std::array<double, 81 * lanes> tangent;
    std::array<double, lanes> energy, dissipated;
  };
  std::size_t groups() const { return (points_ + lanes - 1) / lanes; }

  /// @return whether the law answered; else its points have the reason
  bool evaluate(std::size_t g, const FieldRequest& request, Group& group) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t p = std::min(lanes * g + lane, points_ - 1);
      for (std::size_t k = 0; k < 9; ++k) group.F[lanes * k + lane] = request.F[9 * p + k];
    }
    const std::size_t offset = g * lanes * size_;
    PointBatch batch{1,
                     group.F.data(),
                     group.P.data(),
                     request.tangent.empty() ? nullptr : group.tangent.data(),
                     group.energy.data(),
                     group.dissipated.data(),
                     history_.data() + offset,
                     newHistory_.data() + offset,
                     request.dt,
                     request.rateAtEnd};
    group.dissipated.fill(0.0);
    try {
      law_->evaluate(batch);
    } catch (const std::exception& error) {
      for (std::size_t p = lanes * g; p < std::min(lanes * (g + 1), points_); ++p) request.reason[p] = error.what();
      return false;
    }
    return true;
  }

  void hand(const Group& group, std::size_t lane, std::size_t p, const FieldRequest& request) const {
    for (std::size_t k = 0; k < 9; ++k) request.P[9 * p + k] = group.P[lanes * k + lane];
    for (std::size_t k = 0; k < 81 && !request.tangent.empty(); ++k)
      request.tangent[81 * p + k] = group.tangent[lanes * k + lane];
    request.energy[p] = group.energy[lane];
    request.dissipated[p] = group.dissipated[lane];
  }

  std::shared_ptr<const PointMaterial> law_;
  std::size_t size_, points_ = 0;
  std::vector<double> history_, newHistory_;
};

class PointwiseField final : public PointField {
public:
  using Make = std::function<std::unique_ptr<FieldPoint>(const PointPlace&)>;
  PointwiseField(FieldTraits traits, Make make) : traits_(std::move(traits)), make_(std::move(make)) {}

  std::string name() const override { return traits_.name; }
  double density() const override { return traits_.density; }
  bool isSymmetric() const override { return traits_.isSymmetric; }
  bool hasEnergy() const override { return traits_.hasEnergy; }

  void open(std::span<const PointPlace> places) override {
    places_.assign(places.begin(), places.end());
    points_ = newPoints();
  }
  void evaluate(const FieldRequest& request) override { points_.evaluate(request); }
  void commit() override { points_.commit(); }
  void revert() override { points_.revert(); }
  void save(ByteWriter& archive) const override {
    archive(static_cast<std::uint64_t>(points_.size()));
    for (std::size_t p = 0; p < points_.size(); ++p) points_[p].save(archive);
  }
  void load(ByteReader& archive) override {
    readPointCount(archive, points_.size(), name());
    PointTasks loaded = newPoints();
    for (std::size_t p = 0; p < loaded.size(); ++p) loaded[p].load(archive);
    points_ = std::move(loaded);
  }

  const FieldPoint* point(std::size_t p) const override { return &points_[p]; }
  std::vector<double> seconds() const override { return {points_.seconds().begin(), points_.seconds().end()}; }

private:
  PointTasks newPoints() const {
    PointTasks points;
    for (const PointPlace& place : places_) {
      std::unique_ptr<FieldPoint> point = make_(place);
      if (point == nullptr)
        throw InputError("there is no point of element " + std::to_string(place.element), name(),
                         "let makePoint return one for every place");
      points.add(std::move(point));
    }
    return points;
  }

  FieldTraits traits_;
  Make make_;
  std::vector<PointPlace> places_;
  PointTasks points_;
};

}  // namespace

const PointMaterial* lawOf(const PointField& field) {
  const auto* const made = dynamic_cast<const LawField*>(&field);
  return made ? &made->law() : nullptr;
}

std::span<const double> historyOf(const PointField& field) {
  const auto* const made = dynamic_cast<const LawField*>(&field);
  return made ? made->history() : std::span<const double>{};
}

std::shared_ptr<PointField> pointField(std::shared_ptr<const PointMaterial> law) {
  if (law == nullptr) throw InputError("there is no law", "pointField", "give one, for instance neoHookean()");
  return std::make_shared<LawField>(std::move(law));
}

std::shared_ptr<PointField> pointField(const FieldTraits& traits,
                                       std::function<std::unique_ptr<FieldPoint>(const PointPlace&)> makePoint) {
  requirePositive(traits.density, "density");
  if (traits.name.empty()) throw InputError("the field has no name", "pointField", "give one for reports");
  if (!makePoint) throw InputError("nothing makes the points", "pointField", "give a function that does");
  return std::make_shared<PointwiseField>(traits, std::move(makePoint));
}

}  // namespace dovetail::fem
