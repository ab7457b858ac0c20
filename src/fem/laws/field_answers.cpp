#include "dovetail/fem/laws/field_answers.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::fem {

namespace {

std::string whereIs(const PointPlace& place, const std::string& name) {
  const std::string point = "point " + std::to_string(place.point);
  return place.element < 0 ? point + " of \"" + name + "\""
                           : "element " + std::to_string(place.element) + " of \"" + name + "\", " + point;
}

}  // namespace

void FieldAnswers::open(std::span<const PointPlace> places) {
  places_.assign(places.begin(), places.end());
  F_.resize(9 * places_.size());
  P_.resize(9 * places_.size());
  energy_.resize(places_.size());
  dissipated_.resize(places_.size());
  reason_.resize(places_.size());
  field_->open(places_);
}

bool FieldAnswers::knows(std::span<const Vec3> u, const Instant& now, const Wanted& wanted) const {
  return asked_ && dt_ == now.dt && rateAtEnd_ == now.rateAtEnd && (wanted.toRead || !committed_) &&
         (hasTangent_ || !wanted.tangent) && (hasEnergy_ || !wanted.energy) && std::ranges::equal(u_, u);
}

FieldRequest FieldAnswers::request(const Instant& now, bool moved, const Wanted& wanted) {
  if (wanted.tangent) tangent_.resize(81 * places_.size());
  return {.F = F_,
          .dt = now.dt,
          .moved = moved,
          .P = P_,
          .tangent = wanted.tangent ? std::span<double>(tangent_) : std::span<double>{},
          .energy = energy_,
          .dissipated = dissipated_,
          .reason = reason_,
          .rateAtEnd = now.rateAtEnd,
          .willCommit = now.willCommit,
          .withEnergy = wanted.energy};
}

/// Of the committed state, whose answer was taken without: no time passes from there to the same F.
void FieldAnswers::findEnergies() {
  std::vector<double> P(P_.size()), dissipated(dissipated_.size());
  field_->evaluate({.F = F_,
                    .dt = 0.0,
                    .moved = true,
                    .P = P,
                    .tangent = {},
                    .energy = energy_,
                    .dissipated = dissipated,
                    .reason = reason_});
  hasEnergy_ = true;
}

void FieldAnswers::ask(std::span<const Vec3> u, const Instant& now, const Wanted& wanted, const std::string& name) {
  for (std::string& reason : reason_) reason.clear();
  if (committed_ && knows(u, now, {.tangent = wanted.tangent, .energy = false, .toRead = wanted.toRead})) {
    findEnergies();
    return requireAnswers(name);
  }
  const bool moved = !knows(u, now, {.energy = false});
  asked_ = false;
  field_->evaluate(request(now, moved, wanted));
  requireAnswers(name);
  u_.assign(u.begin(), u.end());
  dt_ = now.dt;
  rateAtEnd_ = now.rateAtEnd;
  asked_ = true;
  hasTangent_ = wanted.tangent;
  hasEnergy_ = wanted.energy || (!moved && hasEnergy_);
  committed_ = false;
}

void FieldAnswers::requireAnswers(const std::string& name) const {
  const double bad = parallelSum(places_.size(), 512, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;  // 0 · value is NaN if the value is not finite
    for (std::size_t p = begin; p < end; ++p) sum += (reason_[p].empty() ? 0.0 : 1.0) + 0.0 * energy_[p];
    for (std::size_t k = 9 * begin; k < 9 * end; ++k) sum += 0.0 * P_[k];
    return sum;
  });
  if (bad == 0.0) return;
  const auto finite = [](std::span<const double> values) {
    return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
  };
  for (std::size_t p = 0; p < places_.size(); ++p) {
    std::string reason = reason_[p];
    if (reason.empty() && !(finite(std::span(P_).subspan(9 * p, 9)) && std::isfinite(energy_[p])))
      reason = "the answer is not finite";
    if (!reason.empty())
      throw NumericalError(reason, whereIs(places_[p], name), "take a smaller step, a finer mesh or a smaller load");
  }
}

void FieldAnswers::commit() {
  field_->commit();
  committed_ = true;
}

void FieldAnswers::revert() {
  field_->revert();
  asked_ = false;
}

void FieldAnswers::save(ByteWriter& archive) const {
  archive(F_, P_, energy_, u_, dt_, rateAtEnd_, asked_, hasEnergy_, committed_);
  field_->save(archive);
}

void FieldAnswers::load(ByteReader& archive) {
  std::vector<double> F, P, energy;
  std::vector<Vec3> u;
  double dt = 0.0;
  bool rateAtEnd = false, asked = false, hasEnergy = false, committed = false;
  archive(F, P, energy, u, dt, rateAtEnd, asked, hasEnergy, committed);
  if (F.size() != F_.size() || P.size() != P_.size() || energy.size() != energy_.size())
    throw InputError("the state is that of other points", field_->name(), "load it into the model that wrote it");
  for (const std::vector<double>* const numbers : {&F, &P, &energy})
    if (!std::ranges::all_of(*numbers, [](double value) { return std::isfinite(value); }))
      throw InputError("the state is not finite", field_->name(), "take an older one");
  field_->load(archive);
  F_ = std::move(F);
  P_ = std::move(P);
  energy_ = std::move(energy);
  u_ = std::move(u);
  dt_ = dt;
  rateAtEnd_ = rateAtEnd;
  asked_ = asked;
  hasTangent_ = false;
  hasEnergy_ = hasEnergy;
  committed_ = committed;
}

std::size_t FieldAnswers::memory() const {
  return sizeof(double) *
             (F_.capacity() + P_.capacity() + tangent_.capacity() + energy_.capacity() + dissipated_.capacity()) +
         sizeof(std::string) * reason_.capacity() + sizeof(Vec3) * u_.capacity() +
         sizeof(PointPlace) * places_.capacity() + field_->memory();
}

}  // namespace dovetail::fem
