// What to write in place of a name that a scene does not know.
#pragma once

#include "dovetail/core/nearest.hpp"

namespace dovetail::scene {

/// As dovetail::adviceFor, with the names of earlier versions.
std::string adviceFor(const std::string& name, const std::vector<std::string>& candidates);

}  // namespace dovetail::scene
