#include "options.hpp"

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "common/command_line.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::wave {

namespace {

using benchmark::addChoice;
using CLI::App;

/// What of the scheme's parts was written on the command line: it wins over --scheme.
using WrittenParts = std::vector<std::function<void(Settings&)>>;

template <class Value>
void addPart(App& app, WrittenParts& written, const std::string& name, Value Settings::*part,
             const std::map<std::string, Value>& names, const std::string& help) {
  addChoice<Value>(
      app, name, names, [&written, part](Value value) { written.push_back([=](Settings& s) { s.*part = value; }); },
      help);
}

CLI::Option* addPart(App& app, WrittenParts& written, const std::string& name, double Settings::*part,
                     const std::string& help, const std::string& letter) {
  return app
      .add_option_function<double>(
          name, [&written, part](double value) { written.push_back([=](Settings& s) { s.*part = value; }); }, help)
      ->option_text(letter);
}

const std::map<std::string, bool> onOrOff{{"on", true}, {"off", false}};

void addBarOptions(App& app, Settings& s) {
  app.option_defaults()->group("Bar");
  app.add_option("--particles-per-edge", s.particlesPerEdge, "n: an element holds n^3 particles; 1 to 8")
      ->option_text("N");
  app.add_option("--dem-length", s.demLength, "of the part with particles, m")->option_text("L");
  app.add_option("--overlap", s.overlap, "of particles and solid, m; at least 0.8")->option_text("L");
  app.add_option("--fem-length", s.femLength, "of the solid, m; made longer if the pulse would reach its end")
      ->option_text("L");
  app.add_option("--stiffness-ratio", s.stiffnessRatio, "E of the solid over that of the particles")->option_text("R");
  app.add_option("--density-ratio", s.densityRatio, "density of the solid over that of the particles")
      ->option_text("R");
  app.add_flag("--full-dem", s.fullDem, "particles alone over the whole length");
}

void addSchemeOptions(App& app, WrittenParts& w, Settings& s) {
  app.option_defaults()->group("Parts of the scheme");
  addChoice<Scheme>(app, "--scheme", s.scheme, {{"conservative", Scheme::conservative}, {"paper", Scheme::paper}},
                    "all parts at once, signal and dt factor included; what is given wins");
  addPart<Constraint>(
      app, w, "--constraint", &Settings::constraint,
      {{"penalty", Constraint::penalty}, {"multiplier", Constraint::multiplier}, {"dashpot", Constraint::dashpot}},
      "what holds the two models together");
  addPart<Gap>(app, w, "--gap", &Settings::gap, {{"at-grains", Gap::atParticles}, {"nodal", Gap::nodal}},
               "where the two fields are compared");
  addPart<WeightProfile>(app, w, "--weight-profile", &Settings::weightProfile,
                         {{"half-cosine", WeightProfile::halfCosine},
                          {"linear", WeightProfile::linear},
                          {"smooth", WeightProfile::smooth}},
                         "share of the particles across the overlap");
  addPart(app, w, "--weight-floor", &Settings::weightFloor, "least share of either model in the overlap", "W");
  addPart<bool>(app, w, "--tension", &Settings::tension, onOrOff, "contacts that also pull");
  addPart<Material>(app, w, "--material", &Settings::material,
                    {{"springs", Material::springs}, {"kirchhoff", Material::kirchhoff}},
                    "of the solid: the lattice's continuum, or St Venant-Kirchhoff");
  addPart<Mass>(app, w, "--mass", &Settings::mass,
                {{"lumped", Mass::lumped}, {"consistent", Mass::consistent}, {"matched", Mass::matched}},
                "of the solid; matched: with the dispersion of the lattice");
  addPart<FemStepper>(app, w, "--fem", &Settings::fem,
                      {{"explicit", FemStepper::explicitDifferences}, {"newmark", FemStepper::newmark}},
                      "time integration of the solid");
  addPart<DashpotMatrix>(app, w, "--dashpot-matrix", &Settings::dashpotMatrix,
                         {{"lumped", DashpotMatrix::lumped}, {"consistent", DashpotMatrix::consistent}},
                         "of the dashpot: row sums, or the products of the shape functions");
  addPart<Rows>(app, w, "--rows", &Settings::rows, {{"per-node", Rows::perNode}, {"per-element", Rows::perElement}},
                "of the projection");
  addPart<bool>(app, w, "--kernel-normalisation", &Settings::normaliseKernels, onOrOff, "of kernels cut at a border");
  addPart<KernelReach>(app, w, "--kernel-reach", &Settings::kernelReach,
                       {{"overlap", KernelReach::overlap}, {"outside", KernelReach::outside}},
                       "kernels within the overlap, or also from outside");
  addPart<bool>(app, w, "--order", &Settings::staggered, {{"symmetric", false}, {"staggered", true}},
                "coupling forces of the same instant, or of the last step");
}

void addCouplingOptions(App& app, Settings& s) {
  app.option_defaults()->group("Kernel, penalty, absorber");
  app.add_option("--cg-width", s.cgWidth, "kernel width c in element sizes, 0 = local")->option_text("X");
  addChoice<Kernel>(app, "--kernel", s.kernel, {{"lucy", Kernel::lucy}, {"gauss", Kernel::gauss}}, "kernel shape");
  app.add_option("--penalty", s.penalty, "Pa/m2; default: from E and the element size (dashpot: as published)")
      ->option_text("P");
  app.add_option("--absorber", s.absorber, "damps what the mesh cannot carry, wave speed / element size; 0 = none")
      ->option_text("A");
}

void addSignalOptions(App& app, WrittenParts& w, Settings& s) {
  app.option_defaults()->group("Signal");
  addPart<Signal>(app, w, "--signal", &Settings::signal, {{"impulse", Signal::impulse}, {"cosine", Signal::cosine}},
                  "velocity of the first layer at t = 0, or raised cosine");
  auto* length = app.add_option("--pulse-elements", s.pulseElements, "length of a cycle in elements")->option_text("L");
  app.add_option_function<double>(
         "--omega",
         [&s](double perMillisecond) {
           if (!std::isfinite(perMillisecond) || perMillisecond <= 0.0)
             throw InputError("the value " + formatNumber(perMillisecond) + " is not possible", "--omega",
                              "give a positive angular frequency in rad/ms");
           s.pulseElements = 2.0 * std::numbers::pi * waveSpeed() / (1e3 * perMillisecond * Case{}.elementSize);
         },
         "the same as angular frequency, rad/ms")
      ->option_text("W")
      ->excludes(length);
  app.add_option("--cycles", s.cycles, "of the raised cosine")->option_text("M");
  app.add_option("--amplitude", s.amplitude, "over the published signal")->option_text("A");
}

void addTimeOptions(App& app, WrittenParts& w, Settings& s, std::string& dt) {
  app.option_defaults()->group("Time");
  auto* factor = addPart(app, w, "--dt-factor", &Settings::dtFactor, "time step over the contact time", "F");
  app.add_option("--dt", dt, "auto: 0.5 of the critical step")
      ->check(CLI::IsMember({"auto"}).description(""))
      ->option_text("auto")
      ->excludes(factor);
  app.add_option("--fem-every", s.femEvery, "DEM steps per FEM step")->option_text("K");
  app.add_option_function<double>(
         "--until", [&s](double t) { s.until = t; }, "end, s; default: until the pulse has left the overlap")
      ->option_text("T");
  app.add_option("--threads", s.threads, "results do not depend on it")->option_text("N");
}

void addOutputOptions(App& app, Settings& s) {
  app.option_defaults()->group("Output, studies");
  app.add_option("--out", s.out, "folder for VTU, PVD, CSV and HDF5 files")->option_text("DIR");
  app.add_option("--output-interval", s.outputInterval, "time between frames and velocity profiles, s")
      ->option_text("T");
  app.add_option("--summary", s.summary, "JSON file of all figures")->option_text("FILE");
  app.add_flag_callback(
      "--no-comparison", [&s] { s.compare = false; }, "no run of particles alone to compare with");
  addChoice<Study>(app, "--study", s.study,
                   {{"widths", Study::widths},
                    {"pareto", Study::pareto},
                    {"stability", Study::stability},
                    {"constraints", Study::constraints}},
                   "a set of runs; tables go to --out");
  app.add_option("--reference", s.reference, "folder with the published curves (wave_*P_c*dX.csv)")->option_text("DIR");
  app.add_flag("--profile", s.profile, "time per stage");
  app.add_flag("--quiet", s.quiet, "print nothing but errors");
}

void refuseIdleOutputOptions(const App& app, const Settings& s) {
  using benchmark::refuseIdle;
  if (s.study != Study::none)
    refuseIdle(app, {"--output-interval", "--profile"}, "with --study, which writes no pictures", "leave it out");
  if (s.out.empty()) refuseIdle(app, {"--output-interval"}, "without --out", "add --out DIR, or leave it out");
  if (s.quiet) refuseIdle(app, {"--reference"}, "with --quiet", "leave out one of them");
  if (s.quiet && s.summary.empty())
    refuseIdle(app, {"--profile"}, "with --quiet and no summary", "add --summary FILE, or leave out one of them");
}

/// Of studies, whose runs differ in what these options say, only what no run could use is refused.
void refuseIdleOptions(const App& app, const Settings& s) {
  using benchmark::refuseIdle;
  refuseIdleOutputOptions(app, s);
  if (s.fullDem)
    refuseIdle(app,
               {"--stiffness-ratio",
                "--density-ratio",
                "--constraint",
                "--gap",
                "--weight-profile",
                "--weight-floor",
                "--material",
                "--mass",
                "--fem",
                "--dashpot-matrix",
                "--rows",
                "--kernel-normalisation",
                "--kernel-reach",
                "--order",
                "--cg-width",
                "--kernel",
                "--penalty",
                "--absorber",
                "--fem-every",
                "--no-comparison"},
               "with --full-dem, which has no solid", "leave out one of them");
  if (s.signal == Signal::impulse && s.study == Study::none)
    refuseIdle(app, {"--pulse-elements", "--omega", "--cycles"}, "for the impulse",
               "add --signal cosine, or leave it out");
  if (s.study != Study::none) return;
  if (s.constraint == Constraint::multiplier)
    refuseIdle(app, {"--penalty"}, "with --constraint multiplier", "leave out one of them");
  if (s.constraint != Constraint::dashpot)
    refuseIdle(app, {"--dashpot-matrix"}, "without a dashpot", "add --constraint dashpot, or leave it out");
  if (s.cgWidth == 0.0)
    refuseIdle(app, {"--kernel", "--kernel-normalisation", "--kernel-reach"}, "without a kernel",
               "add --cg-width X, or leave it out");
}

}  // namespace

bool parseOptions(int argc, char** argv, Settings& settings) {
  App app{"A pulse goes from particles into an elastic solid (Cheng et al., CMAME 403 (2023) 115651, sec. 6.2).",
          "wave_propagation"};
  app.get_formatter()->column_width(42);
  WrittenParts written;
  std::string dt;
  addBarOptions(app, settings);
  addSchemeOptions(app, written, settings);
  addCouplingOptions(app, settings);
  addSignalOptions(app, written, settings);
  addTimeOptions(app, written, settings, dt);
  addOutputOptions(app, settings);
  if (!benchmark::parseCommandLine(app, argc, argv)) return false;
  applyScheme(settings, settings.scheme);
  for (const auto& write : written) write(settings);
  settings.dtAuto = dt == "auto";
  validate(settings);
  refuseIdleOptions(app, settings);
  return true;
}

}  // namespace dovetail::wave
