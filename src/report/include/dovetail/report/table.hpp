// JSON and CSV of figures.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "dovetail/io/provenance.hpp"

namespace dovetail::report {

using Json = nlohmann::ordered_json;

/// {key: value, …}, all text.
Json objectOf(const io::KeyValues& rows);
/// The number, or null if it is not finite.
Json numberOrNull(double value);
/// One line per object below the provenance ('#') and a line of names. Fields of an object within are named
/// outer_inner, those of "settings" by their own names; text is quoted, null is nan, true is 1.
/// Columns are those of the entry with the most, then what it lacks and others have; what an entry lacks is nan.
/// @param entries  objects with keys in the same order
std::string csvOf(const std::vector<Json>& entries, const io::KeyValues& provenance);

/// Text of a number, a word or a truth ("yes", "no"); "" for null, and for lists and objects.
std::string textOf(const Json& value);

}  // namespace dovetail::report
