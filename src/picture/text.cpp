#include <algorithm>
#include <cmath>
#include <sstream>

#include "coverage.hpp"
#include "dovetail/picture/legend.hpp"

namespace dovetail::picture {

namespace {

constexpr double unit = 512.0;

struct Letter {
  char32_t code;
  int advance;
  const char* outline;
};
constexpr Letter letters[] = {
#include "dejavu_sans.inc"
};
// For letters that are not there.
constexpr Letter box{0, 307, "m50 0l50 373l257 373l257 0l50 0m80 30l227 30l227 343l80 343l80 30"};

const Letter& letterOf(char32_t code) {
  const auto found = std::lower_bound(std::begin(letters), std::end(letters), code,
                                      [](const Letter& l, char32_t c) { return l.code < c; });
  return found != std::end(letters) && found->code == code ? *found : box;
}

std::vector<const Letter*> lettersOf(const std::string& text) {
  std::vector<const Letter*> all;
  for (std::size_t k = 0; k < text.size();) {
    const auto lead = static_cast<unsigned char>(text[k++]);
    const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
    char32_t code = more == 0 ? lead : lead & (0x3F >> more);
    for (int m = 0; m < more && k < text.size(); ++m) code = code << 6 | (static_cast<unsigned char>(text[k++]) & 0x3F);
    all.push_back(&letterOf(code));
  }
  return all;
}

/// Adds a letter with its origin at (x, y).
void add(Coverage& coverage, const Letter& letter, double x, double y, double scale) {
  std::istringstream stream(letter.outline);
  double px = 0.0, py = 0.0;
  const auto to = [&](double qx, double qy) {
    coverage.edge(x + scale * px, y - scale * py, x + scale * qx, y - scale * qy);
    px = qx;
    py = qy;
  };
  for (char kind = 0; stream >> kind;) {
    double ax = 0.0, ay = 0.0, bx = 0.0, by = 0.0;
    stream >> ax >> ay;
    if (kind == 'm') px = ax, py = ay;
    if (kind == 'l') to(ax, ay);
    if (kind != 'q') continue;
    stream >> bx >> by;
    const double sx = px, sy = py;
    constexpr int pieces = 6;
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces, s = 1.0 - t;
      to(s * s * sx + 2.0 * s * t * ax + t * t * bx, s * s * sy + 2.0 * s * t * ay + t * t * by);
    }
  }
}

}  // namespace

double widthOf(const std::string& text, double size) {
  double sum = 0.0;
  for (const Letter* const letter : lettersOf(text)) sum += letter->advance;
  return sum * size / unit;
}

void write(Image& image, double x, double y, const std::string& text, double size, Colour colour, Side side) {
  if (side != Side::left) x -= (side == Side::middle ? 0.5 : 1.0) * widthOf(text, size);
  Coverage coverage(image);
  for (const Letter* const letter : lettersOf(text)) {
    add(coverage, *letter, x, y, size / unit);
    x += letter->advance * size / unit;
  }
  coverage.paint(image, colour);
}

}  // namespace dovetail::picture
