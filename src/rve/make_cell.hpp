// Cells before their contacts are looked for.
#pragma once

#include "dovetail/rve/cell.hpp"

namespace dovetail::rve {

/// As makeCell, but faces may be close, and there are no contacts and forces yet.
Cell cellWithoutContacts(const Grains& grains, const geometry::Lattice& lattice, const Springs& springs);

}  // namespace dovetail::rve
