// What a wave run can be told, with the published case as the default, and what that means for its scene.
#pragma once

#include <string>
#include <vector>

#include "common/settings.hpp"

namespace dovetail::wave {

/// The fixed data of the published case (Cheng et al. 2023, sec. 6.2), SI, as in scenes/wave.json.
struct Case {
  double side = 0.8, elementSize = 0.4;  // m
  double youngsModulus = 1e8;
  double particleDensity = 2500.0;  // of the material; 1309 kg/m³ in bulk
  double velocity = 0.1;            // of the impulse, m/s per particle in an element's edge
  double cosineVelocity = 0.05;     // v0 of the raised cosine, m/s
};

/// Words are those of the options.
struct Settings : benchmark::RunOptions {
  Settings() { dtFactor = 0.02, outputInterval = 2e-3; }

  std::string scheme = "conservative";
  int particlesPerEdge = 1;
  double demLength = 12.0, overlap = 4.0, femLength = 12.0;  // m
  bool lengthen = true;    ///< the solid until the pulse's head stays clear of its end
  bool untilPast = false;  ///< the end is when the pulse has left the overlap, whatever the scheme
  // The parts in which the two schemes differ; each can be switched on its own.
  std::string constraint = "penalty", gap = "at-grains", weightProfile = "half-cosine", tension = "on",
              mass = "matched", fem = "explicit", dashpotMatrix = "lumped", rows = "per-node", normalised = "on",
              kernelReach = "overlap", material = "springs", order = "symmetric";
  double weightFloor = 1e-3;

  double cgWidth = 0.0;  ///< element sizes
  std::string kernel = "lucy";
  double penalty = 0.0;  ///< Pa/m²; 0 = automatic (dashpot: the published ε of n)
  std::string signal = "cosine";
  double pulseElements = 8.86;  ///< length of one cycle
  int cycles = 1;
  double amplitude = 1.0;  ///< of the signal, over the published one
  double absorber = 0.0;   ///< rate in units of wave speed / element size
  bool fullDem = false;
  double densityRatio = 1.0;  ///< solid over particles, as is stiffnessRatio
  bool compare = true;        ///< with a run of particles alone

  bool implicit() const { return fem == "newmark"; }
  bool impulse() const { return signal == "impulse"; }
  bool tensile() const { return tension == "on"; }
  double diameter() const { return Case{}.elementSize / particlesPerEdge; }  ///< m
  double contactStiffness() const { return Case{}.youngsModulus * diameter(); }
};

double particleMass(const Settings& settings);      ///< kg
double bulkDensity();                               ///< of the lattice, kg/m³
double waveSpeed();                                 ///< √(E/ρ), m/s
double contactTime(const Settings& settings);       ///< t_c = π √(m/2k), s; the unit of --dt-factor
double angularFrequency(const Settings& settings);  ///< of the raised cosine, rad/s
double driveTime(const Settings& settings);         ///< of the raised cosine, s
double endTime(const Settings& settings);           ///< s: --until, or what the comparison needs
int solidElements(const Settings& settings);        ///< along the bar, lengthened as needed
double barLength(const Settings& settings);         ///< of the whole bar, m
double massFraction(const Settings& settings);      ///< of the consistent mass of the solid
/// What the constraint gets: as asked for, the published ε of the dashpot (Table 6), or automatic, Pa/m².
double penaltyOf(const Settings& settings);

/// Reads the words of a command line. @throws InputError for unknown options and what cannot be
/// @return false for --help, which is printed
bool parseOptions(int argc, char** argv, Settings& settings);

/// Changes of scenes/wave.json, "key=value".
std::vector<std::string> changesOfScene(const Settings& settings, double penalty);

/// Option names and values as text, for provenance, the summary and the tables of studies.
io::KeyValues describe(const Settings& settings);

}  // namespace dovetail::wave
