// Names and units of what experiments give.
#pragma once

#include <optional>
#include <string>

#include "dovetail/calibration/calibration.hpp"

namespace dovetail::calibration {

/// The unit of a quantity; none where nobody knows: columns of a series without a unit in their name.
/// @throws InputError at `where` if the probe has no such quantity
std::optional<scene::Dimension> dimensionOf(const Experiment& experiment, const std::string& quantity,
                                            const std::string& where);

}  // namespace dovetail::calibration
