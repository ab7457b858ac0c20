// The scenes that are compared with other programs, one by one.
#include <ostream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/report/text.hpp"
#include "scenes.hpp"
#include "studies.hpp"
#include "tables.hpp"

namespace dovetail::dem_benchmark {

namespace {

Spheres readScene(const Settings& s, const char* name) {
  if (s.bed.empty()) throw InputError("no folder of scenes", "--bed", "give the folder that --write has filled");
  return readSpheres(s.bed / name);
}

Figures timeBed(const Settings& s, const std::string& name, const auto& law) {
  const double width = 20.0 * s.copies;
  auto model = bedModel(repeated(readScene(s, "bed.txt"), s.copies, 20.0), law, width, s.skin);
  return measure(name, model, timeStep, s.warmUp, s.steps, s.repeats);
}

Figures timeScene(const Settings& s, const std::string& name) {
  if (name == "bed") return timeBed(s, name, frictionalLaw());
  if (name == "hertz") return timeBed(s, name, hertzLaw());
  if (name == "lattice") {
    auto model = waveLattice(50, 50, 40, s.skin);
    return measure(name, model, timeStep, s.warmUp, s.steps, s.repeats);
  }
  if (name == "polydisperse") {
    constexpr double edge = 44.0;
    auto model = makeModel(readScene(s, "poly.txt"), frictionalLaw(),
                           {{{0, 0, 0}, {edge, edge, edge}}, {true, true, true}}, {}, s.skin);
    return measure(name, model, timeStep, s.warmUp, s.steps, s.repeats, 50);
  }
  auto model = drumModel(repeated(readScene(s, "drum.txt"), s.copies, drumWidth, 2), drumWidth * s.copies, s.skin);
  return measure(name, model, drumStep, s.warmUp, s.steps, s.repeats);
}

}  // namespace

void studyPeers(const Settings& s, std::ostream& out) {
  setThreads(s.threads);
  Table table{out, {}};
  table.header();
  for (const std::string& name : s.scenes) table.add(timeScene(s, name));
  writeSummary(s, table.rows, 0.0);
}

}  // namespace dovetail::dem_benchmark
