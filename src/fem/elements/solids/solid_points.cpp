#include "solid_points.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "laws/law_of_field.hpp"

namespace dovetail::fem::detail {

namespace {

class LawPoints final : public SolidPoints {
public:
  explicit LawPoints(std::shared_ptr<const PointMaterial> law) : law_(std::move(law)), size_(law_->historySize()) {}

  double density() const override { return law_->density(); }
  bool isSymmetric() const override { return law_->isSymmetric(); }
  bool isElastic() const override { return law_->isElastic(); }
  bool feelsRates() const override { return law_->feelsRates(); }
  /// A law without potential has no history either that would book what its work leaves.
  bool hasEnergy() const override { return law_->isElastic() || remembers(); }
  double dampingTime() const override { return law_->dampingTime(); }
  bool remembers() const override { return size_ > 0; }
  const PointMaterial* law() const override { return law_.get(); }

  bool isOpen() const override { return isOpen_; }
  void open(std::size_t pointsPerElement, std::span<const PointPlace> places) override {
    isOpen_ = true;
    perElement_ = pointsPerElement;
    if (size_ == 0) return;
    const std::size_t elements = places.size() / perElement_, batches = (elements + laneCount - 1) / laneCount;
    const std::size_t lanes = batches * perElement_ * laneCount;
    history_.resize(lanes * size_);
    for (std::size_t p = 0; p < lanes; ++p) law_->startHistory(std::span(history_).subspan(p * size_, size_));
    newHistory_ = history_;
  }
  ModuliAtRest moduliAtRest() override { return fem::moduliAtRest(*law_); }

  void evaluate(const PointCall& call) override {
    PointBatch batch{};
    batch.groups = perElement_;
    batch.F = reinterpret_cast<const double*>(call.F);
    batch.P = reinterpret_cast<double*>(call.P);
    batch.tangent = reinterpret_cast<double*>(call.tangent);
    batch.energy = reinterpret_cast<double*>(call.energy);
    batch.dissipated = reinterpret_cast<double*>(call.dissipated);
    if (size_ > 0) {
      const std::size_t offset = call.batch * perElement_ * laneCount * size_;
      batch.history = history_.data() + offset;
      batch.newHistory = newHistory_.data() + offset;
    }
    batch.dt = call.dt;
    batch.rateAtEnd = call.rateAtEnd;
    law_->evaluate(batch);
  }

  void commit() override { history_.swap(newHistory_); }
  void revert() override {}
  void save(ByteWriter& archive) const override { archive(history_); }
  void load(ByteReader& archive, const std::string& where) override {
    history_ = readNumbers(archive, history_.size(), where);
  }
  std::string whyInvalid(const double* F, Scrutiny scrutiny) const override {
    return scrutiny == Scrutiny::inversion ? whyInverted(F) : law_->whyInvalid(F);
  }
  std::span<const double> history(std::size_t element, std::size_t point) const override {
    const std::size_t slot = (element / laneCount * perElement_ + point) * laneCount + element % laneCount;
    return std::span(history_).subspan(slot * size_, size_);
  }
  std::size_t memory() const override { return sizeof(double) * (history_.capacity() + newHistory_.capacity()); }

private:
  std::shared_ptr<const PointMaterial> law_;
  std::size_t size_, perElement_ = 0;
  bool isOpen_ = false;
  std::vector<double> history_, newHistory_;
};

}  // namespace

std::vector<double> readNumbers(ByteReader& archive, std::size_t count, const std::string& where) {
  std::vector<double> values;
  archive(values);
  if (values.size() != count)
    throw InputError("the state is that of another solid", where, "load it into the model that wrote it");
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
    throw InputError("the state is not finite", where, "take an older one");
  return values;
}

std::unique_ptr<SolidPoints> pointsOf(std::shared_ptr<const PointMaterial> law) {
  if (law == nullptr) throw InputError("there is no material", "elements", "give one, for instance neoHookean()");
  return std::make_unique<LawPoints>(std::move(law));
}

std::unique_ptr<SolidPoints> pointsOf(std::shared_ptr<PointField> field) {
  if (field == nullptr) throw InputError("there is no field of points", "elements", "give one from pointField()");
  return std::make_unique<FieldPoints>(std::move(field));
}

double FieldPoints::dampingTime() const {
  const PointMaterial* const law = lawOf(answers.field());
  return law ? law->dampingTime() : 0.0;
}

void FieldPoints::open(std::size_t pointsPerElement, std::span<const PointPlace> places) {
  perElement_ = pointsPerElement;
  answers.open(places);
}

/// Lanes that repeat an element are answered for by the last one.
std::size_t FieldPoints::place(std::size_t batch, std::size_t point, std::size_t lane) const {
  const std::size_t element = std::min(laneCount * batch + lane, answers.places().size() / perElement_ - 1);
  return element * perElement_ + point;
}

void FieldPoints::gather(std::size_t batch, const Lane* F) {
  const std::span<double> to = answers.F();
  const std::size_t inUse = std::min<std::size_t>(laneCount, answers.places().size() / perElement_ - laneCount * batch);
  for (std::size_t lane = 0; lane < inUse; ++lane)
    for (std::size_t q = 0; q < perElement_; ++q)
      for (std::size_t k = 0; k < 9; ++k) to[9 * place(batch, q, lane) + k] = F[9 * q + k][static_cast<int>(lane)];
}

void FieldPoints::evaluate(const PointCall& call) {
  for (std::size_t q = 0; q < perElement_; ++q)
    for (std::size_t lane = 0; lane < laneCount; ++lane) {
      const std::size_t p = place(call.batch, q, lane);
      const int l = static_cast<int>(lane);
      for (std::size_t k = 0; k < 9; ++k) call.P[9 * q + k][l] = answers.P()[9 * p + k];
      if (call.tangent != nullptr)
        for (std::size_t k = 0; k < 81; ++k) call.tangent[81 * q + k][l] = answers.tangent()[81 * p + k];
      if (call.energy != nullptr) call.energy[q][l] = answers.energy()[p];
      if (call.dissipated != nullptr) call.dissipated[q][l] = answers.dissipated()[p];
    }
}

ModuliAtRest FieldPoints::moduliAtRest() {
  const std::span<double> F = answers.F();
  for (std::size_t k = 0; k < F.size(); ++k) F[k] = k % 9 % 4 == 0 ? 1.0 : 0.0;
  answers.revert();
  answers.ask({}, {}, {.tangent = true}, answers.field().name());
  ModuliAtRest mean{0.0, 0.0};
  const std::size_t count = answers.places().size();
  for (std::size_t p = 0; p < count; ++p) {
    mean.confined += answers.tangent()[81 * p] / static_cast<double>(count);
    mean.shear += answers.tangent()[81 * p + 10] / static_cast<double>(count);
  }
  answers.revert();
  return mean;
}

std::string FieldPoints::whyInvalid(const double* F, Scrutiny) const { return whyInverted(F); }

}  // namespace dovetail::fem::detail
