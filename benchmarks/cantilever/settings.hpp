// What a cantilever run can be told, with the published case as the default, and what that means for its scene.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/settings.hpp"

namespace dovetail::cantilever {

/// The fixed data of the published case (Cheng et al. 2023, Table 1 and Fig. 11), SI, as in scenes/cantilever.json.
struct Case {
  double length = 12.0, side = 0.8;  // m
  double youngsModulus = 1e8, density = 1309.0;
  double particleDiameter = 0.2, particleDensity = 2e4;
  double gravity = 9.81;
  double startX = 0.2, startY = 0.2, startVelocity = 0.1;
};

inline constexpr double longestRun = 100.0;  ///< s, where nobody leaves

/// A particle pair's contact time t_c = π √(m_eff / k_n), s, with k_n = E d and m_eff = m / 2: the unit of --dt-factor.
double contactTime();
double particleMass();

/// Words are those of the options.
struct Settings : benchmark::RunOptions {
  Settings() { dtFactor = 0.05, outputInterval = 0.25; }

  std::string scheme = "conservative";
  // The parts in which the two schemes differ; each can be switched on its own.
  std::string lag = "none", transfer = "adjoint", edges = "projected", metric = "reference", fem = "explicit",
              mass = "lumped", correction = "none", surface = "flat";
  double restitution = 1.0;

  double cgWidth = 0.0;  ///< particle diameters
  std::string kernel = "lucy", element = "hex8";
  int refine = 1;
  std::array<int, 3> mesh{2, 30, 2};  ///< elements along x, y (axis), z before refinement
  bool dtCapped = false;  ///< the step is no more than a third of the critical one (unless one is asked for)

  double contactStiffness() const { return stiffnessRatio * Case{}.youngsModulus * Case{}.particleDiameter; }
  std::array<int, 3> elements() const { return {mesh[0] * refine, mesh[1] * refine, mesh[2] * refine}; }
  bool implicit() const { return fem == "newmark"; }
};

/// Reads the words of a command line. @throws InputError for unknown options and what cannot be
/// @return false for --help, which is printed
bool parseOptions(int argc, char** argv, Settings& settings);

/// Changes of scenes/cantilever.json, "key=value".
std::vector<std::string> changesOfScene(const Settings& settings);

/// Option names and values as text, for provenance, the summary and the tables of studies.
io::KeyValues describe(const Settings& settings);

}  // namespace dovetail::cantilever
