// Everything a cantilever run can be told, with the published case as the default.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "common/settings.hpp"
#include "dovetail/cg/surface_kernel.hpp"
#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/walls/wall_contacts.hpp"

namespace dovetail::cantilever {

/// The fixed data of the published case (Cheng et al. 2023, Table 1 and Fig. 11), SI.
struct Case {
  double length = 12.0, side = 0.8;       // m
  std::array<int, 3> elements{2, 30, 2};  // along x, y (axis), z
  double youngsModulus = 1e8, poissonRatio = 0.0, density = 1309.0;
  double particleDiameter = 0.2, particleDensity = 2e4;
  double gravity = 9.81;
  double startX = 0.2, startY = 0.2, startVelocity = 0.1;
};

/// A particle pair's contact time t_c = π √(m_eff / k_n), s, with k_n = E d and m_eff = m / 2: the unit of --dt-factor.
double contactTime(const Case& beam);
double particleMass(const Case& beam);

enum class Scheme { conservative, paper };
/// Staggered steps: the load on the solid is that of the last contact evaluation (load), and the particles see the skin
/// as it was before the solid's step (loadAndSkin).
using coupling::Lag;
enum class Transfer { adjoint, spread };    ///< adjoint pair, or kernel at the contact with a local gap (14–15)
using EdgeHandling = dem::EdgeRule;         ///< one projection, or the authors' face rule
enum class Metric { reference, deformed };  ///< St Venant–Kirchhoff, or the authors' Eq. (34)
enum class MassMatrix { lumped, consistent };
enum class FemStepper { explicitDifferences, newmark };
enum class Surface { flat, smooth };
using KernelName = cg::KernelShape;
using Correction = cg::KernelCorrection;

struct Settings : benchmark::RunSettings {
  using Fixed = Case;
  Settings() { dtFactor = 0.05, outputInterval = 0.25; }

  Scheme scheme = Scheme::conservative;
  // The parts in which the two schemes differ; each can be switched on its own.
  Lag lag = Lag::none;
  Transfer transfer = Transfer::adjoint;
  EdgeHandling edges = EdgeHandling::projected;
  Metric metric = Metric::reference;
  FemStepper fem = FemStepper::explicitDifferences;
  MassMatrix mass = MassMatrix::lumped;
  double restitution = 1.0;

  double cgWidth = 0.0;  ///< particle diameters
  KernelName kernel = KernelName::lucy;
  Correction correction = Correction::none;
  Surface surface = Surface::flat;
  std::string element = "hex8";
  int refine = 1;
  std::optional<std::array<int, 3>> mesh;  ///< elements along x, y, z before refinement
  bool dtCapped = false;  ///< the step is no more than a third of the critical one (the program's default)
};

/// Sets the scheme's parts for the settings' kernel width.
///
/// conservative: adjoint pair at the same instant, explicit; flat facets for width 0, the smooth surface and the
/// symmetric correction for a kernel. paper: load spread by Eqs. 14 and 15 (16 for width 0), gap of the local facets,
/// the authors' face rule, deformed metric, implicit FEM, restitution 0.99. The lag and the consistent mass go with
/// width 0 only: see the README for what is known of the authors' runs.
void applyScheme(Settings& settings, Scheme scheme);

/// @throws InputError naming the option, what is wrong with it and what to write instead
void validate(const Settings& settings);

/// Reads the command line. @throws InputError for unknown options and impossible values
/// @return false for --help, which is printed
bool parseOptions(int argc, char** argv, Settings& settings);

/// Whether the contacts and the solid exchange work that is not the same on both sides, so that it must be booked.
bool couplingIsUnbalanced(const Settings& settings);

const char* nameOf(Correction correction);
/// Option names and values as text, for provenance, the summary and the tables of studies.
io::KeyValues describe(const Settings& settings);
/// What no option changes: sizes and materials, by names that end with their units (SI).
io::KeyValues describeCase(const Case& fixed);

}  // namespace dovetail::cantilever
