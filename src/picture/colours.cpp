#include "dovetail/picture/colours.hpp"

#include <algorithm>
#include <cmath>

namespace dovetail::picture {

Colour between(Colour first, Colour second, double fraction) {
  const auto mixed = [&](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::lround(a + (b - a) * std::clamp(fraction, 0.0, 1.0)));
  };
  return {mixed(first.red, second.red), mixed(first.green, second.green), mixed(first.blue, second.blue)};
}

std::vector<Colour> coloursOf(Palette palette) {
  // Anchors at equal distances.
  std::vector<Colour> anchors;
  if (palette == Palette::cold)
    anchors = {{58, 42, 112},   {55, 88, 146},  {41, 125, 151}, {50, 160, 140},
               {116, 192, 112}, {190, 217, 92}, {246, 231, 110}};
  else if (palette == Palette::warm)
    anchors = {{240, 235, 226}, {245, 214, 168}, {240, 176, 118}, {222, 130, 88},
               {190, 83, 79},   {145, 47, 76},   {92, 24, 66}};
  else
    anchors = {{33, 76, 138},   {86, 140, 188}, {165, 200, 221}, {238, 237, 233},
               {238, 184, 156}, {206, 103, 84}, {148, 33, 48}};
  std::vector<Colour> colours;
  for (int k = 0; k < 256; ++k) {
    const double place = static_cast<double>(anchors.size() - 1) * k / 255.0;
    const std::size_t below = std::min(static_cast<std::size_t>(place), anchors.size() - 2);
    colours.push_back(between(anchors[below], anchors[below + 1], place - static_cast<double>(below)));
  }
  return colours;
}

}  // namespace dovetail::picture
