// Pictures as rows of pixels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace dovetail::picture {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;  ///< sRGB
  friend bool operator==(const Colour&, const Colour&) = default;
};

/// The colour between two: `first` for 0, `second` for 1.
Colour between(Colour first, Colour second, double fraction);

/// Rows from the top, pixels from the left.
struct Image {
  int width = 0, height = 0;
  std::vector<Colour> pixels;

  Image() = default;
  Image(int w, int h, Colour all)
      : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), all) {}
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  Colour& at(int x, int y) { return pixels[place(x, y)]; }
  const Colour& at(int x, int y) const { return pixels[place(x, y)]; }
};

/// A PNG file of 8 bits per channel. @param program  who made it, its text "Software" @param comment  its "Comment"
std::string pngOf(const Image& image, const std::string& program, const std::string& comment);

/// A GIF file that repeats itself, of 255 colours common to all images. Steps of colour are hidden by a pattern that
/// stands still, so that what does not change between images takes no space.
/// @param images  of one size, at least one @param seconds  per image; players show no less than 0.02
/// @throws InputError if there is none, or sizes differ
std::string gifOf(const std::vector<Image>& images, double seconds, const std::string& program);

}  // namespace dovetail::picture
