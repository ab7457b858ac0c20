// dovetail compare: two runs side by side.
#include "dovetail/scene/compare.hpp"

#include <iostream>

#include "program/options.hpp"
#include "verbs.hpp"

namespace dovetail::program {

bool compareRuns(int argc, char** argv) {
  std::string first, second;
  double tolerance = 1e-9;
  std::size_t rows = 20;
  Options options("dovetail compare",
                  "Compares two runs, or two series, frames or states. Exit code 1 if they differ.");
  options.text("A", first, "folder of a run, or file").require();
  options.text("B", second, "of the same kind").require();
  options.number("--tolerance X", tolerance, notNegative("0 or a positive number"),
                 "of differences over the scale of their quantity");
  options.integer("--rows N", rows, 0, 1000000, "of the table, at most");
  if (!options.parse(argc, argv)) return true;
  const scene::Comparison comparison = scene::compare(first, second);
  scene::print(comparison, tolerance, rows, std::cout);
  return comparison.within(tolerance);
}

}  // namespace dovetail::program
