// A field of cells that several ranks answer for.
#pragma once

#include <memory>
#include <vector>

#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "letters.hpp"
#include "mail.hpp"

namespace dovetail::hierarchical {

/// How points move between ranks.
enum class FarmMoving { whereItPays, atRandom };

/// Cells with a frame stay where they are.
bool mayTravel(const std::vector<rve::Rve>& samples);

/// The answers, states and bytes of the field in one process.
/// @param mail  outlives the field @param moving  at random: for tests, at every commit
std::shared_ptr<fem::PointField> farmedField(const CellRecipe& recipe, Deal deal, Mail& mail,
                                             FarmMoving moving = FarmMoving::whereItPays);

}  // namespace dovetail::hierarchical
