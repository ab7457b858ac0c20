#include "settings.hpp"

#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/provenance.hpp"

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

void checkRange(bool good, const std::string& option, const std::string& value, const std::string& remedy) {
  if (!good) throw InputError("the value " + value + " is not possible", option, remedy);
}

void checkNumber(double value, bool good, const std::string& option, const std::string& remedy) {
  checkRange(std::isfinite(value) && good, option, formatNumber(value), remedy);
}

}  // namespace

void validate(const Settings& s) {
  checkNumber(s.cgWidth, s.cgWidth >= 0.0, "--cg-width", "give 0 (local) or a positive number of particle diameters");
  checkNumber(s.dtFactor, s.dtFactor > 0.0, "--dt-factor", "give a positive share of the contact time, or --dt auto");
  checkNumber(s.restitution, s.restitution > 0.0 && s.restitution <= 1.0, "--restitution",
              "give a number above 0 and up to 1");
  checkNumber(s.stiffnessRatio, s.stiffnessRatio > 0.0, "--stiffness-ratio", "give a positive number");
  if (s.until) checkNumber(*s.until, *s.until > 0.0, "--until", "give a positive time in seconds");
  checkNumber(s.outputInterval, s.outputInterval > 0.0, "--output-interval", "give a positive time in seconds");
  checkRange(s.refine >= 1 && s.refine <= 16, "--refine", std::to_string(s.refine), "give a whole number from 1 to 16");
  checkRange(s.femEvery >= 1 && s.femEvery <= 1000, "--fem-every", std::to_string(s.femEvery),
             "give a whole number from 1 to 1000");
  checkRange(s.threads >= 1 && s.threads <= 1024, "--threads", std::to_string(s.threads),
             "give a whole number from 1 to 1024");
  if (s.mesh)
    for (int count : *s.mesh)
      checkRange(count >= 1 && count <= 2000, "--mesh", std::to_string(count),
                 "give three counts of at least 1, as in 2,30,2");
  if (s.element != "hex8" && s.element != "hybrid8")
    throw InputError("there is no element " + s.element, "--element", "take hex8 or hybrid8");
  const std::array<int, 3> mesh = s.mesh.value_or(Case{}.elements);
  const double elements = 1.0 * mesh[0] * mesh[1] * mesh[2] * std::pow(s.refine, 3);
  if (elements > 4e6)
    throw InputError(formatNumber(elements) + " elements are too many", "--mesh and --refine",
                     "give fewer, at most 4 million together");
  if (s.study != Study::none && !s.summary.empty())
    throw InputError("a study writes its own summary", "--summary", "take --out DIR, which gets <study>.json");
  if (s.study != Study::none && !s.reference.empty())
    throw InputError("a study is not compared with the published curves", "--reference",
                     "leave out --study or --reference");
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
  switch (correction) {
    case Correction::linear:
      return "linear";
    case Correction::symmetric:
      return "symmetric";
    case Correction::none:
      break;
  }
  return "none";
}

std::vector<std::pair<std::string, std::string>> describe(const Settings& s) {
  const auto text = [](double value) { return formatNumber(value); };
  std::vector<std::pair<std::string, std::string>> rows{
      {"scheme", s.scheme == Scheme::paper ? "paper" : "conservative"},
      {"lag", s.lag == Lag::none   ? "none"
              : s.lag == Lag::load ? "load"
                                   : "load-and-skin"},
      {"transfer", s.transfer == Transfer::spread ? "spread" : "adjoint"},
      {"edges", s.edges == EdgeHandling::paper ? "paper" : "projected"},
      {"metric", s.metric == Metric::deformed ? "deformed" : "reference"},
      {"fem", s.fem == FemStepper::newmark ? "newmark" : "explicit"},
      {"mass", s.mass == MassMatrix::consistent ? "consistent" : "lumped"},
      {"restitution", text(s.restitution)},
      {"cg_width_diameters", text(s.cgWidth)},
      {"kernel", s.kernel == KernelName::gauss ? "gauss" : "lucy"},
      {"kernel_correction", nameOf(s.correction)},
      {"surface", s.surface == Surface::smooth ? "smooth" : "flat"},
      {"element", s.element},
      {"refine", std::to_string(s.refine)},
      {"dt_factor", s.dtAuto            ? "auto"
                    : s.shareOfCritical ? text(*s.shareOfCritical) + " of critical"
                                        : text(s.dtFactor)},
      {"dt_capped", s.dtCapped ? "yes" : "no"},
      {"fem_every", std::to_string(s.femEvery)},
      {"until_s", s.until ? text(*s.until) : "leaving"},
      {"stiffness_ratio", text(s.stiffnessRatio)},
      {"threads", std::to_string(s.threads)}};
  const std::array<int, 3> mesh = s.mesh.value_or(Case{}.elements);
  rows.emplace_back("mesh", std::to_string(mesh[0]) + "," + std::to_string(mesh[1]) + "," + std::to_string(mesh[2]));
  return rows;
}

std::vector<std::pair<std::string, std::string>> describeCase() {
  const Case beam;
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

std::vector<std::pair<std::string, std::string>> provenanceOf(const Settings& settings) {
  auto entries = describe(settings);
  for (auto& entry : describeCase()) entries.push_back(std::move(entry));
  return io::provenance(entries);
}

}  // namespace dovetail::cantilever
