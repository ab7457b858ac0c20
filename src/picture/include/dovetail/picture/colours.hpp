// Colours of values.
#pragma once

#include <vector>

#include "dovetail/picture/image.hpp"

namespace dovetail::picture {

/// Lightness rises or falls steadily along `cold` (dark to light) and `warm` (light to dark), so that they also read in
/// grey and with any colour vision. `signs` is light in its middle, blue below and red above.
enum class Palette { cold, warm, signs };

/// 256 colours from the least to the largest value.
std::vector<Colour> coloursOf(Palette palette);

}  // namespace dovetail::picture
