// Text, colour bars, scale bar and axes on pictures.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dovetail/picture/draw.hpp"

namespace dovetail::picture {

enum class Side { left, middle, right };

/// Of a line of text, pixels. @param size  of the letters, about the distance of lines
double widthOf(const std::string& text, double size);

/// Writes a line of UTF-8 text; letters without an outline become empty boxes.
/// @param x, y  of its left end, middle or right end on the base line, pixels from the left top
void write(Image& image, double x, double y, const std::string& text, double size, Colour colour,
           Side side = Side::left);

/// A bar of colours with its title above and numbers below.
struct Bar {
  std::string title;
  std::vector<Colour> colours;
  std::vector<std::pair<double, std::string>> ticks;  ///< fraction of the length, text
};

struct Legend {
  std::string time;  ///< at the left top
  std::vector<Bar> bars;
  std::string length;   ///< of the scale bar; empty: there is none
  double pixels = 0.0;  ///< its length
  bool axes = true;     ///< a triad
  Colour ink{40, 40, 40};
};

/// Heights in pixels that the legend takes at the top and at the bottom of a picture of that size.
std::pair<int, int> roomOf(const Legend& legend, int width, int height);

/// Writes the legend into its room. Axes, bars and scale bar have columns of their own, and titles and numbers are made
/// smaller until they fit them: nothing overlaps.
void write(Image& image, const Legend& legend, const Camera& camera);

}  // namespace dovetail::picture
