// Material points beside exact and published answers: one Markdown table a case.
#include <cstdio>
#include <vector>

#include "cases.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "scenes.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::benchmark;

const std::vector<Case> cases{
    {"bar", "Period of a bar", bar},
    {"column", "A column at rest under its weight", column},
    {"cantilever", "A soft beam falls under its weight", cantilever},
    {"discs", "Two discs collide", discs},
    {"block", "A block under its weight", block},
    {"rebound", "A block hits a wall", rebound},
    {"run-out", "A column of sand collapses", runOut},
    {"footing", "A strip footing on weightless sand", footing},
    {"vortex", "A ring turns within itself, manufactured", vortex},
    {"bands", "Soft sand forms a band", bands},
    {"stretch", "A bar is pulled until its points part", stretch},
    {"stability", "Blocks that are thrown, hit and spun", stability},
    {"speed", "Cost of a step", speed},
    {"cells-speed", "Steps of discs in cells at points", cells},
};

std::string names() {
  std::string text;
  for (const Case& one : cases) text += (text.empty() ? "" : "|") + one.name;
  return text;
}

bool run(bool quick, const std::string& only) {
  bool all = true;
  for (const Case& one : cases) {
    if (only != "all" && only != one.name) continue;
    std::printf("## %s\n\n", one.what.c_str());
    const double start = seconds();
    const bool holds = one.run(quick);
    std::printf("\n%s: %s, %.1f s of the processor\n\n", one.name.c_str(), holds ? "holds" : "**missed**",
                seconds() - start);
    std::fflush(stdout);
    all = all && holds;
  }
  return all;
}

}  // namespace

/// Exit code 0: all holds; 1: something is missed or broke down; 2: the request was refused.
int main(int argc, char** argv) {
  return program::runProgram("material_points", [&] {
    bool quick = false;
    std::string only = "all";
    program::Options o("material_points", "Material points beside exact and published answers.");
    o.flag("--quick", quick, "smaller sizes");
    o.word("--only", only, "all|" + names(), "one case");
    return !o.parse(argc, argv) || run(quick, only);
  });
}
