// The command line of scenes.
#include <iostream>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/core/nearest.hpp"
#include "dovetail/hierarchical/farm.hpp"
#include "dovetail/io/provenance.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "verbs.hpp"

namespace {

using namespace dovetail;

void printHelp() {
  std::cout << "Runs scenes of grains and solids.\n\nusage: dovetail VERB …; dovetail VERB --help tells its options\n";
  io::KeyValues rows;
  for (const program::Verb& verb : program::verbs) rows.emplace_back(verb.name, verb.help);
  rows.emplace_back("--version", "prints version and commit");
  program::printColumns(rows, std::cout);
  std::cout
      << "\nExit codes: 0 done, 1 broke down or differs, 2 refused, 128 + n ended by signal n, 142 when the time of\n"
         "--max-wall-seconds was up.\n";
}

const program::Verb& verbOf(const std::string& name) {
  std::vector<std::string> names;
  for (const program::Verb& verb : program::verbs) {
    if (verb.name == name) return verb;
    names.emplace_back(verb.name);
  }
  throw InputError(name.empty() ? "a verb is missing" : "there is no verb '" + name + "'", "command line",
                   adviceFor(name, names) + "; see dovetail --help");
}

bool act(int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  if (first == "--help" || first == "-h") return printHelp(), true;
  if (first == "--version") {
    std::cout << "dovetail " << io::buildInfo().version << ' ' << io::buildInfo().commit << '\n';
    return true;
  }
  program::offerTetrahedra();
  return verbOf(first).act(argc - 1, argv + 1);
}

}  // namespace

int main(int argc, char** argv) {
  return program::runProgram(
      "dovetail", [&] { return hierarchical::serveFarm() || act(argc, argv); }, program::Signals::noted);
}
