#include "coverage.hpp"

#include <algorithm>
#include <cmath>

namespace dovetail::picture {

// Columns on either side take what is cut off.
Coverage::Coverage(const Image& image)
    : width_(image.width + 2),
      height_(image.height),
      top_(image.height),
      bottom_(0),
      area_(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height_)) {}

void Coverage::edge(double x0, double y0, double x1, double y1) {
  if (y0 == y1) return;
  const double sign = y0 < y1 ? 1.0 : -1.0;
  if (sign < 0.0) std::swap(x0, x1), std::swap(y0, y1);
  const double slope = (x1 - x0) / (y1 - y0);
  const int first = std::max(0, static_cast<int>(std::floor(y0))),
            last = std::min(height_, static_cast<int>(std::ceil(y1)));
  top_ = std::min(top_, first);
  bottom_ = std::max(bottom_, last);
  for (int y = first; y < last; ++y) {
    const double above = std::max<double>(y, y0), below = std::min<double>(y + 1, y1);
    const auto inside = [&](double x) { return std::clamp(x + 1.0, 0.0, width_ - 1e-3); };
    const double from = inside(x0 + (above - y0) * slope), to = inside(x0 + (below - y0) * slope);
    const double low = std::min(from, to), high = std::max(from, to), height = sign * (below - above);
    float* const row = &area_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1)];
    // What lies to the right of the edge, in each pixel that it crosses and all in the next one.
    double before = 0.0;
    for (int x = static_cast<int>(low); x <= static_cast<int>(high); ++x) {
      const double left = std::max<double>(low, x), right = std::min<double>(high, x + 1);
      const double fraction = high > low ? (right - left) / (high - low) : 1.0;
      const double now = height * fraction * (x + 1 - 0.5 * (left + right));
      row[x] += static_cast<float>(now + before);
      before = height * fraction - now;
    }
    row[static_cast<int>(high) + 1] += static_cast<float>(before);
  }
}

void Coverage::outline(std::initializer_list<std::pair<double, double>> corners) {
  auto before = std::prev(corners.end());
  for (auto now = corners.begin(); now != corners.end(); before = now++)
    edge(before->first, before->second, now->first, now->second);
}

void Coverage::line(double x0, double y0, double x1, double y1, double width) {
  const double length = std::hypot(x1 - x0, y1 - y0);
  if (length == 0.0) return;
  const double nx = -0.5 * width * (y1 - y0) / length, ny = 0.5 * width * (x1 - x0) / length;
  outline({{x0 + nx, y0 + ny}, {x1 + nx, y1 + ny}, {x1 - nx, y1 - ny}, {x0 - nx, y0 - ny}});
}

void Coverage::paint(Image& image, Colour colour) const {
  for (int y = top_; y < bottom_; ++y) {
    const float* const row = &area_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1)];
    double sum = row[0];
    for (int x = 0; x < image.width; ++x) {
      sum += row[x + 1];
      if (const double inside = std::min(1.0, std::abs(sum)); inside > 1e-3)
        image.at(x, y) = between(image.at(x, y), colour, inside);
    }
  }
}

}  // namespace dovetail::picture
