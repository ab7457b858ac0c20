#include "share.hpp"

#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::hierarchical {

FarmShare::FarmShare(const CellRecipe& recipe)
    : make_(std::visit([&](const auto& settings) { return cellMaker(recipe.samples, settings); }, recipe.settings)) {}

std::unique_ptr<fem::FieldPoint> FarmShare::unpack(const Parcel& parcel) const {
  std::unique_ptr<fem::FieldPoint> point = make_(parcel.sample);
  if (parcel.state.empty()) return point;
  ByteReader archive(parcel.state);
  point->load(archive);
  return point;
}

void FarmShare::take(const Parcel& parcel) {
  points_.add(unpack(parcel));
  numbers_.push_back(parcel.number);
}

std::vector<char> FarmShare::stateOf(std::uint64_t number) const {
  ByteWriter archive;
  points_[placeOf(number)].save(archive);
  return archive.take();
}

void FarmShare::drop(std::uint64_t number) {
  const std::size_t place = placeOf(number);
  points_.remove(place);
  numbers_.erase(numbers_.begin() + static_cast<std::ptrdiff_t>(place));
}

void FarmShare::clear() {
  numbers_.clear();
  points_ = {};
}

std::vector<int> FarmShare::copies() const {
  std::vector<int> copies;
  for (std::size_t k = 0; k < points_.size(); ++k)
    copies.push_back(dynamic_cast<const CellOwner&>(points_[k]).copies());
  return copies;
}

Answers FarmShare::evaluate(const Question& question) {
  const std::size_t n = points_.size();
  Answers answers;
  answers.P.resize(9 * n);
  answers.energy.resize(n);
  answers.dissipated.resize(n);
  if (question.withTangent) answers.tangent.resize(81 * n);
  std::vector<std::string> reason(n);
  points_.evaluate({.F = question.F,
                    .dt = question.dt,
                    .moved = question.moved,
                    .P = answers.P,
                    .tangent = answers.tangent,
                    .energy = answers.energy,
                    .dissipated = answers.dissipated,
                    .reason = reason,
                    .rateAtEnd = question.rateAtEnd,
                    .willCommit = question.willCommit,
                    .withEnergy = question.withEnergy});
  for (std::size_t k = 0; k < n; ++k)
    if (!reason[k].empty()) answers.reasons.push_back({k, reason[k]});
  answers.seconds.assign(points_.seconds().begin(), points_.seconds().end());
  answers.threads = threads();
  return answers;
}

std::size_t FarmShare::placeOf(std::uint64_t number) const {
  const auto found = std::ranges::find(numbers_, number);
  if (found == numbers_.end())
    throw Error("point " + std::to_string(number) + " is another rank's", "farm of cells", "report this");
  return static_cast<std::size_t>(found - numbers_.begin());
}

}  // namespace dovetail::hierarchical
