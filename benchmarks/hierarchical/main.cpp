// The published figures on cells of grains, alone and in solids, beside what comes out here: one Markdown table.
#include <cstdio>
#include <ctime>

#include "dovetail/core/error.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "figure.hpp"
#include "program/options.hpp"
#include "program/run.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::benchmark;

const std::vector<Figure> figures{
    {"square-arrays", "Liu 2018, Fig. 2.4", squareArrays},
    {"lz19-cell", "Liang & Zhao 2019, biaxial compression", lz19Cell},
    {"operators", "Desrues et al. 2019, Table 1", operators},
    {"farm", "Desrues et al. 2019, Table 3", farm},
    {"farm-1600", "Desrues et al. 2019, 1600 discs", farmOfLargeCells},
    {"simple-shear", "Liu 2018, Figs 2.7, 2.10", simpleShear},
    {"servo", "Liu 2018, eqs 2.33, 2.34, Table 2.3", servoFrame},
    {"mixed-layer", "Liu 2018, sec. 2.6, Fig. 2.11", mixedLayer},
    {"string", "Liu 2018, Figs 4.4, 4.5", stringOfDiscs},
    {"strips", "Liu 2018, Figs 4.6 to 4.8 and 4.10", strips},
    {"biaxial", "Liu 2018, Figs 3.4, 3.10", biaxial},
    {"explicit-biaxial", "measured beforehand: 10 × 20 quad4, 800 cells", explicitBiaxial},
    {"bands", "measured beforehand: 400 discs a cell, one packing", bandsOfCells},
    {"spheres", "Liu et al. 2015, sec. 3.3, Tables I, II", spheres},
    {"column", "Liu et al. 2015, sec. 3.3, Fig. 8", column},
};

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::string printedIn(const FigureRow& row) {
  if (!row.judged()) return "";
  char text[64];
  if (row.atLeast)
    std::snprintf(text, sizeof text, "≥ %.5g", row.printed);
  else
    std::snprintf(text, sizeof text, "%.5g ± %.2g", row.printed, row.allowed);
  return text;
}

std::string verdict(const FigureRow& row) {
  if (!row.judged()) return "shown";
  return row.holds() ? "holds" : "**missed**";
}

/// Rows of the table; false if one that is judged is missed.
bool show(const Figure& figure, bool quick) {
  const double start = seconds();
  const FigureRows rows = figure.run(quick);
  const double took = seconds() - start;
  bool all = true;
  for (const FigureRow& row : rows) {
    all = all && (!row.judged() || row.holds());
    std::printf("| %s | %s | %s | %.5g ± %.2g", figure.name.c_str(), figure.source.c_str(), row.what.c_str(), row.here,
                row.scatter);
    if (row.packings > 1) std::printf(" (%zu)", row.packings);
    std::printf(" | %s | %s | %s |\n", printedIn(row).c_str(), verdict(row).c_str(), row.note.c_str());
  }
  std::printf("| %s | | seconds of the processor | %.1f | | | |\n", figure.name.c_str(), took);
  std::fflush(stdout);
  return all;
}

std::string names() {
  std::string text;
  for (const Figure& figure : figures) text += (text.empty() ? "" : "|") + figure.name;
  return text;
}

bool run(bool quick, const std::string& only) {
  std::printf(
      "| figure | printed in | quantity | here (packings) | printed | | note |\n|---|---|---|---|---|---|---|\n");
  bool all = true;
  for (const Figure& figure : figures)
    if (only == "all" || only == figure.name) all = show(figure, quick) && all;
  return all;
}

}  // namespace

/// Exit code 0: all figures hold; 1: one is missed or broke down; 2: the request was refused.
int main(int argc, char** argv) {
  return program::runProgram("cell_figures", [&] {
    bool quick = false;
    std::string only = "all";
    program::Options o("cell_figures", "Published figures on cells of grains, beside the results of this program.");
    o.flag("--quick", quick, "fewer packings, smaller solids");
    o.word("--only", only, "all|" + names(), "one figure");
    return hierarchical::serveFarm() || !o.parse(argc, argv) || run(quick, only);
  });
}
