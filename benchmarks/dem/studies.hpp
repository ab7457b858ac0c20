// Studies: sets of scenes and the tables they make.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace dovetail::dem_benchmark {

struct Settings {
  std::string study = "throughput";
  std::filesystem::path bed;    ///< spheres of a settled bed, 20 × 20 wide; empty: settle one; peers: folder of scenes
  std::filesystem::path write;  ///< folder: writes the scenes for other programs, and stops
  std::filesystem::path summary;
  std::string only;                        ///< of the stability study: cases whose name holds this
  std::vector<std::string> scenes{"bed"};  ///< of the study of peers
  int steps = 100, warmUp = 300, repeats = 5, threads = 1, copies = 5;
  double skin = 0.1;   ///< m, of the study of peers
  bool quick = false;  ///< small scenes, few steps: to see whether all runs
};

/// Frictional bed (linear and Hertz), frictionless lattice, big spheres among small ones, box of planes and of
/// triangles.
void studyThroughput(const Settings& settings, std::ostream& out);
/// Chosen scenes, from the folder that writeScenes has filled.
void studyPeers(const Settings& settings, std::ostream& out);
/// What an absent feature costs.
void studyLeavingOut(const Settings& settings, std::ostream& out);
/// Cost against number and size ratio.
void studyScaling(const Settings& settings, std::ostream& out);
/// One thread against two.
void studyThreads(const Settings& settings, std::ostream& out);
/// Stiff and extreme cases: bounded, or refused with a reason. Returns whether every row is one or the other.
bool studyStability(const Settings& settings, std::ostream& out);
/// Error and residual of the ledger against run time, law by law.
void studyAccuracy(const Settings& settings, std::ostream& out);
/// Writes the scenes as sphere lists and inputs of LAMMPS.
void writeScenes(const Settings& settings, std::ostream& out);

}  // namespace dovetail::dem_benchmark
