#include "settings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::wave {

namespace {

/// conservative: penalty on the accumulated gap at the particles, explicit, matched mass, bonded contacts. paper:
/// dashpot on the nodal gap, weights 0.1 … 0.9, staggered, implicit, contacts without tension.
void applyScheme(Settings& s) {
  const bool paper = s.scheme == "paper";
  s.constraint = paper ? "dashpot" : "penalty";
  s.gap = paper ? "nodal" : "at-grains";
  s.weightFloor = paper ? 0.1 : 1e-3;
  s.tension = paper ? "off" : "on";
  s.mass = paper ? "consistent" : "matched";
  s.fem = paper ? "newmark" : "explicit";
  s.rows = paper ? "per-element" : "per-node";
  s.normalised = paper ? "off" : "on";
  s.kernelReach = paper ? "outside" : "overlap";
  s.material = paper ? "kirchhoff" : "springs";
  s.order = paper ? "staggered" : "symmetric";
  s.dtFactor = paper ? 0.01 : 0.02;
  s.signal = paper ? "impulse" : "cosine";
}

const benchmark::RunWords words{"0.5", "", "until the pulse has left the overlap", "wave_*P_c*dX.csv",
                                "widths|pareto|stability|constraints"};
using program::Options, program::positive, program::notNegative;

void addBarOptions(Options& o, Settings& s) {
  const program::Range length{0.0, 4000.0, false, true, "a multiple of the element size, 0.4 m, up to 4000 m"};
  o.group("Bar");
  o.integer("--particles-per-edge N", s.particlesPerEdge, 1, 8, "n: an element holds n^3 particles");
  o.number("--dem-length L", s.demLength, length, "length of the part with particles, m").in("m");
  o.number("--overlap L", s.overlap, length, "of particles and solid, m; at least 0.8").in("m");
  o.number("--fem-length L", s.femLength, length, "of the solid, m; made longer if the pulse would reach its end")
      .in("m")
      .reportAs([&s] { return formatNumber(solidElements(s) * Case{}.elementSize); });
  o.number("--stiffness-ratio R", s.stiffnessRatio, positive(), "E of the solid over that of the particles");
  o.number("--density-ratio R", s.densityRatio, positive(), "density of the solid over that of the particles");
  o.flag("--full-dem", s.fullDem, "particles alone over the whole length");
}

void addSchemeOptions(Options& o, Settings& s) {
  o.group("Parts of the scheme");
  o.word("--scheme", s.scheme, "conservative|paper",
         "sets all parts, signal and dt factor included; options given take precedence");
  o.word("--constraint", s.constraint, "penalty|multiplier|dashpot", "how the gap between the two models is held");
  o.word("--gap", s.gap, "at-grains|nodal", "where the two fields are compared");
  o.word("--weight-profile", s.weightProfile, "half-cosine|linear|smooth",
         "weight of the particles across the overlap");
  o.number("--weight-floor W", s.weightFloor, {0.0, 0.5, true, false, "a number from 0 to below 0.5"},
           "least weight of either model in the overlap");
  o.word("--tension", s.tension, "off|on", "contacts with tension");
  o.word("--material", s.material, "springs|kirchhoff",
         "of the solid: the lattice's continuum, or St Venant-Kirchhoff");
  o.word("--mass", s.mass, "lumped|consistent|matched", "of the solid; matched: with the dispersion of the lattice");
  o.word("--fem", s.fem, "explicit|newmark", "time integration of the solid");
  o.word("--dashpot-matrix", s.dashpotMatrix, "lumped|consistent",
         "of the dashpot: row sums, or the products of the shape functions");
  o.word("--rows", s.rows, "per-node|per-element", "of the projection");
  o.word("--kernel-normalisation", s.normalised, "off|on", "of kernels cut at a border");
  o.word("--kernel-reach", s.kernelReach, "overlap|outside",
         "kernels over grains of the overlap, or also over those outside");
  o.word("--order", s.order, "symmetric|staggered", "coupling forces of the same instant, or of the last step");
  o.group("Kernel, penalty, absorber");
  o.number("--cg-width X", s.cgWidth, notNegative("0 (local) or a positive number of element sizes, up to 100", 100.0),
           "kernel width c in element sizes, 0 = local")
      .in("elements");
  o.word("--kernel", s.kernel, "lucy|gauss", "kernel shape");
  o.number("--penalty P", s.penalty, notNegative("a positive number in Pa/m2, or leave it out (automatic)"),
           "Pa/m2; default: from E and the element size (dashpot: as published)")
      .in("Pa_m2")
      .reportAs([&s] { return s.penalty == 0.0 ? "auto" : formatNumber(s.penalty); });
  o.number("--absorber A", s.absorber, notNegative("0 (none) or a positive rate, about 1"),
           "damping rate of motions that the mesh cannot represent, wave speed / element size; 0 = none");
}

void addSignalOptions(Options& o, Settings& s) {
  o.group("Signal");
  o.word("--signal", s.signal, "impulse|cosine", "velocity of the first layer at t = 0, or raised cosine");
  o.number("--pulse-elements L", s.pulseElements, positive("a positive number of elements, up to 1000", 1000.0),
           "length of a cycle in elements");
  o.add("--omega W", "the same, as an angular frequency, rad/ms",
        [&s](const std::string& text) {
          const auto perMillisecond = program::numberFrom<double>(text, "--omega");
          program::requireIn(positive("a positive angular frequency in rad/ms"), perMillisecond, "--omega");
          s.pulseElements = 2.0 * std::numbers::pi * waveSpeed() / (1e3 * perMillisecond * Case{}.elementSize);
        },
        {});
  o.integer("--cycles M", s.cycles, 1, 100, "of the raised cosine");
  o.number("--amplitude A", s.amplitude, positive("a positive factor on the published signal, up to 100", 100.0),
           "factor on the published signal");
}

Options optionsOf(Settings& s) {
  Options o("wave_propagation",
            "A pulse goes from particles into an elastic solid (Cheng et al., CMAME 403 (2023) 115651, sec. 6.2).");
  addBarOptions(o, s);
  addSchemeOptions(o, s);
  addSignalOptions(o, s);
  o.group("Time");
  benchmark::addTimeOptions(o, s, words);
  o.flag("--until-past", s.untilPast, "ends when the pulse has left the overlap, for every scheme").key = "";
  benchmark::addOutputOptions(o, s, words);
  o.flag("--no-comparison", s.compare, "skips the run of particles alone for comparison", false);
  return o;
}

/// Of studies, whose runs differ in what these options say, only what no run could use is refused.
void refuseIdleOptions(const Options& o, const Settings& s) {
  if (s.fullDem)
    o.refuseIdle(
        "--stiffness-ratio --density-ratio --constraint --gap --weight-profile --weight-floor --material "
        "--mass --fem --dashpot-matrix --rows --kernel-normalisation --kernel-reach --order --cg-width "
        "--kernel --penalty --absorber --fem-every --no-comparison",
        "with --full-dem, which has no solid", "leave out one of them");
  if (!s.study.empty()) return;
  if (s.impulse())
    o.refuseIdle("--pulse-elements --omega --cycles", "for the impulse", "add --signal cosine, or leave it out");
  if (s.constraint == "multiplier") o.refuseIdle("--penalty", "with --constraint multiplier", "leave out one of them");
  if (s.constraint != "dashpot")
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
  const bool staggered = s.order == "staggered";
  if (staggered && (!s.implicit() || s.constraint != "dashpot"))
    throw InputError("staggered steps need the dashpot and an implicit solid", "--order staggered",
                     "add --constraint dashpot --fem newmark, or take --order symmetric");
  if (s.kernelReach == "outside" && s.gap == "at-grains")
    throw InputError("particles outside of the mesh have no solid to be compared with", "--kernel-reach outside",
                     "take --gap nodal, or --kernel-reach overlap");
  if (staggered && s.femEvery != 1)
    throw InputError("staggered steps need one step of the particles per step of the solid", "--fem-every", "take 1");
  if (s.absorber > 0.0 && s.implicit())
    throw InputError("the absorber needs explicit steps of the solid", "--absorber", "take --fem explicit");
}

}  // namespace

bool parseOptions(int argc, char** argv, Settings& s) {
  Options o = optionsOf(s);
  if (!o.parse(argc, argv, [&s] { applyScheme(s); })) return false;
  o.refuseBoth("--omega", "--pulse-elements");
  benchmark::checkRun(o, s);
  checkLengths(s);
  checkSize(s);
  checkCombinations(s);
  refuseIdleOptions(o, s);
  return true;
}

io::KeyValues describe(const Settings& settings) {
  Settings s = settings;
  s.until = endTime(s);
  return optionsOf(s).described();
}

}  // namespace dovetail::wave
