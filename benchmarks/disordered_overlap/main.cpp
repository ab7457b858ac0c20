#include <filesystem>
#include <iostream>
#include <string>

#include "equilibrium_study.hpp"
#include "program/options.hpp"
#include "program/run.hpp"
#include "wave_study.hpp"

namespace {

using namespace dovetail;
using namespace dovetail::disordered_overlap;

struct Settings {
  std::string study = "all", out = "disordered-overlap-output";
  bool quick = false, friction = false;
  int packings = 10, workers = 1, steps = 100000;
  double strain = 2e-5, weight = 0.3;
};

bool parse(int argc, char** argv, Settings& s) {
  program::Options o("bed", "Random frictional packings that share an overlap with a solid, at rest and in waves.");
  o.word("--study WORD", s.study, "all|equilibrium|wave", "what to run");
  o.flag("--quick", s.quick, "2 packings for the wave and 5000 steps at rest");
  o.integer("--packings N", s.packings, 1, 1000, "of the ensemble for the wave");
  o.integer("--steps N", s.steps, 100, 100000000, "of the column after it has come to rest");
  o.number("--strain X", s.strain, program::positive("a positive number", 1e-3), "largest of the pulse");
  o.number("--step-fraction X", s.weight, program::positive("a number up to 0.9", 0.9),
           "of the critical step, for the wave");
  o.flag("--with-friction", s.friction,
         "compresses the packings for the wave with friction, and compacts them by shaking");
  o.integer("--workers N", s.workers, 1, 1024, "processes, one packing each");
  o.text("--out DIR", s.out, "folder for tables");
  if (!o.parse(argc, argv)) return false;
  if (s.quick && !o.given("--packings")) s.packings = 2;
  if (s.quick && !o.given("--steps")) s.steps = 5000;
  return true;
}

bool run(const Settings& s) {
  std::filesystem::create_directories(s.out);
  if (s.study != "wave") runEquilibriumStudy({.steps = s.steps, .quick = s.quick, .folder = s.out});
  if (s.study == "equilibrium") return true;
  return runWaveStudy({.packings = s.packings,
                       .workers = s.workers,
                       .friction = s.friction,
                       .strain = s.strain,
                       .weight = s.weight,
                       .folder = s.out});
}

}  // namespace

/// Exit code 0: all was run; 1: a run broke down; 2: the request was refused.
int main(int argc, char** argv) {
  return program::runProgram("bed", [&] {
    Settings s;
    return !parse(argc, argv, s) || run(s);
  });
}
