// Cells before their contacts are looked for.
#pragma once

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// As makeRve, but faces may be close, and there are no contacts and forces yet.
Rve cellWithoutContacts(const Grains& grains, const geometry::Lattice& lattice, const Springs& springs);

}  // namespace dovetail::rve
