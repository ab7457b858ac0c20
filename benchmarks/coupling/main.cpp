#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "dovetail/core/parallel.hpp"
#include "dovetail/core/progress.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "tables.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::coupling_matrix;

struct Settings {
  bool pairwise = false;
  std::string only, out;
  int steps = 400;
};

bool parse(int argc, char** argv, Settings& s) {
  program::Options o("coupling", "Runs coupled scenes of all combinations and checks their ledgers.");
  o.flag("--pairwise", s.pairwise, "a pairwise subset of the combinations, which has every pair of levels");
  o.text("--only TEXT", s.only, "cases whose name contains this, such as 'tet4 StVK'");
  o.integer("--steps N", s.steps, 80, 1000000, "particle steps at a fiftieth of the critical one, a multiple of 80");
  o.text("--out DIR", s.out, "folder for matrix.csv and matrix.md");
  return o.parse(argc, argv);
}

std::vector<Row> rowsOf(const Settings& s) {
  std::vector<Row> rows;
  for (const Case& c : s.pairwise ? pairwiseCases() : allCases())
    if (nameOf(c).find(s.only) != std::string::npos) rows.push_back({c, {}});
  if (rows.empty()) throw InputError("--only: no case has this in its name: " + s.only, "", "");
  return rows;
}

void write(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
  std::ofstream file(folder / name);
  if (!(file << text)) throw InputError("--out: " + (folder / name).string() + " cannot be written", "", "");
}

bool run(const Settings& s) {
  std::vector<Row> rows = rowsOf(s);
  if (!s.out.empty()) {
    std::filesystem::create_directories(s.out);
    write(s.out, "matrix.md", "");
  }
  Progress progress("matrix", static_cast<double>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    progress.update(static_cast<double>(k), nameOf(rows[k].c));
    rows[k].figures = measure(rows[k].c, s.steps);
  }
  progress.finish();
  const std::string table = markdownOf(rows);
  std::cout << table;
  if (!s.out.empty()) {
    write(s.out, "matrix.md", table);
    write(s.out, "matrix.csv", csvOf(rows, io::provenance({{"program", "coupling"}})));
  }
  return std::ranges::all_of(rows, [](const Row& row) { return shortfall(row.c, row.figures).empty(); });
}

}  // namespace

/// Exit code 0: every case holds what is asked; 1: one falls short, or broke down; 2: the request was refused.
int main(int argc, char** argv) {
  return program::runProgram("coupling", [&] {
    Settings s;
    return !parse(argc, argv, s) || run(s);
  });
}
