// What options of pictures may be.
#pragma once

#include "dovetail/scene/picture.hpp"

namespace dovetail::scene {

/// @throws InputError naming the option of the program that is out of range
void requireValid(const PictureOptions& options);

}  // namespace dovetail::scene
