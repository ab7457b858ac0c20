// Figures of curves over a common axis as SVG.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace dovetail::report {

struct Curve {
  std::string name;
  std::vector<double> x, y;  ///< of one length; the line breaks where one is not finite
  bool line = true, marks = false;
  bool dashed = false;
  std::vector<std::array<double, 2>> ranges{};  ///< lowest and highest y at each point, drawn as a bar; empty: none
  std::optional<std::size_t> like = {};  ///< number of a curve that it continues: it has its colour and no legend
};

struct Axis {
  std::string label;         ///< with the unit: "time (s)"
  bool logarithmic = false;  ///< values of 0 and below are left out
};

struct Figure {
  std::string name;   ///< of its file: letters, digits, '_' and '-'
  std::string title;  ///< may be empty
  Axis x, y;
  std::vector<Curve> curves;
  std::vector<std::pair<std::string, double>> bars;  ///< if any, drawn instead of curves: y.label is their unit
};

/// Round ticks that cover low … high: 1, 2 or 5 times a power of ten apart, at most `most`; at least two. high > low.
std::vector<double> roundTicks(double low, double high, int most);

/// The figure as an `<svg>` element with ticks, labels and legend. Colours are classes (see figureStyle), sizes those
/// of a column that is 440 wide, so that it can be read on a telephone. Long curves keep their extremes at each place.
std::string svgOf(const Figure& figure);

/// The same with its colours, for a file of its own.
std::string svgFileOf(const Figure& figure);

/// CSS of the figures' classes, for light and dark.
std::string figureStyle();

/// Text in which &, <, > and quotation marks are written for XML and HTML.
std::string escaped(const std::string& text);

}  // namespace dovetail::report
