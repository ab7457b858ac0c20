#pragma once

#include <string>

#include "read/json_tree.hpp"

namespace dovetail::scene {

/// Looks at the key "version" of a file, which may be missing.
/// @throws InputError if it is no version, or a later one than this program's
void requireKnownVersion(const Node& root, const std::string& name);

}  // namespace dovetail::scene
