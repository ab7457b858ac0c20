// A field of cells that several ranks answer for.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "letters.hpp"
#include "mail.hpp"

namespace dovetail::hierarchical {

/// How points move between ranks.
enum class FarmMoving { whereItPays, atRandom };

/// Whether bytes make the same cells: not where they have frames, or masses of their own.
bool mayTravel(const std::vector<rve::Rve>& samples);

/// The answers, states and bytes of the field in one process.
/// @param mail  outlives the field @param moving  at random: for tests, at every commit
std::shared_ptr<fem::PointField> farmedField(const CellRecipe& recipe, Deal deal, Mail& mail,
                                             FarmMoving moving = FarmMoving::whereItPays);

/// Of the cell of a point; nothing for other fields.
std::optional<int> copiesInFarm(const fem::PointField& field, std::size_t point);

}  // namespace dovetail::hierarchical
