#include "settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

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

const benchmark::RunWords words{"0.5", "", "until the pulse has left the overlap", "wave_*P_c*dX.csv",
                                "widths|pareto|stability|constraints"};
using program::Options, program::positive, program::notNegative;

void addBarOptions(Options& o, Settings& s) {
  const program::Range length{0.0, 4000.0, false, true, "a multiple of the element size, 0.4 m, up to 4000 m"};
  o.group("Bar");
  o.integer("--particles-per-edge N", s.particlesPerEdge, 1, 8, "n: an element holds n^3 particles");
  o.number("--dem-length L", s.demLength, length, "of the part with particles, m").in("m");
  o.number("--overlap L", s.overlap, length, "of particles and solid, m; at least 0.8").in("m");
  o.number("--fem-length L", s.femLength, length, "of the solid, m; made longer if the pulse would reach its end")
      .in("m")
      .tellAs([&s] { return formatNumber(solidElements(s) * Case{}.elementSize); });
  o.number("--stiffness-ratio R", s.stiffnessRatio, positive(), "E of the solid over that of the particles");
  o.number("--density-ratio R", s.densityRatio, positive(), "density of the solid over that of the particles");
  o.flag("--full-dem", s.fullDem, "particles alone over the whole length");
}

void addSchemeOptions(Options& o, Settings& s) {
  o.group("Parts of the scheme");
  o.choice("--scheme", s.scheme, "conservative|paper",
           "all parts at once, signal and dt factor included; what is given wins");
  o.choice("--constraint", s.constraint, "penalty|multiplier|dashpot", "what holds the two models together");
  o.choice("--gap", s.gap, "at-grains|nodal", "where the two fields are compared");
  o.choice("--weight-profile", s.weightProfile, "half-cosine|linear|smooth",
           "share of the particles across the overlap");
  o.number("--weight-floor W", s.weightFloor, {0.0, 0.5, true, false, "a number from 0 to below 0.5"},
           "least share of either model in the overlap");
  o.choice("--tension", s.tension, "off|on", "contacts that also pull");
  o.choice("--material", s.material, "springs|kirchhoff",
           "of the solid: the lattice's continuum, or St Venant-Kirchhoff");
  o.choice("--mass", s.mass, "lumped|consistent|matched", "of the solid; matched: with the dispersion of the lattice");
  o.choice("--fem", s.fem, "explicit|newmark", "time integration of the solid");
  o.choice("--dashpot-matrix", s.dashpotMatrix, "lumped|consistent",
           "of the dashpot: row sums, or the products of the shape functions");
  o.choice("--rows", s.rows, "per-node|per-element", "of the projection");
  o.choice("--kernel-normalisation", s.normaliseKernels, "off|on", "of kernels cut at a border");
  o.choice("--kernel-reach", s.kernelReach, "overlap|outside", "kernels within the overlap, or also from outside");
  o.choice("--order", s.staggered, "symmetric|staggered", "coupling forces of the same instant, or of the last step");
  o.group("Kernel, penalty, absorber");
  o.number("--cg-width X", s.cgWidth, notNegative("0 (local) or a positive number of element sizes, up to 100", 100.0),
           "kernel width c in element sizes, 0 = local")
      .in("elements");
  o.choice("--kernel", s.kernel, "lucy|gauss", "kernel shape");
  o.number("--penalty P", s.penalty, notNegative("a positive number in Pa/m2, or leave it out (automatic)"),
           "Pa/m2; default: from E and the element size (dashpot: as published)")
      .in("Pa_m2")
      .tellAs([&s] { return s.penalty == 0.0 ? "auto" : formatNumber(s.penalty); });
  o.number("--absorber A", s.absorber, notNegative("0 (none) or a positive rate, about 1"),
           "damps what the mesh cannot carry, wave speed / element size; 0 = none");
}

void addSignalOptions(Options& o, Settings& s) {
  o.group("Signal");
  o.choice("--signal", s.signal, "impulse|cosine", "velocity of the first layer at t = 0, or raised cosine");
  o.number("--pulse-elements L", s.pulseElements, positive("a positive number of elements, up to 1000", 1000.0),
           "length of a cycle in elements");
  o.add("--omega W", "the same as angular frequency, rad/ms",
        [&s](const std::string& text) {
          double perMillisecond = 0.0;
          Options one("", "");
          one.number("--omega", perMillisecond, positive("a positive angular frequency in rad/ms"), "").read(text);
          one.check();
          s.pulseElements = 2.0 * pi * waveSpeed() / (1e3 * perMillisecond * Case{}.elementSize);
        },
        {});
  o.integer("--cycles M", s.cycles, 1, 100, "of the raised cosine");
  o.number("--amplitude A", s.amplitude, positive("a positive factor on the published signal, up to 100", 100.0),
           "over the published signal");
}

Options optionsOf(Settings& s) {
  Options o("wave_propagation",
            "A pulse goes from particles into an elastic solid (Cheng et al., CMAME 403 (2023) 115651, sec. 6.2).");
  addBarOptions(o, s);
  addSchemeOptions(o, s);
  addSignalOptions(o, s);
  o.group("Time");
  benchmark::addTimeOptions(o, s, words);
  benchmark::addOutputOptions(o, s, words);
  o.flag("--no-comparison", s.compare, "no run of particles alone to compare with", false);
  return o;
}

/// Of studies, whose runs differ in what these options say, only what no run could use is refused.
void refuseIdleOptions(const Options& o, const Settings& s) {
  benchmark::refuseIdleRunOptions(o, s);
  if (s.fullDem)
    o.refuseIdle(
        "--stiffness-ratio --density-ratio --constraint --gap --weight-profile --weight-floor --material "
        "--mass --fem --dashpot-matrix --rows --kernel-normalisation --kernel-reach --order --cg-width "
        "--kernel --penalty --absorber --fem-every --no-comparison",
        "with --full-dem, which has no solid", "leave out one of them");
  if (!s.study.empty()) return;
  if (s.signal == Signal::impulse)
    o.refuseIdle("--pulse-elements --omega --cycles", "for the impulse", "add --signal cosine, or leave it out");
  if (s.constraint == Constraint::multiplier)
    o.refuseIdle("--penalty", "with --constraint multiplier", "leave out one of them");
  if (s.constraint != Constraint::dashpot)
    o.refuseIdle("--dashpot-matrix", "without a dashpot", "add --constraint dashpot, or leave it out");
  if (s.cgWidth == 0.0)
    o.refuseIdle("--kernel --kernel-normalisation --kernel-reach", "without a kernel",
                 "add --cg-width X, or leave it out");
}

void checkLengths(const Settings& s) {
  const double h = Case{}.elementSize;
  for (const auto& [option, length] :
       {std::pair{"--dem-length", s.demLength}, {"--fem-length", s.femLength}, {"--overlap", s.overlap}})
    benchmark::require(length >= h * (1.0 - 1e-9) && std::abs(length / h - std::round(length / h)) < 1e-6, option,
                       formatNumber(length), "give a multiple of the element size, 0.4 m, up to 4000 m");
  if (s.overlap < 2.0 * h * (1.0 - 1e-9))
    throw InputError("an overlap of " + formatNumber(s.overlap) +
                         " m is too narrow: its weights would fall from 1 to 0 within one element",
                     "--overlap", "give at least two elements, 0.8 m");
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

bool parseOptions(int argc, char** argv, Settings& s) {
  Options o = optionsOf(s);
  if (!o.parse(argc, argv, [&s] { applyScheme(s, s.scheme); })) return false;
  o.refuseBoth("--dt", "--dt-factor");
  o.refuseBoth("--omega", "--pulse-elements");
  validate(s);
  refuseIdleOptions(o, s);
  return true;
}

void validate(const Settings& settings) {
  Settings s = settings;
  optionsOf(s).check();
  benchmark::checkRun(s);
  checkLengths(s);
  checkSize(s);
  checkCombinations(s);
}

io::KeyValues describe(const Settings& settings) {
  Settings s = settings;
  s.until = endTime(s);
  return optionsOf(s).described();
}

io::KeyValues describeCase(const Case& bar) {
  return {{"side_m", formatNumber(bar.side)},
          {"element_size_m", formatNumber(bar.elementSize)},
          {"youngs_modulus_Pa", formatNumber(bar.youngsModulus)},
          {"poisson_ratio", formatNumber(bar.poissonRatio)},
          {"particle_density_kg_per_m3", formatNumber(bar.particleDensity)},
          {"impulse_velocity_m_per_s", formatNumber(bar.velocity)},
          {"cosine_velocity_m_per_s", formatNumber(bar.cosineVelocity)}};
}

}  // namespace dovetail::wave
