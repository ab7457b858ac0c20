// The state of a run in bytes, and back: all of it or nothing.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dovetail/core/archive.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem::detail {

/// What a state says of its model.
struct ModelState {
  double t;                              ///< s
  std::vector<Vec3> u, v;                ///< m, m/s
  std::vector<std::vector<char>> terms;  ///< what each remembers
};

/// Accelerations and forces at the end of the last step.
struct StepStart {
  std::vector<Vec3> a;                   ///< m/s²
  std::vector<Vec3> f;                   ///< N
  std::vector<std::vector<Vec3>> loads;  ///< N, of each term that is kept apart; else empty
};

/// @param run  the kind of run: "explicit", "implicit", …
void writeModel(ByteWriter& archive, const std::string& run, const Model& model);
/// The model is left alone.
/// @throws InputError if the state is of another kind of run, has other nodes or terms, or holds a NaN
ModelState readModel(ByteReader& archive, const std::string& run, const Model& model);
/// Puts the state in force. @throws InputError if a term refuses its part; the model is then as it was
void adopt(ModelState state, Model& model);

void writeStart(ByteWriter& archive, const StepStart& start);
/// @throws InputError if there are values for other nodes or terms, or a NaN
StepStart readStart(ByteReader& archive, const Model& model);

std::string readText(ByteReader& archive);
/// @throws InputError if it is not finite
double readNumber(ByteReader& archive, const std::string& what);
/// @throws InputError if it is negative, or beyond what any run counts
std::int64_t readCount(ByteReader& archive, const std::string& what);
/// @throws InputError if there are bytes left
void requireEnd(const ByteReader& archive, const std::string& where);

}  // namespace dovetail::fem::detail
