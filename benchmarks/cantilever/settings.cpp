#include "settings.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cantilever {

double particleMass() { return Case{}.particleDensity * std::numbers::pi / 6.0 * std::pow(Case{}.particleDiameter, 3); }

double contactTime() {
  const double stiffness = Case{}.youngsModulus * Case{}.particleDiameter;
  return std::numbers::pi * std::sqrt(0.5 * particleMass() / stiffness);
}

namespace {

const benchmark::RunWords words{"0.9", ", 4.5465 ms; default 0.05 or a third of the critical step", "leaving",
                                "cantilever_c*d.csv", "widths|pareto|stability|ablation"};

/// Sets the scheme's parts for the settings' kernel width. Lag and consistent mass go with width 0 only: see the README
/// for what is known of the authors' runs.
void applyScheme(Settings& s) {
  const bool paper = s.scheme == "paper", paperAtAPoint = paper && s.cgWidth == 0.0;
  const bool plain = paper || s.cgWidth == 0.0;
  s.lag = paperAtAPoint ? "load" : "none";
  s.mass = paperAtAPoint ? "consistent" : "lumped";
  s.transfer = paper ? "spread" : "adjoint";
  s.edges = paper ? "paper" : "projected";
  s.metric = paper ? "deformed" : "reference";
  s.fem = paper ? "newmark" : "explicit";
  s.restitution = paper ? 0.99 : 1.0;
  s.correction = plain ? "none" : "symmetric";
  s.surface = plain ? "flat" : "smooth";
}

std::string meshText(const Settings& s) {
  return std::to_string(s.mesh[0]) + "," + std::to_string(s.mesh[1]) + "," + std::to_string(s.mesh[2]);
}

void readMesh(Settings& s, const std::string& text) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d,%d,%d%c", &s.mesh[0], &s.mesh[1], &s.mesh[2], &rest) != 3)
    throw InputError("'" + text + "' is not a list of three counts", "--mesh",
                     "give three whole numbers, as in 2,30,2");
}

void addPartOptions(program::Options& o, Settings& s) {
  o.word("--lag", s.lag, "none|load|load-and-skin", "staggered steps: the load, or load and skin, one step old");
  o.word("--transfer", s.transfer, "adjoint|spread",
         "the same weights for gap and load, or only the load spread over the kernel (Eqs. 14-15)");
  o.word("--edges", s.edges, "projected|paper", "rule where a particle touches several facets");
  o.word("--metric", s.metric, "reference|deformed", "St Venant-Kirchhoff, or the authors' Eq. (34)");
  o.word("--fem", s.fem, "explicit|newmark", "time integration of the beam");
  o.word("--mass", s.mass, "lumped|consistent", "of the beam; consistent with --fem newmark --lag load only");
  o.number("--restitution E", s.restitution, {0.0, 1.0, false, true, "a number above 0 and up to 1"},
           "of a particle on a rigid wall, 0 < e <= 1");
  o.word("--kernel-correction", s.correction, "none|linear|symmetric",
         "for the adjoint transfer: linear keeps first moments, symmetric keeps uniform loads uniform (default)");
  o.word("--surface", s.surface, "flat|smooth",
         "flat facets (default for width 0) or B-spline patches (default for a kernel)");
}

program::Options optionsOf(Settings& s) {
  program::Options o(
      "cantilever",
      "Two particles slide over an elastic cantilever (Cheng et al., CMAME 403 (2023) 115651, sec. 6.1).");
  o.word("--scheme", s.scheme, "conservative|paper", "sets all parts; options given below take precedence");
  o.number("--cg-width X", s.cgWidth, program::notNegative("0 (local) or a positive number of particle diameters"),
           "kernel width c in particle diameters, 0 = local")
      .in("diameters");
  o.word("--kernel", s.kernel, "lucy|gauss", "kernel shape");
  o.word("--element", s.element, "hex8|hybrid8", "hex8 (as the paper) or hybrid8 (locking-free)");
  o.integer("--refine N", s.refine, 1, 16, "divides every element edge by N");
  o.add(
      "--mesh NX,NY,NZ", "elements along x, y (axis), z; default 2,30,2",
      [&s](const std::string& text) { readMesh(s, text); }, [&s] { return meshText(s); });
  o.number("--stiffness-ratio R", s.stiffnessRatio, program::positive(), "contact stiffness over E d");
  addPartOptions(o, s);
  benchmark::addTimeOptions(o, s, words);
  o.add("", "", {}, [&s] { return std::string(s.dtCapped ? "yes" : "no"); }).key = "dt_capped";
  benchmark::addOutputOptions(o, s, words);
  return o;
}

/// What follows from parts that were written, where nothing else was.
void settleParts(const program::Options& o, Settings& s) {
  const bool spread = s.transfer == "spread";
  if (!o.given("--kernel-correction") && spread) s.correction = "none";
  if (!o.given("--surface") && (spread || s.edges == "paper")) s.surface = "flat";
  if (!o.given("--mass") && !(s.lag != "none" && s.implicit())) s.mass = "lumped";
  s.dtCapped = !o.given("--dt-factor") && !s.dtAuto && !s.fractionOfCritical && s.femEvery == 1;
}

void checkMesh(const Settings& s) {
  for (const int count : s.mesh)
    benchmark::require(count >= 1 && count <= 2000, "--mesh", std::to_string(count),
                       "give three counts of at least 1, as in 2,30,2");
  const double elements = 1.0 * s.mesh[0] * s.mesh[1] * s.mesh[2] * std::pow(s.refine, 3);
  if (elements > 4e6)
    throw InputError(formatNumber(elements) + " elements are too many", "--mesh and --refine",
                     "give fewer, at most 4 million together");
}

/// What the scene would refuse too, under the names of the options.
void checkParts(const Settings& s) {
  const auto refuseIf = [](bool bad, const char* what, const std::string& option, const char* remedy) {
    if (bad) throw InputError(what, option, remedy);
  };
  refuseIf(s.metric == "deformed" && s.element != "hex8", "this element has no deformed metric", "--metric deformed",
           "take --element hex8, or --metric reference");
  refuseIf(s.mass == "consistent" && !(s.lag != "none" && s.implicit()),
           "a consistent mass needs implicit steps with a lagged load", "--mass consistent",
           "add --fem newmark --lag load, or take --mass lumped");
  refuseIf(s.surface == "smooth" && s.transfer == "spread",
           "the smooth surface distributes its loads by its own weights", "--surface smooth",
           "take --transfer adjoint, or --surface flat");
  refuseIf(s.surface == "smooth" && s.edges == "paper", "the smooth surface has no facet edges", "--surface smooth",
           "take --edges projected, or --surface flat");
  refuseIf(s.transfer == "spread" && s.correction != "none", "kernel corrections need the adjoint transfer",
           "--kernel-correction " + s.correction, "take --transfer adjoint, or --kernel-correction none");
}

}  // namespace

bool parseOptions(int argc, char** argv, Settings& s) {
  program::Options o = optionsOf(s);
  if (!o.parse(argc, argv, [&s] { applyScheme(s); })) return false;
  settleParts(o, s);
  benchmark::checkRun(o, s);
  checkMesh(s);
  checkParts(s);
  if (s.cgWidth == 0.0 && s.study.empty())
    o.refuseIdle("--kernel --kernel-correction", "without a kernel", "add --cg-width X, or leave it out");
  return true;
}

std::vector<std::string> changesOfScene(const Settings& s) {
  const Case beam;
  const double sunk = particleMass() * beam.gravity / s.contactStiffness();
  const std::string solid = "solids.0.", coupling = "couplings.0.";
  return benchmark::changesOf(
      {{"stiffness", s.contactStiffness()},
       {"height", 0.5 * beam.side + 0.5 * beam.particleDiameter - sunk},
       {"contact.restitution", s.restitution},
       {"contact.tension", true},
       {solid + "cells", s.elements()},
       {solid + "formulation", s.element == "hybrid8" ? "assumed-stress" : "standard"},
       {solid + "material.law", s.metric == "deformed" ? "deformed-metric" : "St-Venant-Kirchhoff"},
       {solid + "stepping", s.implicit() ? "implicit" : "explicit"},
       {solid + "consistent_mass", s.mass == "consistent" ? 1 : 0},
       {coupling + "kernel", s.cgWidth == 0.0 ? report::Json("none") : report::Json(s.cgWidth * beam.particleDiameter)},
       {coupling + "kernel_shape", s.kernel},
       {coupling + "kernel_correction", s.correction},
       {coupling + "transfer", s.transfer},
       {coupling + "surface", s.surface},
       {coupling + "edges", s.edges == "paper" ? "deepest" : "projected"},
       {"stages.0.time", s.until.value_or(longestRun)},
       {"steps.lag", s.lag},
       {"steps.per_macro_step", s.femEvery},
       {"steps.threads", s.threads}});
}

io::KeyValues describe(const Settings& settings) {
  Settings s = settings;
  return optionsOf(s).described();
}

}  // namespace dovetail::cantilever
