// Cells of a mesh dealt to ranks.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dovetail::linalg {

/// All ranks that mpirun has started are one team() from now on, where this build has ranks. To be called by all of
/// them.
void meetRanks();

/// Which rank of team() each cell is for: nearly as many to each, and few nodes between them (Scotch, by PETSc's
/// DMPlex); the same whenever it is asked. To be called by all ranks.
/// @param dimension  2 or 3 @param nodes  of the mesh @param corners  numbers of corner nodes, `each` a cell; the same
///                   on all ranks
/// @throws NumericalError as PETSc says it
std::vector<int> partitionCells(int dimension, std::size_t nodes, int each, std::span<const int> corners);

}  // namespace dovetail::linalg
