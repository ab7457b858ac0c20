// A solid whose elements are dealt to the ranks of a team.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "solid_cells.hpp"

namespace dovetail::fem::detail {

/// Leaves the elements that are this rank's. @return numbers in the mesh of those of all ranks, rank after rank;
/// nothing, and leaves all, where they are too few for so many ranks
std::optional<std::vector<std::vector<int>>> keepShare(SolidCells& cells);

/// @param share  with the elements of this rank @param numbers  what keepShare() has returned
std::shared_ptr<Solid> solidOnRanks(const std::shared_ptr<Solid>& share, const std::vector<std::vector<int>>& numbers);

}  // namespace dovetail::fem::detail
