// Filled outlines with smooth edges.
#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

#include "dovetail/picture/image.hpp"

namespace dovetail::picture {

/// Fractions of pixels that lie inside outlines, from the signed areas beside their edges. What leaves the picture
/// sideways or upwards is cut off.
class Coverage {
public:
  explicit Coverage(const Image& image);
  /// An edge of an outline that closes, pixels from the left top.
  void edge(double x0, double y0, double x1, double y1);
  /// An outline by its corners.
  void outline(std::initializer_list<std::pair<double, double>> corners);
  /// A line of some width.
  void line(double x0, double y0, double x1, double y1, double width);
  /// Lays the colour over the picture where the outlines are.
  void paint(Image& image, Colour colour) const;

private:
  int width_, height_;
  int top_, bottom_;  // rows that anything lies in
  std::vector<float> area_;
};

}  // namespace dovetail::picture
