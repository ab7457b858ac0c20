#include "settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::wave {

namespace {
constexpr double pi = std::numbers::pi;
constexpr double clearance = 0.8;  // m, of the pulse's tail past the overlap
}  // namespace

double particleDiameter(const Settings& s) { return Case{}.elementSize / s.particlesPerEdge; }
double particleMass(const Settings& s) { return Case{}.particleDensity * pi / 6.0 * std::pow(particleDiameter(s), 3); }
double bulkDensity() { return Case{}.particleDensity * pi / 6.0; }
double waveSpeed() { return std::sqrt(Case{}.youngsModulus / bulkDensity()); }
double contactTime(const Settings& s) {
  return pi * std::sqrt(0.5 * particleMass(s) / (Case{}.youngsModulus * particleDiameter(s)));
}
double pulseLength(const Settings& s) { return s.pulseElements * Case{}.elementSize; }
double angularFrequency(const Settings& s) { return 2.0 * pi * waveSpeed() / pulseLength(s); }
double driveTime(const Settings& s) {
  return s.signal == Signal::cosine ? 2.0 * pi * s.cycles / angularFrequency(s) : 0.0;
}

double measuringTime(const Settings& s) {
  const double travel = (s.demLength + clearance) / waveSpeed();
  return s.signal == Signal::cosine ? driveTime(s) + travel : 2.0 * travel;
}

double endTime(const Settings& s) {
  if (s.until) return *s.until;
  return s.scheme == Scheme::paper ? 0.1 : measuringTime(s);
}

int solidElements(const Settings& s) {
  const double h = Case{}.elementSize;
  double length = s.femLength;
  if (s.lengthen && s.scheme != Scheme::paper)
    length = std::max(length, waveSpeed() * endTime(s) - (s.demLength - s.overlap) + 2.0 * h);
  return static_cast<int>(std::ceil(length / h - 1e-9));
}

double publishedPenalty(int particlesPerEdge) { return 1e10 * particlesPerEdge * particlesPerEdge; }

void applyScheme(Settings& s, Scheme scheme) {
  const bool paper = scheme == Scheme::paper;
  s.scheme = scheme;
  s.constraint = paper ? Constraint::dashpot : Constraint::penalty;
  s.gap = paper ? Gap::nodal : Gap::atParticles;
  s.weightFloor = paper ? 0.1 : 1e-3;
  s.weightProfile = WeightProfile::halfCosine;
  s.tension = !paper;
  s.mass = paper ? Mass::consistent : Mass::matched;
  s.fem = paper ? FemStepper::newmark : FemStepper::explicitDifferences;
  s.dashpotMatrix = DashpotMatrix::lumped;
  s.rows = paper ? Rows::perElement : Rows::perNode;
  s.normaliseKernels = !paper;
  s.kernelReach = paper ? KernelReach::outside : KernelReach::overlap;
  s.material = paper ? Material::kirchhoff : Material::springs;
  s.staggered = paper;
  s.dtFactor = paper ? 0.01 : 0.02;
  s.signal = paper ? Signal::impulse : Signal::cosine;
}

namespace {

void check(bool good, const std::string& option, const std::string& value, const std::string& remedy) {
  if (!good) throw InputError("the value " + value + " is not possible", option, remedy);
}

void checkNumber(double value, bool good, const std::string& option, const std::string& remedy) {
  check(std::isfinite(value) && good, option, formatNumber(value), remedy);
}

void checkWholeElements(double length, const std::string& option) {
  const double h = Case{}.elementSize, count = length / h;
  checkNumber(length, length >= h * (1.0 - 1e-9) && length <= 4000.0 && std::abs(count - std::round(count)) < 1e-6,
              option, "give a multiple of the element size, 0.4 m, up to 4000 m");
}

void checkLengths(const Settings& s) {
  checkWholeElements(s.demLength, "--dem-length");
  checkWholeElements(s.femLength, "--fem-length");
  if (!(s.overlap > 0.0))
    throw InputError("an overlap of " + formatNumber(s.overlap) + " m has no particles and no elements", "--overlap",
                     "give a multiple of the element size, 0.4 m, of at least 0.8 m");
  checkNumber(s.overlap, true, "--overlap", "give a length in metres");
  if (s.overlap < 2.0 * Case{}.elementSize * (1.0 - 1e-9))
    throw InputError("an overlap of " + formatNumber(s.overlap) +
                         " m is too narrow: its weights would fall from 1 to 0 within one element",
                     "--overlap", "give at least two elements, 0.8 m");
  checkWholeElements(s.overlap, "--overlap");
  if (s.overlap >= s.demLength || s.overlap >= s.femLength)
    throw InputError("the overlap of " + formatNumber(s.overlap) + " m is not shorter than both models", "--overlap",
                     "give less than --dem-length and --fem-length");
}

void checkSize(const Settings& s) {
  constexpr double most = 4e6;
  const double h = Case{}.elementSize, solid = solidElements(s) * h;
  const double withParticles = s.fullDem || s.compare ? s.demLength - s.overlap + solid : s.demLength;
  const double particles = 4.0 * withParticles / h * std::pow(s.particlesPerEdge, 3);
  if (std::max(particles, 4.0 * solid / h) > most)
    throw InputError("up to " + formatNumber(std::round(particles)) + " particles and " +
                         formatNumber(std::round(4.0 * solid / h)) + " elements are too many",
                     "--particles-per-edge, --until and the lengths", "make them fewer, at most 4 million of each");
}

void checkCombinations(const Settings& s) {
  if (s.study != Study::none && !s.summary.empty())
    throw InputError("a study writes its own summary", "--summary", "take --out DIR, which gets <study>.json");
  if (s.study != Study::none && !s.reference.empty())
    throw InputError("a study is not compared with the published curves", "--reference",
                     "leave out --study or --reference");
  if (s.staggered && (s.fem != FemStepper::newmark || s.constraint != Constraint::dashpot))
    throw InputError("staggered steps are made for the dashpot and an implicit solid", "--order staggered",
                     "add --constraint dashpot --fem newmark, or take --order symmetric");
  if (s.kernelReach == KernelReach::outside && s.gap == Gap::atParticles)
    throw InputError("particles outside of the mesh have no solid to be compared with", "--kernel-reach outside",
                     "take --gap nodal, or --kernel-reach overlap");
  if (s.staggered && s.femEvery != 1)
    throw InputError("staggered steps take the solid along at every step", "--fem-every", "take 1");
  if (s.absorber > 0.0 && (s.fem == FemStepper::newmark))
    throw InputError("the absorber acts at every step of the particles", "--absorber", "take --fem explicit");
}

}  // namespace

void validate(const Settings& s) {
  check(s.particlesPerEdge >= 1 && s.particlesPerEdge <= 8, "--particles-per-edge", std::to_string(s.particlesPerEdge),
        "give a whole number from 1 to 8");
  checkLengths(s);
  checkNumber(s.cgWidth, s.cgWidth >= 0.0 && s.cgWidth <= 100.0, "--cg-width",
              "give 0 (local) or a positive number of element sizes, up to 100");
  checkNumber(s.penalty, s.penalty >= 0.0, "--penalty", "give a positive number in Pa/m2, or leave it out (automatic)");
  checkNumber(s.weightFloor, s.weightFloor >= 0.0 && s.weightFloor < 0.5, "--weight-floor",
              "give a number from 0 to below 0.5");
  checkNumber(s.pulseElements, s.pulseElements > 0.0 && s.pulseElements <= 1000.0, "--pulse-elements",
              "give a positive number of elements, up to 1000");
  check(s.cycles >= 1 && s.cycles <= 100, "--cycles", std::to_string(s.cycles), "give a whole number from 1 to 100");
  checkNumber(s.amplitude, s.amplitude > 0.0 && s.amplitude <= 100.0, "--amplitude",
              "give a positive factor on the published signal, up to 100");
  checkNumber(s.absorber, s.absorber >= 0.0, "--absorber", "give 0 (none) or a positive rate, about 1");
  checkNumber(s.dtFactor, s.dtFactor > 0.0, "--dt-factor", "give a positive share of the contact time, or --dt auto");
  if (s.until)
    checkNumber(*s.until, *s.until > 0.0 && *s.until <= 100.0, "--until", "give a time in seconds, up to 100");
  checkNumber(s.outputInterval, s.outputInterval > 0.0, "--output-interval", "give a positive time in seconds");
  checkNumber(s.stiffnessRatio, s.stiffnessRatio > 0.0, "--stiffness-ratio", "give a positive number");
  checkNumber(s.densityRatio, s.densityRatio > 0.0, "--density-ratio", "give a positive number");
  check(s.femEvery >= 1 && s.femEvery <= 1000, "--fem-every", std::to_string(s.femEvery),
        "give a whole number from 1 to 1000");
  check(s.threads >= 1 && s.threads <= 1024, "--threads", std::to_string(s.threads),
        "give a whole number from 1 to 1024");
  checkSize(s);
  checkCombinations(s);
}

std::vector<std::pair<std::string, std::string>> describe(const Settings& s) {
  const auto text = [](double value) { return formatNumber(value); };
  const auto pick = [](int value, std::initializer_list<const char*> names) {
    return std::string(names.begin()[value]);
  };
  return {{"scheme", pick(static_cast<int>(s.scheme), {"conservative", "paper"})},
          {"particles_per_edge", std::to_string(s.particlesPerEdge)},
          {"dem_length_m", text(s.demLength)},
          {"overlap_m", text(s.overlap)},
          {"fem_length_m", text(solidElements(s) * Case{}.elementSize)},
          {"constraint", pick(static_cast<int>(s.constraint), {"penalty", "multiplier", "dashpot"})},
          {"gap", pick(static_cast<int>(s.gap), {"at-grains", "nodal"})},
          {"weight_floor", text(s.weightFloor)},
          {"weight_profile", pick(static_cast<int>(s.weightProfile), {"half-cosine", "linear", "smooth"})},
          {"tension", s.tension ? "on" : "off"},
          {"mass", pick(static_cast<int>(s.mass), {"lumped", "consistent", "matched"})},
          {"fem", pick(static_cast<int>(s.fem), {"explicit", "newmark"})},
          {"dashpot_matrix", pick(static_cast<int>(s.dashpotMatrix), {"lumped", "consistent"})},
          {"rows", pick(static_cast<int>(s.rows), {"per-node", "per-element"})},
          {"kernel_normalisation", s.normaliseKernels ? "on" : "off"},
          {"kernel_reach", pick(static_cast<int>(s.kernelReach), {"overlap", "outside"})},
          {"material", pick(static_cast<int>(s.material), {"springs", "kirchhoff"})},
          {"order", s.staggered ? "staggered" : "symmetric"},
          {"cg_width_elements", text(s.cgWidth)},
          {"kernel", pick(static_cast<int>(s.kernel), {"lucy", "gauss"})},
          {"penalty_Pa_m2", s.penalty == 0.0 ? "auto" : text(s.penalty)},
          {"signal", pick(static_cast<int>(s.signal), {"impulse", "cosine"})},
          {"pulse_elements", text(s.pulseElements)},
          {"cycles", std::to_string(s.cycles)},
          {"amplitude", text(s.amplitude)},
          {"absorber", text(s.absorber)},
          {"full_dem", s.fullDem ? "yes" : "no"},
          {"dt_factor", s.dtAuto            ? "auto"
                        : s.shareOfCritical ? text(*s.shareOfCritical) + " of critical"
                                            : text(s.dtFactor)},
          {"fem_every", std::to_string(s.femEvery)},
          {"until_s", text(endTime(s))},
          {"stiffness_ratio", text(s.stiffnessRatio)},
          {"density_ratio", text(s.densityRatio)},
          {"threads", std::to_string(s.threads)}};
}

std::vector<std::pair<std::string, std::string>> describeCase() {
  const Case bar;
  return {{"side_m", formatNumber(bar.side)},
          {"element_size_m", formatNumber(bar.elementSize)},
          {"youngs_modulus_Pa", formatNumber(bar.youngsModulus)},
          {"poisson_ratio", formatNumber(bar.poissonRatio)},
          {"particle_density_kg_per_m3", formatNumber(bar.particleDensity)},
          {"impulse_velocity_m_per_s", formatNumber(bar.velocity)},
          {"cosine_velocity_m_per_s", formatNumber(bar.cosineVelocity)}};
}

std::vector<std::pair<std::string, std::string>> provenanceOf(const Settings& settings) {
  auto entries = describe(settings);
  for (auto& entry : describeCase()) entries.push_back(std::move(entry));
  return io::provenance(entries);
}

}  // namespace dovetail::wave
