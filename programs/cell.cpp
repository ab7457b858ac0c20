// dovetail cell: cells of grains are made, described and tested.
#include <algorithm>
#include <iostream>

#include "cell_tests.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/nearest.hpp"
#include "dovetail/io/interruption.hpp"
#include "dovetail/io/output_folder.hpp"
#include "program/options.hpp"
#include "verbs.hpp"

namespace dovetail::program {

namespace {

void requireColumns(const std::vector<std::string>& shown) {
  std::vector<std::string> names;
  for (const CurveColumn& column : curveColumns()) names.emplace_back(column.name);
  for (const std::string& name : shown)
    if (std::ranges::find(names, name) == names.end())
      throw InputError("curves have no column of this name", "--show " + name, adviceFor(name, names));
}

}  // namespace

bool testCellsOf(int argc, char** argv) {
  std::string name, out;
  std::vector<std::string> settings, shown;
  bool schema = false, keys = false;
  Options options("dovetail cell", "Makes cells of grains, and tests them: moduli, strength, K0 …");
  options.text("FILE", name, "file of cells and tests (JSON), see docs/grain-cells.md");
  options.texts("--set KEY=VALUE", settings, "a parameter of \"let\", or a path such as drive.0.strain");
  options.texts("--show COLUMN", shown, "of the curves, drawn on the page too");
  options.text("--out DIR", out, "folder for all files; <file>-cells if not given");
  options.flag("--schema", schema, "prints the JSON Schema of these files");
  options.flag("--keys", keys, "prints a reference of all their keys");
  if (!options.parse(argc, argv)) return true;
  if (schema || keys) {
    std::cout << (schema ? cellSchema() : cellReference());
    return true;
  }
  if (name.empty()) throw InputError("FILE is missing", "dovetail cell", "name a file of cells");
  requireColumns(shown);
  const CellPlan plan = readCellPlan(name, settings);
  const std::filesystem::path folder = out.empty() ? std::filesystem::path(name).stem().string() + "-cells" : out;
  io::prepareOutputFolder(folder, cellFiles(plan));
  const CellResults results = testCells(plan, folder, std::cerr);
  if (results.interrupted) {
    std::cerr << "dovetail: " << io::nameOfInterruption() << "; cells that were made are kept\n";
    return false;
  }
  std::cout << writeCellFiles(plan, results, folder, shown) << "curves, numbers and report.html in " << folder.string()
            << '\n';
  return results.allDone();
}

}  // namespace dovetail::program
