#include "own_state.hpp"

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"

namespace dovetail::rve {

void requireOwn(const Rve& cell, const CellState& state) {
  constexpr const char* where = "state of a cell";
  if (state.x[0].size() != cell.size() || state.x[2].size() != cell.state.x[2].size())
    throw InputError(
        "it is of " + std::to_string(state.x[0].size()) + " grains, the cell has " + std::to_string(cell.size()), where,
        "give back what this cell has saved");
  if (!(state.springs == cell.springs))
    throw InputError("it was saved with other springs", where,
                     "setSprings() those it was saved with before, and the new ones afterwards");
  if (!state.contacts.bond.empty() && !(state.bonds == cell.bonds))
    throw InputError("it was saved with other bonds", where, "give it to the cell that was bonded so");
  // Periods and F have been deformed alike since F was 1.
  const double expected = cell.volume * state.F.determinant();
  if (!(std::abs(state.lattice.volume() - expected) <= 1e-6 * expected))
    throw InputError("its volume does not match its F: it is of another cell, or from before compress()", where,
                     "give back what this cell has saved since F was 1");
}

}  // namespace dovetail::rve
