// What letters of a farm say.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/hierarchical/cell_field.hpp"

namespace dovetail::hierarchical {

/// The first byte of a letter to a worker; the number of the field follows. An empty letter: all is over.
enum class Verb : std::uint8_t {
  open,      ///< a recipe
  take,      ///< parcels: points to answer for, from now on
  give,      ///< numbers of points; their states come back, and they are another's
  copy,      ///< numbers of points; their states come back
  clear,     ///< all its points are another's
  count,     ///< copies of the cells come back
  evaluate,  ///< a question about all its points; answers come back
  commit,
  revert,
  close,
  join  ///< of no field: the rank becomes one of a team
};

/// All that points of a field are made from.
struct CellRecipe {
  std::shared_ptr<const std::vector<rve::Rve>> samples;
  std::variant<QuasiStaticCells, DynamicCells> settings;
};
void write(const CellRecipe& recipe, ByteWriter& archive);
CellRecipe readRecipe(ByteReader& archive);

/// A point on its way.
struct Parcel {
  std::uint64_t number = 0;  ///< in the field
  std::uint64_t sample = 0;
  std::vector<char> state;  ///< empty: as the sample
};
template <class Archive, class AnyParcel>
requires std::is_same_v<std::remove_const_t<AnyParcel>, Parcel>
void archiveFields(Archive& archive, AnyParcel& parcel) { archive(parcel.number, parcel.sample, parcel.state); }

/// As fem::FieldRequest, of the points of one rank.
struct Question {
  double dt = 0.0;
  bool moved = false, rateAtEnd = false, willCommit = false, withEnergy = false, withTangent = false;
  std::vector<double> F;
};
template <class Archive, class AnyQuestion>
requires std::is_same_v<std::remove_const_t<AnyQuestion>, Question>
void archiveFields(Archive& archive, AnyQuestion& question) {
  archive(question.dt, question.moved, question.rateAtEnd, question.willCommit, question.withEnergy,
          question.withTangent, question.F);
}

/// Why a point has no answer.
struct Reason {
  std::uint64_t place = 0;  ///< among the points of the rank
  std::string text;
};
template <class Archive, class AnyReason>
requires std::is_same_v<std::remove_const_t<AnyReason>, Reason>
void archiveFields(Archive& archive, AnyReason& reason) { archive(reason.place, reason.text); }

struct Answers {
  std::vector<double> P, tangent, energy, dissipated;
  std::vector<double> seconds;  ///< that each point took
  std::vector<Reason> reasons;
  int threads = 1;  ///< of the rank
};
template <class Archive, class AnyAnswers>
requires std::is_same_v<std::remove_const_t<AnyAnswers>, Answers>
void archiveFields(Archive& archive, AnyAnswers& answers) {
  archive(answers.P, answers.tangent, answers.energy, answers.dissipated, answers.seconds, answers.reasons,
          answers.threads);
}

}  // namespace dovetail::hierarchical
