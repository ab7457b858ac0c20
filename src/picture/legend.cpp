#include "dovetail/picture/legend.hpp"

#include <algorithm>
#include <cmath>

#include "coverage.hpp"

namespace dovetail::picture {

namespace {

double sizeOfText(int width, int height) { return std::clamp(std::min(width / 56.0, height / 17.0), 8.0, 60.0); }

/// A column of the legend at the bottom.
struct Column {
  double left, right, top;  // pixels
  double size;              // of the text
  double width() const { return right - left; }
  double middle() const { return 0.5 * (left + right); }
};

void writeFitting(Image& image, const Column& column, double y, const std::string& text, Colour ink) {
  const double size = column.size * std::min(1.0, column.width() / std::max(1.0, widthOf(text, column.size)));
  write(image, column.middle(), y, text, size, ink, Side::middle);
}

/// Numbers below a bar. Where they do not fit, every second one stays away.
void writeTicks(Image& image, const Column& column, double y, const Bar& bar, Colour ink) {
  const double size = 0.88 * column.size;
  std::size_t apart = 1;
  double all = 0.0;
  for (const auto& tick : bar.ticks) all += widthOf(tick.second, size) + size;
  while (all / static_cast<double>(apart) > column.width() && apart < bar.ticks.size()) apart *= 2;
  Coverage marks(image);
  for (std::size_t k = 0; k < bar.ticks.size(); k += apart) {
    const auto& [fraction, text] = bar.ticks[k];
    const double at = column.left + fraction * column.width(), half = 0.5 * widthOf(text, size);
    marks.line(at, y, at, y + 0.25 * size, std::max(1.0, 0.06 * size));
    const double middle = std::clamp(at, column.left + half - size, column.right - half + size);
    write(image, middle, y + 1.25 * size, text, size, ink, Side::middle);
  }
  marks.paint(image, ink);
}

void writeBar(Image& image, const Column& column, const Bar& bar, Colour ink) {
  const double size = column.size, top = column.top + 1.45 * size, bottom = top + 0.7 * size;
  writeFitting(image, column, column.top + size, bar.title, ink);
  for (int x = static_cast<int>(std::lround(column.left)); x < std::lround(column.right); ++x) {
    const double fraction = (x + 0.5 - column.left) / column.width();
    const auto k = static_cast<std::size_t>(std::clamp(fraction, 0.0, 0.999) * static_cast<double>(bar.colours.size()));
    for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y) image.at(x, y) = bar.colours[k];
  }
  writeTicks(image, column, std::floor(bottom), bar, ink);
}

void writeLength(Image& image, const Column& column, const Legend& legend) {
  const double size = column.size, y = column.top + 1.8 * size, width = std::max(1.0, 0.1 * size);
  const double left = column.middle() - 0.5 * legend.pixels, right = left + legend.pixels, half = 0.3 * size;
  Coverage bar(image);
  bar.line(left, y, right, y, width);
  bar.line(left, y - half, left, y + half, width);
  bar.line(right, y - half, right, y + half, width);
  bar.paint(image, legend.ink);
  write(image, column.middle(), y + 1.45 * size, legend.length, size, legend.ink, Side::middle);
}

void writeAxes(Image& image, const Column& column, const Camera& camera, Colour ink) {
  const double size = column.size, length = 1.35 * size;
  const char* const names[] = {"x", "y", "z"};
  // The origin is put where the axes and their names are in the middle of the column.
  double low[2] = {0.0, 0.0}, high[2] = {0.0, 0.0};
  const auto at = [&](int k) { return std::pair{length * camera.right[k], -length * camera.up[k]}; };
  for (int k = 0; k < 3; ++k) {
    low[0] = std::min(low[0], at(k).first), high[0] = std::max(high[0], at(k).first);
    low[1] = std::min(low[1], at(k).second), high[1] = std::max(high[1], at(k).second);
  }
  const double x = column.middle() - 0.5 * (low[0] + high[0]), y = column.top + 1.9 * size - 0.5 * (low[1] + high[1]);
  for (int k = 0; k < 3; ++k) {
    const auto [dx, dy] = at(k);
    const double seen = std::hypot(dx, dy);
    if (seen < 0.15 * length) continue;  // it points to the viewer or away
    Coverage arrow(image);
    const double ux = dx / seen, uy = dy / seen, head = 0.4 * size, half = 0.16 * size;
    arrow.line(x, y, x + dx - head * ux, y + dy - head * uy, std::max(1.0, 0.09 * size));
    arrow.outline({{x + dx, y + dy},
                   {x + dx - head * ux - half * uy, y + dy - head * uy + half * ux},
                   {x + dx - head * ux + half * uy, y + dy - head * uy - half * ux}});
    arrow.paint(image, ink);
    write(image, x + dx + 0.5 * size * ux, y + dy + 0.5 * size * uy + 0.3 * size, names[k], 0.85 * size, ink,
          Side::middle);
  }
}

}  // namespace

std::pair<int, int> roomOf(const Legend& legend, int width, int height) {
  const double size = sizeOfText(width, height);
  const bool below = !legend.bars.empty() || legend.axes || !legend.length.empty();
  return {legend.time.empty() ? 0 : static_cast<int>(2.0 * size), below ? static_cast<int>(4.6 * size) : 0};
}

void write(Image& image, const Legend& legend, const Camera& camera) {
  const double size = sizeOfText(image.width, image.height), margin = 0.7 * size;
  write(image, margin, 1.5 * size, legend.time, size, legend.ink);
  const double top = image.height - roomOf(legend, image.width, image.height).second + 0.2 * size;
  double left = margin, right = image.width - margin;
  if (legend.axes) {
    writeAxes(image, {left, left + 4.2 * size, top, size}, camera, legend.ink);
    left += 4.2 * size;
  }
  if (!legend.length.empty()) {
    const double width = std::max(legend.pixels, widthOf(legend.length, size));
    writeLength(image, {right - width, right, top, size}, legend);
    right -= width + size;
  }
  const double each = (right - left) / static_cast<double>(std::max<std::size_t>(1, legend.bars.size()));
  for (std::size_t k = 0; k < legend.bars.size(); ++k) {
    const double from = left + each * static_cast<double>(k), half = std::min(0.5 * each - 1.6 * size, 9.0 * size);
    const double middle = from + 0.5 * each;
    writeBar(image, {middle - half, middle + half, top, size}, legend.bars[k], legend.ink);
  }
}

}  // namespace dovetail::picture
