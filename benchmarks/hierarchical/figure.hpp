// Figures that papers print, and what comes out here.
#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace dovetail::benchmark {

struct FigureRow {
  std::string what;      ///< quantity with its unit, and the case if there are several
  double here = 0.0;     ///< mean
  double scatter = 0.0;  ///< standard deviation over the packings, 0 if there is one
  double printed = 0.0;  ///< what is to be shown; NaN: nothing is printed, the row informs
  double allowed = 0.0;  ///< difference that is allowed
  std::string note = {};
  bool atLeast = false;  ///< no less is printed
  std::size_t packings = 1;

  bool judged() const { return std::isfinite(printed); }
  bool holds() const { return atLeast ? here >= printed : std::abs(here - printed) <= allowed; }
};
using FigureRows = std::vector<FigureRow>;

/// A row of the values of several packings.
FigureRow rowOf(const std::string& what, const std::vector<double>& values, double printed, double allowed,
                const std::string& note = {});

struct Figure {
  std::string name;    ///< as --only takes it
  std::string source;  ///< paper, figure or table
  FigureRows (*run)(bool quick);
};

// One source file each.
FigureRows bandsOfCells(bool quick);
FigureRows biaxial(bool quick);
FigureRows column(bool quick);
FigureRows explicitBiaxial(bool quick);
FigureRows farm(bool quick);
FigureRows farmOfLargeCells(bool quick);
FigureRows lz19Cell(bool quick);
FigureRows mixedLayer(bool quick);
FigureRows operators(bool quick);
FigureRows servoFrame(bool quick);
FigureRows simpleShear(bool quick);
FigureRows spheres(bool quick);
FigureRows squareArrays(bool quick);
FigureRows stringOfDiscs(bool quick);
FigureRows strips(bool quick);

}  // namespace dovetail::benchmark
