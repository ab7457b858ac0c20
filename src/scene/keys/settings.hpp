// Values set from outside of a scene file.
#pragma once

#include <string>

#include "read/json_tree.hpp"

namespace dovetail::scene {

/// Puts the value of "key=value" into the document: of a parameter in "let", or at a path of keys and numbers of items,
/// "walls.0.radius"; keys may be new. The value is JSON, or else text.
/// @throws InputError if there is no '=', no such item of a list, or a key that is nearly that of a parameter
void applySetting(Node& root, const std::string& setting);

}  // namespace dovetail::scene
