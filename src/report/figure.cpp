#include "dovetail/report/figure.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "dovetail/report/text.hpp"

namespace dovetail::report {

namespace {

// Sizes in units of a column 440 wide.
constexpr double width = 440.0, left = 64.0, right = 18.0, plotHeight = 210.0, row = 18.0;
constexpr int colours = 8;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// "10⁻⁶"
std::string powerOfTen(int exponent) {
  const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) text += digits[c - '0'];
  return text;
}

struct Tick {
  double value;  // as it is drawn: the logarithm on logarithmic axes
  std::string text;
};

/// An axis as it is drawn.
struct Scale {
  double low = 0.0, high = 1.0;
  bool logarithmic = false;
  std::vector<Tick> ticks;
  std::string label;

  double operator()(double value) const {
    if (!std::isfinite(value) || (logarithmic && value <= 0.0)) return nothing;
    return ((logarithmic ? std::log10(value) : value) - low) / (high - low);
  }
};

void addDecades(Scale& scale) {
  const int first = static_cast<int>(std::floor(scale.low + 1e-9)),
            last = static_cast<int>(std::ceil(scale.high - 1e-9));
  scale.low = first;
  scale.high = std::max(last, first + 1);
  const int apart = std::max(1, static_cast<int>(std::ceil((scale.high - scale.low) / 6.0)));
  for (int decade = first; decade <= scale.high; decade += apart)
    scale.ticks.push_back({static_cast<double>(decade), powerOfTen(decade)});
}

/// @param fraction  of the axis that may stay empty at either end
void addRoundTicks(Scale& scale, double fraction) {
  const std::vector<double> ticks = roundTicks(scale.low, scale.high, 6);
  // To the next tick on either side, but not where that leaves much room empty.
  const double step = ticks[1] - ticks[0], spare = fraction * (scale.high - scale.low);
  std::vector<double> all = ticks;
  if (const double below = ticks.front() - step; scale.low < ticks.front() && scale.low - below <= spare)
    all.insert(all.begin(), below);
  if (const double above = ticks.back() + step; scale.high > ticks.back() && above - scale.high <= spare)
    all.push_back(above);
  scale.low = std::min(scale.low, all.front());
  scale.high = std::max(scale.high, all.back());
  // Where many digits are the same, ticks tell what is added to the first.
  const double reach = std::max(std::abs(all.front()), std::abs(all.back()));
  const double base = step < 1e-4 * reach ? all.front() : 0.0;
  if (base != 0.0) scale.label += format(" − %.10g", base);
  const double largest = std::max(std::abs(all.front() - base), std::abs(all.back() - base));
  int exponent = static_cast<int>(std::floor(std::log10(largest)));
  exponent = exponent >= 4 || exponent < -2 ? 3 * static_cast<int>(std::floor(exponent / 3.0)) : 0;
  if (exponent != 0) scale.label += " × " + powerOfTen(exponent);
  for (const double value : all) {
    const double told = std::abs(value - base) < 1e-9 * step ? 0.0 : (value - base) / std::pow(10.0, exponent);
    scale.ticks.push_back({value, format("%.4g", told)});
  }
}

/// @param values  of all curves
Scale scaleOf(const Axis& axis, const std::vector<double>& values, double fraction) {
  Scale scale{std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity(),
              axis.logarithmic,
              {},
              axis.label};
  for (const double value : values) {
    if (!std::isfinite(value) || (axis.logarithmic && value <= 0.0)) continue;
    const double place = axis.logarithmic ? std::log10(value) : value;
    scale.low = std::min(scale.low, place);
    scale.high = std::max(scale.high, place);
  }
  if (scale.low > scale.high) scale.low = 0.0, scale.high = 1.0;
  if (scale.high - scale.low <= 1e-12 * std::max(std::abs(scale.low), std::abs(scale.high)) ||
      scale.high == scale.low) {
    const double pad = scale.low == 0.0 ? 1.0 : 0.1 * std::abs(scale.low);
    scale.low -= pad;
    scale.high += pad;
  }
  axis.logarithmic ? addDecades(scale) : addRoundTicks(scale, fraction);
  return scale;
}

struct Point {
  double x, y;
};

/// Points of a curve on the page. Of many at one place the first, the lowest, the highest and the last are kept.
class Drawn {
public:
  Drawn(const Curve& curve, const Scale& x, const Scale& y, double top) {
    const std::size_t count = std::min(curve.x.size(), curve.y.size());
    for (std::size_t k = 0; k < count; ++k) {
      const double across = x(curve.x[k]), up = y(curve.y[k]);
      const Point point{left + across * (width - left - right), top + (1.0 - up) * plotHeight};
      if (std::isfinite(across) && std::isfinite(up))
        add(point);
      else
        breakOff();
    }
    breakOff();
  }
  const std::vector<std::vector<Point>>& parts() const { return parts_; }

private:
  void add(const Point& point) {
    if (!column_.empty() && std::floor(point.x) != std::floor(column_.front().x)) flush();
    column_.push_back(point);
  }
  void flush() {
    if (parts_.empty() || broken_) parts_.emplace_back();
    broken_ = false;
    const auto by = [](const Point& a, const Point& b) { return a.y < b.y; };
    auto low = std::min_element(column_.begin(), column_.end(), by),
         high = std::max_element(column_.begin(), column_.end(), by);
    std::vector keep{column_.begin(), std::min(low, high), std::max(low, high), std::prev(column_.end())};
    keep.erase(std::unique(keep.begin(), keep.end()), keep.end());
    for (const auto& point : keep) parts_.back().push_back(*point);
    column_.clear();
  }
  void breakOff() {
    if (!column_.empty()) flush();
    broken_ = true;
  }
  std::vector<std::vector<Point>> parts_;
  std::vector<Point> column_;
  bool broken_ = true;
};

std::string textAt(double x, double y, const char* anchor, const std::string& text, const std::string& more = {}) {
  return format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\"%s>", x, y, anchor, more.c_str()) + escaped(text) +
         "</text>\n";
}

/// About as wide as the text will be.
double lengthOf(const std::string& text) {
  const auto widthOf = [](char c) {
    if ((c & 0xC0) == 0x80) return 0.0;  // goes on with a letter
    return std::strchr("mwMW", c) ? 11.0 : std::strchr("fijlrt.,:;' ", c) ? 4.5 : 7.3;
  };
  return std::accumulate(text.begin(), text.end(), 0.0, [&](double sum, char c) { return sum + widthOf(c); });
}

std::string gridOf(const Scale& x, const Scale& y, double top) {
  const double bottom = top + plotHeight, across = width - left - right;
  std::string svg;
  for (const Tick& tick : x.ticks) {
    const double at = left + across * (tick.value - x.low) / (x.high - x.low);
    svg += format("<path class=\"grid\" d=\"M%.1f %.1fV%.1f\"/>\n", at, top, bottom);
    svg += textAt(at, bottom + 16.0, "middle", tick.text);
  }
  for (const Tick& tick : y.ticks) {
    const double at = bottom - plotHeight * (tick.value - y.low) / (y.high - y.low);
    svg += format("<path class=\"grid\" d=\"M%.1f %.1fH%.1f\"/>\n", left, at, width - right);
    svg += textAt(left - 6.0, at + 4.0, "end", tick.text);
  }
  svg += format("<path class=\"axis\" d=\"M%.1f %.1fV%.1fH%.1f\"/>\n", left, top, bottom, width - right);
  svg += textAt(left + 0.5 * across, bottom + 34.0, "middle", x.label);
  const double middle = top + 0.5 * plotHeight;
  return svg + textAt(13.0, middle, "middle", y.label, format(" transform=\"rotate(-90 13 %.1f)\"", middle));
}

/// Class of a curve's line: broken where the colours have come round.
std::string colourOf(const Curve& curve, std::size_t number) {
  return (curve.dashed || number / colours % 2 == 1 ? "dashed c" : "c") + std::to_string(number % colours);
}

/// A disc; a ring where the colours have come round, so that no two curves look alike up to twice as many.
std::string markAt(double x, double y, std::size_t number) {
  const bool ring = number / colours % 2 == 1;
  return format("<circle class=\"%s%d\" cx=\"%.1f\" cy=\"%.1f\" r=\"%s\"/>\n", ring ? "ring c" : "mc",
                static_cast<int>(number % colours), x, y, ring ? "3" : "3.5");
}

/// A range that begins at or below the end of the axis, as one from 0 does on a logarithmic one, begins there.
std::string rangesOf(const Curve& curve, const Scale& x, const Scale& y, double top, std::size_t number) {
  std::string svg;
  for (std::size_t k = 0; k < std::min(curve.ranges.size(), curve.x.size()); ++k) {
    const double across = x(curve.x[k]), high = y(curve.ranges[k][1]);
    const double low = std::isfinite(y(curve.ranges[k][0])) ? y(curve.ranges[k][0]) : 0.0;
    if (!std::isfinite(across) || !std::isfinite(high)) continue;
    svg +=
        format("<path class=\"c%d\" d=\"M%.1f %.1fV%.1f\"/>\n", static_cast<int>(number % colours),
               left + across * (width - left - right), top + (1.0 - low) * plotHeight, top + (1.0 - high) * plotHeight);
  }
  return svg;
}

std::string pathOf(const Curve& curve, const Drawn& drawn, std::size_t number) {
  const std::string colour = colourOf(curve, number);
  std::string d, svg;
  for (const auto& part : drawn.parts())
    for (std::size_t k = 0; k < part.size(); ++k) d += format("%s%.1f %.1f", k == 0 ? "M" : "L", part[k].x, part[k].y);
  if (curve.line && !d.empty()) svg += "<path class=\"" + colour + "\" d=\"" + d + "\"/>\n";
  // A point without neighbours has no line.
  for (const auto& part : drawn.parts())
    for (const Point& p : part)
      if (curve.marks || (curve.line && part.size() == 1)) svg += markAt(p.x, p.y, number);
  return svg;
}

/// Adds its height to `y`.
std::string legendOf(const Figure& figure, double& y) {
  const std::vector<Curve>& curves = figure.curves;
  if (curves.empty() || (curves.size() == 1 && curves.front().name == figure.title)) return {};
  std::string svg;
  double x = left;
  y += row;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    if (curves[k].like) continue;
    const double length = 26.0 + lengthOf(curves[k].name) + 12.0;
    if (x > left && x + length > width) {
      x = left;
      y += row;
    }
    const std::string colour = colourOf(curves[k], k);
    if (curves[k].line) svg += format("<path class=\"%s\" d=\"M%.1f %.1fh18\"/>\n", colour.c_str(), x, y - 4.0);
    if (curves[k].marks) svg += markAt(x + 9.0, y - 4.0, k);
    svg += textAt(x + 23.0, y, "start", curves[k].name);
    x += length;
  }
  return svg;
}

std::string barsOf(const Figure& figure, double& height) {
  double longest = 0.0;
  for (const auto& [name, value] : figure.bars) longest = std::max(longest, value);
  std::string svg;
  for (const auto& [name, value] : figure.bars) {
    svg += textAt(10.0, height + 13.0, "start", name);
    svg += textAt(width - right, height + 13.0, "end", format("%.3g ", value) + figure.y.label);
    const double fraction = longest > 0.0 && value > 0.0 ? value / longest : 0.0;
    svg += format("<rect class=\"mc0\" x=\"10\" y=\"%.1f\" width=\"%.1f\" height=\"8\"/>\n", height + 18.0,
                  fraction * (width - right - 10.0));
    height += 34.0;
  }
  return svg;
}

std::string framed(const Figure& figure, double height, const std::string& content) {
  return format(
             "<svg class=\"figure\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" role=\"img\" "
             "aria-label=\"",
             width, height + 8.0) +
         escaped(figure.title) + "\">\n" + content + "</svg>\n";
}

std::string drawn(const Figure& figure, const std::string& style) {
  const double top = figure.title.empty() ? 10.0 : 30.0;
  std::string body = style;
  if (!figure.title.empty()) body += textAt(10.0, 17.0, "start", figure.title, " class=\"title\"");
  double height = top;
  if (!figure.bars.empty()) {
    body += barsOf(figure, height);
    return framed(figure, height, body);
  }
  std::vector<double> across, up;
  for (const Curve& curve : figure.curves) {
    across.insert(across.end(), curve.x.begin(), curve.x.end());
    up.insert(up.end(), curve.y.begin(), curve.y.end());
    for (const auto& range : curve.ranges) up.insert(up.end(), range.begin(), range.end());
  }
  const Scale x = scaleOf(figure.x, across, 0.05), y = scaleOf(figure.y, up, 1.0);
  body += gridOf(x, y, top);
  for (std::size_t k = 0; k < figure.curves.size(); ++k) {
    const Curve& curve = figure.curves[k];
    const std::size_t colour = curve.like.value_or(k);
    body += rangesOf(curve, x, y, top, colour) + pathOf(curve, Drawn(curve, x, y, top), colour);
  }
  height += plotHeight + 38.0;
  body += legendOf(figure, height);
  return framed(figure, height, body);
}

}  // namespace

std::vector<double> roundTicks(double low, double high, int most) {
  const double least = (high - low) / std::max(1, most - 1);
  double step = std::pow(10.0, std::floor(std::log10(least)));
  const auto count = [&](double s) { return std::floor(high / s + 1e-9) - std::ceil(low / s - 1e-9) + 1.0; };
  for (const double factor : {1.0, 2.0, 5.0, 10.0})
    if (count(factor * step) <= most) {
      step *= factor;
      break;
    }
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push_back(k * step);
  if (ticks.size() >= 2) return ticks;
  const double first = std::floor(low / step) * step;
  return {first, first + step};
}

std::string svgOf(const Figure& figure) { return drawn(figure, ""); }
std::string svgFileOf(const Figure& figure) { return drawn(figure, "<style>\n" + figureStyle() + "</style>\n"); }

std::string figureStyle() {
  const char* const light[colours] = {"#1f5fb4", "#c8501e", "#2a8a4a", "#8a3fa8",
                                      "#b08a00", "#00868f", "#b0306a", "#666666"};
  const char* const dark[colours] = {"#6fa8f5", "#f08a5a", "#63c98a", "#c78ae6",
                                     "#e0bd4a", "#4fc6cf", "#ee7fb0", "#aaaaaa"};
  const auto paint = [](const char* const(&colour)[colours]) {
    std::string css;
    for (int k = 0; k < colours; ++k)
      css += format(".figure .c%d{stroke:%s}.figure .mc%d{fill:%s}\n", k, colour[k], k, colour[k]);
    return css;
  };
  return ".figure{max-width:100%;height:auto;font:12px system-ui,sans-serif;fill:#222}\n"
         ".figure path{fill:none;stroke-width:1.6;stroke-linejoin:round;stroke-linecap:round}\n"
         ".figure .ring{fill:none;stroke-width:1.6}\n"
         ".figure .dashed{stroke-dasharray:5 4}\n"
         ".figure .grid{stroke:#8883;stroke-width:1}\n"
         ".figure .axis{stroke:#888;stroke-width:1}\n"
         ".figure .title{font-weight:600;font-size:13px}\n" +
         paint(light) + "@media (prefers-color-scheme:dark){\n.figure{fill:#ddd}\n" + paint(dark) + "}\n";
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  return out;
}

}  // namespace dovetail::report
