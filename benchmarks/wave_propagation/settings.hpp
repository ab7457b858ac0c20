// Everything a wave run can be told, with the published case as the default.
#pragma once

#include "common/settings.hpp"
#include "dovetail/arlequin/coupling_options.hpp"
#include "dovetail/arlequin/weights.hpp"

namespace dovetail::wave {

/// The fixed data of the published case (Cheng et al. 2023, sec. 6.2), SI.
struct Case {
  double side = 0.8, elementSize = 0.4;  // m
  double youngsModulus = 1e8, poissonRatio = 0.0;
  double particleDensity = 2500.0;  // of the material; 1309 kg/m³ in bulk
  double velocity = 0.1;            // of the impulse, m/s per particle in an element's edge
  double cosineVelocity = 0.05;     // v0 of the raised cosine, m/s
};

enum class Scheme { conservative, paper };
using Constraint = arlequin::ConstraintKind;
using Gap = arlequin::GapForm;
using Kernel = cg::KernelShape;
using WeightProfile = arlequin::WeightProfile;
enum class Signal { impulse, cosine };
enum class Mass { lumped, consistent, matched };
enum class FemStepper { explicitDifferences, newmark };
enum class DashpotMatrix { lumped, consistent };
enum class Rows { perNode, perElement };
enum class KernelReach { overlap, outside };
enum class Material { springs, kirchhoff };

struct Settings : benchmark::RunSettings {
  using Fixed = Case;
  Settings() { dtFactor = 0.02, outputInterval = 2e-3; }

  Scheme scheme = Scheme::conservative;
  int particlesPerEdge = 1;
  double demLength = 12.0, overlap = 4.0, femLength = 12.0;  // m
  bool lengthen = true;  ///< the solid until the pulse's head stays clear of its end
  // The parts in which the two schemes differ; each can be switched on its own.
  Constraint constraint = Constraint::penalty;
  Gap gap = Gap::atParticles;
  double weightFloor = 1e-3;
  WeightProfile weightProfile = WeightProfile::halfCosine;
  bool tension = true;
  Mass mass = Mass::matched;
  FemStepper fem = FemStepper::explicitDifferences;
  DashpotMatrix dashpotMatrix = DashpotMatrix::lumped;
  Rows rows = Rows::perNode;
  bool normaliseKernels = true;
  KernelReach kernelReach = KernelReach::overlap;
  Material material = Material::springs;
  bool staggered = false;  ///< coupling forces of the last step's increments, frozen over the step

  double cgWidth = 0.0;  ///< element sizes
  Kernel kernel = Kernel::lucy;
  double penalty = 0.0;  ///< Pa/m²; 0 = automatic (dashpot: the published ε of n)
  Signal signal = Signal::cosine;
  double pulseElements = 8.86;  ///< length of one cycle
  int cycles = 1;
  double amplitude = 1.0;  ///< of the signal, over the published one
  double absorber = 0.0;   ///< rate in units of wave speed / element size
  bool fullDem = false;
  double densityRatio = 1.0;  ///< solid over particles, as is stiffnessRatio
  bool compare = true;        ///< with a run of particles alone
};

double particleDiameter(const Settings& settings);  ///< m
double particleMass(const Settings& settings);      ///< kg
double bulkDensity();                               ///< of the lattice, kg/m³
double waveSpeed();                                 ///< √(E/ρ), m/s
double contactTime(const Settings& settings);       ///< t_c = π √(m/2k), s; the unit of --dt-factor
double pulseLength(const Settings& settings);       ///< of one cycle, m
double angularFrequency(const Settings& settings);  ///< of the raised cosine, rad/s
double driveTime(const Settings& settings);         ///< of the raised cosine, s
/// When the pulse's tail is 0.8 m past the overlap; for the impulse, when its front could be back at the start.
double measuringTime(const Settings& settings);  ///< s
double endTime(const Settings& settings);        ///< s: --until, or what the comparison needs
int solidElements(const Settings& settings);     ///< along the bar, lengthened as needed
double publishedPenalty(int particlesPerEdge);   ///< ε of Table 6, Pa/m²

/// Sets the scheme's parts. conservative: penalty on the accumulated gap at the particles, explicit, matched mass,
/// bonded contacts. paper: dashpot on the nodal gap, weights 0.1 … 0.9, staggered, implicit, contacts without tension.
void applyScheme(Settings& settings, Scheme scheme);

/// @throws InputError naming the option, what is wrong with it and what to write instead
void validate(const Settings& settings);

/// Reads the command line. @throws InputError for unknown options and impossible values
/// @return false for --help, which is printed
bool parseOptions(int argc, char** argv, Settings& settings);

/// Option names and values as text, for provenance, the summary and the tables of studies.
io::KeyValues describe(const Settings& settings);
/// What no option changes: sizes and materials, by names that end with their units (SI).
io::KeyValues describeCase(const Case& fixed);

}  // namespace dovetail::wave
