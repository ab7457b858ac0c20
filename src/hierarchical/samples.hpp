// Cells that points begin as.
#pragma once

#include <string>
#include <vector>

#include "dovetail/rve/rve.hpp"

namespace dovetail::hierarchical {

/// @throws InputError naming the cell: none there, of another shape or law than the first, deformed, not at rest to
/// `unbalanced`, not under pressure
void validateSamples(const std::vector<rve::Rve>& samples, double unbalanced);

/// "cells of 400 discs", with why they are small.
std::string nameOf(const std::vector<rve::Rve>& samples);

}  // namespace dovetail::hierarchical
