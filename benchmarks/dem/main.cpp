#include <iostream>
#include <map>
#include <set>

#include "common/outputs.hpp"
#include "dovetail/core/parallel.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "studies.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::dem_benchmark;

void refuseIdleOptions(const program::Options& o, const Settings& s) {
  const std::string with = "with --study " + s.study, remedy = "leave it out";
  if (!s.write.empty())
    o.refuseIdle("--study --summary --only --scene --copies --skin --steps --warm-up --repeat", "with --write", remedy);
  if (s.study != "peers") o.refuseIdle("--scene --copies --skin", with, remedy);
  if (s.study != "stability") o.refuseIdle("--only", with, remedy);
  if (s.study == "peers") o.refuseIdle("--quick", with, remedy);
  if (s.study == "threads") o.refuseIdle("--threads", with, remedy);
  if (s.study == "stability") o.refuseIdle("--bed --steps --warm-up --repeat --quick", with, remedy);
  if (s.study == "accuracy") o.refuseIdle("--bed --steps --warm-up", with, remedy);
  if (s.study == "leaving-out" || s.study == "scaling") o.refuseIdle("--bed --warm-up", with, remedy);
}

bool parse(int argc, char** argv, Settings& s) {
  program::Options o("dem", "Times the particle engine, and checks it on stiff and extreme cases.");
  o.word("--study", s.study, "throughput|peers|leaving-out|scaling|threads|stability|accuracy", "what to do");
  std::string bed, write, summary;
  std::vector<std::string> scenes;
  o.text("--bed FILE", bed,
         "spheres of a settled bed, lines 'x y z diameter'; without it one is settled first; peers: the folder of "
         "--write");
  o.text("--write DIR", write, "write the scenes into this folder, for other programs, and stop");
  o.text("--summary FILE", summary, "write the figures as JSON");
  o.text("--only TEXT", s.only, "stability: cases whose name contains this");
  o.texts("--scene bed|hertz|lattice|polydisperse|drum", scenes, "peers: scenes to time; may be given several times");
  o.integer("--copies N", s.copies, 1, 1000, "peers: beds or drums side by side");
  o.number("--skin X", s.skin, program::notNegative("a skin of 0 or more, at most 10", 10.0),
           "peers: skin of the neighbour lists, m");
  o.integer("--steps N", s.steps, 2, 1000000, "steps per timing");
  o.integer("--warm-up N", s.warmUp, 1, 1000000, "steps before the timings");
  o.integer("--repeat N", s.repeats, 1, 1000, "timings, of which the median counts");
  o.integer("--threads N", s.threads, 1, 256, "threads");
  o.flag("--quick", s.quick, "small scenes, to test that all runs, without useful timings");
  if (!o.parse(argc, argv)) return false;
  s.bed = bed, s.write = write, s.summary = summary;
  if (!scenes.empty()) s.scenes = scenes;
  for (const std::string& scene : s.scenes)
    if (const std::set<std::string> known{"bed", "hertz", "lattice", "polydisperse", "drum"}; !known.contains(scene))
      throw InputError("there is no scene '" + scene + "'", "--scene",
                       "take one of bed, hertz, lattice, polydisperse, drum");
  refuseIdleOptions(o, s);
  return true;
}

}  // namespace

/// Exit code 0: done; 1: a case of the stability study neither stayed bounded nor was refused; 2: the request was
/// refused.
int main(int argc, char** argv) {
  return program::runProgram("dem", [&] {
    Settings s;
    if (!parse(argc, argv, s)) return true;
    setThreads(s.threads);
    if (!s.summary.empty()) benchmark::prepareSummary(s.summary);
    if (!s.write.empty()) {
      writeScenes(s, std::cout);
      return true;
    }
    if (s.study == "stability") return studyStability(s, std::cout);
    const std::map<std::string, void (*)(const Settings&, std::ostream&)> studies{
        {"throughput", studyThroughput}, {"peers", studyPeers},     {"leaving-out", studyLeavingOut},
        {"scaling", studyScaling},       {"threads", studyThreads}, {"accuracy", studyAccuracy}};
    studies.at(s.study)(s, std::cout);
    return true;
  });
}
