#include <iostream>
#include <map>

#include "common/command_line.hpp"
#include "common/outputs.hpp"
#include "common/program.hpp"
#include "dovetail/core/parallel.hpp"
#include "studies.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::dem_benchmark;

void refuseIdleOptions(const CLI::App& app, const Settings& s) {
  using benchmark::refuseIdle;
  const std::string with = "with --study " + s.study, remedy = "leave it out";
  if (!s.write.empty())
    refuseIdle(app, {"--study", "--summary", "--scene", "--copies", "--steps", "--warm-up", "--repeat"}, "with --write",
               remedy);
  if (s.study != "peers") refuseIdle(app, {"--scene", "--copies"}, with, remedy);
  if (s.study == "peers") refuseIdle(app, {"--quick"}, with, remedy);
  if (s.study == "threads") refuseIdle(app, {"--threads"}, with, remedy);
  if (s.study == "stability")
    refuseIdle(app, {"--bed", "--summary", "--steps", "--warm-up", "--repeat", "--quick"}, with, remedy);
  if (s.study == "accuracy") refuseIdle(app, {"--bed", "--summary", "--steps", "--warm-up"}, with, remedy);
  if (s.study == "leaving-out" || s.study == "scaling") refuseIdle(app, {"--bed", "--warm-up"}, with, remedy);
}

bool parse(int argc, char** argv, Settings& s) {
  CLI::App app{"Times the particle engine, and checks it on stiff and extreme cases.", "dem"};
  app.add_option("--study", s.study, "what to do")
      ->check(CLI::IsMember({"throughput", "peers", "leaving-out", "scaling", "threads", "stability", "accuracy"})
                  .description(""))
      ->option_text("throughput|peers|leaving-out|scaling|threads|stability|accuracy");
  app.add_option("--bed", s.bed,
                 "spheres of a settled bed, lines 'x y z diameter'; without it one is settled first; peers: the folder "
                 "of --write");
  app.add_option("--write", s.write, "write the scenes into this folder, for other programs, and stop");
  app.add_option("--summary", s.summary, "write the figures as JSON");
  app.add_option("--scene", s.scenes, "peers: what to time")
      ->check(CLI::IsMember({"bed", "hertz", "lattice", "polydisperse", "drum"}).description(""))
      ->option_text("bed|hertz|lattice|polydisperse|drum ...");
  app.add_option("--copies", s.copies, "peers: beds or drums side by side")->check(CLI::Range(1, 1000));
  app.add_option("--steps", s.steps, "steps per timing")->check(CLI::Range(2, 1000000));
  app.add_option("--warm-up", s.warmUp, "steps before the timings")->check(CLI::Range(1, 1000000));
  app.add_option("--repeat", s.repeats, "timings, of which the median counts")->check(CLI::Range(1, 1000));
  app.add_option("--threads", s.threads, "threads")->check(CLI::Range(1, 256));
  app.add_flag("--quick", s.quick, "small scenes: to see whether all runs, not to time");
  if (!benchmark::parseCommandLine(app, argc, argv)) return false;
  refuseIdleOptions(app, s);
  return true;
}

}  // namespace

/// Exit code 0: done; 1: a case of the stability study neither stayed bounded nor was refused; 2: the request was
/// refused.
int main(int argc, char** argv) {
  return benchmark::runProgram("dem", [&] {
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
