#include "settings.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cantilever {

double particleMass(const Case& beam) {
  return beam.particleDensity * std::numbers::pi / 6.0 * std::pow(beam.particleDiameter, 3);
}

double contactTime(const Case& beam) {
  const double stiffness = beam.youngsModulus * beam.particleDiameter;
  return std::numbers::pi * std::sqrt(0.5 * particleMass(beam) / stiffness);
}

void applyScheme(Settings& settings, Scheme scheme) {
  const bool paper = scheme == Scheme::paper;
  const bool paperAtAPoint = paper && settings.cgWidth == 0.0;
  settings.scheme = scheme;
  settings.lag = paperAtAPoint ? Lag::load : Lag::none;
  settings.mass = paperAtAPoint ? MassMatrix::consistent : MassMatrix::lumped;
  settings.transfer = paper ? Transfer::spread : Transfer::adjoint;
  settings.edges = paper ? EdgeHandling::paper : EdgeHandling::projected;
  settings.metric = paper ? Metric::deformed : Metric::reference;
  settings.fem = paper ? FemStepper::newmark : FemStepper::explicitDifferences;
  settings.restitution = paper ? 0.99 : 1.0;
  settings.correction = paper || settings.cgWidth == 0.0 ? Correction::none : Correction::symmetric;
  settings.surface = paper || settings.cgWidth == 0.0 ? Surface::flat : Surface::smooth;
}

bool couplingIsUnbalanced(const Settings& settings) {
  return settings.lag != Lag::none || settings.transfer == Transfer::spread;
}

namespace {

const benchmark::RunWords words{"0.9", ", 4.5465 ms; default 0.05 or a third of the critical step", "leaving",
                                "cantilever_c*d.csv", "widths|pareto|stability|ablation"};

std::string meshText(const Settings& s) {
  const auto mesh = s.mesh.value_or(Case{}.elements);
  return std::to_string(mesh[0]) + "," + std::to_string(mesh[1]) + "," + std::to_string(mesh[2]);
}

void readMesh(Settings& s, const std::string& text) {
  std::array<int, 3> mesh{};
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d,%d,%d%c", &mesh[0], &mesh[1], &mesh[2], &rest) != 3)
    throw InputError("'" + text + "' are no three counts", "--mesh", "give three whole numbers, as in 2,30,2");
  s.mesh = mesh;
}

void addPartOptions(program::Options& o, Settings& s) {
  o.choice("--lag", s.lag, "none|load|load-and-skin", "staggered steps: the load, or load and skin, one step old");
  o.choice("--transfer", s.transfer, "adjoint|spread",
           "gap and load by the same weights, or the load alone spread over the kernel (14-15)");
  o.choice("--edges", s.edges, "projected|paper", "rule where a particle touches several facets");
  o.choice("--metric", s.metric, "reference|deformed", "St Venant-Kirchhoff, or the authors' Eq. (34)");
  o.choice("--fem", s.fem, "explicit|newmark", "time integration of the beam");
  o.choice("--mass", s.mass, "lumped|consistent", "of the beam; consistent with --fem newmark --lag load only");
  o.number("--restitution E", s.restitution, {0.0, 1.0, false, true, "a number above 0 and up to 1"},
           "of a particle on a rigid wall, 0 < e <= 1");
  o.choice("--kernel-correction", s.correction, "none|linear|symmetric",
           "for the adjoint transfer: linear keeps moments, symmetric keeps even loads even (default)");
  o.choice("--surface", s.surface, "flat|smooth",
           "flat facets (default for width 0) or B-spline patches (default for a kernel)");
}

program::Options optionsOf(Settings& s) {
  program::Options o(
      "cantilever",
      "Two particles slide over an elastic cantilever (Cheng et al., CMAME 403 (2023) 115651, sec. 6.1).");
  o.choice("--scheme", s.scheme, "conservative|paper", "all parts at once; parts given below win");
  o.number("--cg-width X", s.cgWidth, program::notNegative("0 (local) or a positive number of particle diameters"),
           "kernel width c in particle diameters, 0 = local")
      .in("diameters");
  o.choice("--kernel", s.kernel, "lucy|gauss", "kernel shape");
  o.word("--element", s.element, "hex8|hybrid8", "hex8 (as the paper) or hybrid8 (locking-free)");
  o.integer("--refine N", s.refine, 1, 16, "divides every element edge by N");
  o.add(
      "--mesh NX,NY,NZ", "elements along x, y (axis), z; default 2,30,2",
      [&s](const std::string& text) { readMesh(s, text); }, [&s] { return meshText(s); });
  o.number("--stiffness-ratio R", s.stiffnessRatio, program::positive(), "contact stiffness over E d");
  addPartOptions(o, s);
  program::Option& factor = benchmark::addTimeOptions(o, s, words);
  factor.read = [read = factor.read, &s](const std::string& text) {
    read(text);
    s.dtCapped = false;
  };
  o.add("", "", {}, [&s] { return std::string(s.dtCapped ? "yes" : "no"); }).key = "dt_capped";
  benchmark::addOutputOptions(o, s, words);
  return o;
}

/// What follows from parts that were written, where nothing else was.
void settleParts(const program::Options& o, Settings& s) {
  const bool spread = s.transfer == Transfer::spread;
  if (!o.given("--kernel-correction") && spread) s.correction = Correction::none;
  if (!o.given("--surface") && (spread || s.edges == EdgeHandling::paper)) s.surface = Surface::flat;
  if (!o.given("--mass") && !(s.lag != Lag::none && s.fem == FemStepper::newmark)) s.mass = MassMatrix::lumped;
}

}  // namespace

bool parseOptions(int argc, char** argv, Settings& s) {
  s.dtCapped = true;
  program::Options o = optionsOf(s);
  if (!o.parse(argc, argv, [&s] { applyScheme(s, s.scheme); })) return false;
  o.refuseBoth("--dt", "--dt-factor");
  s.dtCapped = s.dtCapped && !s.dtAuto && s.femEvery == 1;
  settleParts(o, s);
  validate(s);
  benchmark::refuseIdleRunOptions(o, s);
  if (s.cgWidth == 0.0 && s.study.empty())
    o.refuseIdle("--kernel --kernel-correction", "without a kernel", "add --cg-width X, or leave it out");
  return true;
}

io::KeyValues describe(const Settings& settings) {
  Settings s = settings;
  return optionsOf(s).described();
}

void validate(const Settings& settings) {
  Settings s = settings;
  optionsOf(s).check();
  benchmark::checkRun(s);
  const std::array<int, 3> mesh = s.mesh.value_or(Case{}.elements);
  for (const int count : mesh)
    benchmark::require(count >= 1 && count <= 2000, "--mesh", std::to_string(count),
                       "give three counts of at least 1, as in 2,30,2");
  if (s.element != "hex8" && s.element != "hybrid8")
    throw InputError("there is no element " + s.element, "--element", "take hex8 or hybrid8");
  const double elements = 1.0 * mesh[0] * mesh[1] * mesh[2] * std::pow(s.refine, 3);
  if (elements > 4e6)
    throw InputError(formatNumber(elements) + " elements are too many", "--mesh and --refine",
                     "give fewer, at most 4 million together");
  if (s.metric == Metric::deformed && s.element != "hex8")
    throw InputError("element " + s.element + " has no deformed metric", "--metric deformed",
                     "take --element hex8, or --metric reference");
  if (s.mass == MassMatrix::consistent && !(s.lag != Lag::none && s.fem == FemStepper::newmark))
    throw InputError("a consistent mass needs an implicit step that carries the load", "--mass consistent",
                     "add --fem newmark --lag load, or take --mass lumped");
  if (s.surface == Surface::smooth && s.transfer == Transfer::spread)
    throw InputError("the smooth surface carries its loads by its own weights", "--surface smooth",
                     "take --transfer adjoint, or --surface flat");
  if (s.surface == Surface::smooth && s.edges == EdgeHandling::paper)
    throw InputError("the smooth surface has no facet edges", "--surface smooth",
                     "take --edges projected, or --surface flat");
  if (s.transfer == Transfer::spread && s.correction != Correction::none)
    throw InputError("kernel corrections are made for the adjoint transfer",
                     std::string("--kernel-correction ") + nameOf(s.correction),
                     "take --transfer adjoint, or --kernel-correction none");
}

const char* nameOf(Correction correction) {
  return std::array{"none", "linear", "symmetric"}[static_cast<std::size_t>(correction)];
}

io::KeyValues describeCase(const Case& beam) {
  return {{"length_m", formatNumber(beam.length)},
          {"side_m", formatNumber(beam.side)},
          {"youngs_modulus_Pa", formatNumber(beam.youngsModulus)},
          {"poisson_ratio", formatNumber(beam.poissonRatio)},
          {"density_kg_per_m3", formatNumber(beam.density)},
          {"particle_diameter_m", formatNumber(beam.particleDiameter)},
          {"particle_density_kg_per_m3", formatNumber(beam.particleDensity)},
          {"gravity_m_per_s2", formatNumber(beam.gravity)},
          {"start_x_m", formatNumber(beam.startX)},
          {"start_y_m", formatNumber(beam.startY)},
          {"start_velocity_m_per_s", formatNumber(beam.startVelocity)}};
}

}  // namespace dovetail::cantilever
