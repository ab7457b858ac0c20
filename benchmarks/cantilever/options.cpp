#include "options.hpp"

#include "common/command_line.hpp"

namespace dovetail::cantilever {

namespace {

using benchmark::addChoice;

/// What of the scheme's parts was written on the command line and so wins over --scheme.
struct WrittenParts {
  Lag lag{};
  Transfer transfer{};
  EdgeHandling edges{};
  Metric metric{};
  FemStepper fem{};
  MassMatrix mass{};
  Correction correction{};
  Surface surface{};
  double restitution{};
  CLI::Option *lagOption, *transferOption, *edgesOption, *metricOption, *femOption, *massOption, *correctionOption,
      *surfaceOption, *restitutionOption;
};

void addPartOptions(CLI::App& app, WrittenParts& w) {
  w.lagOption = addChoice<Lag>(app, "--lag", w.lag,
                               {{"none", Lag::none}, {"load", Lag::load}, {"load-and-skin", Lag::loadAndSkin}},
                               "staggered steps: the load, or load and skin, one step old");
  w.transferOption =
      addChoice<Transfer>(app, "--transfer", w.transfer, {{"adjoint", Transfer::adjoint}, {"spread", Transfer::spread}},
                          "gap and load by the same weights, or the load alone spread over the kernel (14-15)");
  w.edgesOption = addChoice<EdgeHandling>(app, "--edges", w.edges,
                                          {{"projected", EdgeHandling::projected}, {"paper", EdgeHandling::paper}},
                                          "rule where a particle touches several facets");
  w.metricOption =
      addChoice<Metric>(app, "--metric", w.metric, {{"reference", Metric::reference}, {"deformed", Metric::deformed}},
                        "St Venant-Kirchhoff, or the authors' Eq. (34)");
  w.femOption = addChoice<FemStepper>(app, "--fem", w.fem,
                                      {{"explicit", FemStepper::explicitDifferences}, {"newmark", FemStepper::newmark}},
                                      "time integration of the beam");
  w.massOption = addChoice<MassMatrix>(app, "--mass", w.mass,
                                       {{"lumped", MassMatrix::lumped}, {"consistent", MassMatrix::consistent}},
                                       "of the beam; consistent with --fem newmark --lag load only");
  w.correctionOption = addChoice<Correction>(
      app, "--kernel-correction", w.correction,
      {{"none", Correction::none}, {"linear", Correction::linear}, {"symmetric", Correction::symmetric}},
      "for the adjoint transfer: linear keeps moments, symmetric keeps even loads even (default)");
  w.surfaceOption =
      addChoice<Surface>(app, "--surface", w.surface, {{"flat", Surface::flat}, {"smooth", Surface::smooth}},
                         "flat facets (default for width 0) or B-spline patches (default for a kernel)");
  w.restitutionOption =
      app.add_option("--restitution", w.restitution, "of a particle on a rigid wall, 0 < e <= 1")->option_text("E");
}

void mergeParts(const WrittenParts& w, Settings& s) {
  applyScheme(s, s.scheme);
  if (w.lagOption->count() > 0) s.lag = w.lag;
  if (w.transferOption->count() > 0) s.transfer = w.transfer;
  if (w.edgesOption->count() > 0) s.edges = w.edges;
  if (w.metricOption->count() > 0) s.metric = w.metric;
  if (w.femOption->count() > 0) s.fem = w.fem;
  if (w.correctionOption->count() > 0)
    s.correction = w.correction;
  else if (s.transfer == Transfer::spread)
    s.correction = Correction::none;
  if (w.surfaceOption->count() > 0)
    s.surface = w.surface;
  else if (s.transfer == Transfer::spread || s.edges == EdgeHandling::paper)
    s.surface = Surface::flat;
  if (w.massOption->count() > 0)
    s.mass = w.mass;
  else if (!(s.lag != Lag::none && s.fem == FemStepper::newmark))
    s.mass = MassMatrix::lumped;
  if (w.restitutionOption->count() > 0) s.restitution = w.restitution;
}

void addModelOptions(CLI::App& app, Settings& s) {
  addChoice<Scheme>(app, "--scheme", s.scheme, {{"conservative", Scheme::conservative}, {"paper", Scheme::paper}},
                    "all parts at once; parts given below win");
  app.add_option("--cg-width", s.cgWidth, "kernel width c in particle diameters, 0 = local")->option_text("X");
  addChoice<KernelName>(app, "--kernel", s.kernel, {{"lucy", KernelName::lucy}, {"gauss", KernelName::gauss}},
                        "kernel shape");
  app.add_option("--element", s.element, "hex8 (as the paper) or hybrid8 (locking-free)")
      ->check(CLI::IsMember({"hex8", "hybrid8"}).description(""))
      ->option_text("hex8|hybrid8");
  app.add_option("--refine", s.refine, "divides every element edge by N")->option_text("N");
  app.add_option_function<std::vector<int>>(
         "--mesh",
         [&s](const std::vector<int>& n) {
           s.mesh = {n[0], n[1], n[2]};
         },
         "elements along x, y (axis), z; default 2,30,2")
      ->delimiter(',')
      ->expected(3)
      ->option_text("NX,NY,NZ");
  app.add_option("--stiffness-ratio", s.stiffnessRatio, "contact stiffness over E d")->option_text("R");
}

void addRunOptions(CLI::App& app, Settings& s, std::string& dt) {
  auto* factor = app.add_option_function<double>(
                        "--dt-factor",
                        [&s](double f) {
                          s.dtFactor = f;
                          s.dtCapped = false;
                        },
                        "time step over the contact time, 4.5465 ms; default 0.05 or a third of the critical step")
                     ->option_text("F");
  app.add_option("--dt", dt, "auto: 0.9 of the critical step")
      ->check(CLI::IsMember({"auto"}).description(""))
      ->option_text("auto")
      ->excludes(factor);
  app.add_option("--fem-every", s.femEvery, "DEM steps per FEM step")->option_text("K");
  app.add_option_function<double>(
         "--until", [&s](double t) { s.until = t; }, "end, s; default: until particle 1 has left")
      ->option_text("T");
  app.add_option("--threads", s.threads, "results do not depend on it")->option_text("N");
  app.add_option("--out", s.out, "folder for VTU, PVD, CSV and HDF5 files")->option_text("DIR");
  app.add_option("--output-interval", s.outputInterval, "time between VTU frames, s")->option_text("T");
  app.add_option("--summary", s.summary, "JSON file of the figures below")->option_text("FILE");
  addChoice<Study>(app, "--study", s.study,
                   {{"widths", Study::widths},
                    {"pareto", Study::pareto},
                    {"stability", Study::stability},
                    {"ablation", Study::ablation}},
                   "a set of runs; tables go to --out");
  app.add_option("--reference", s.reference, "folder with the published curves (cantilever_c*d.csv)")
      ->option_text("DIR");
  app.add_flag("--profile", s.profile, "time per stage");
  app.add_flag("--quiet", s.quiet, "print nothing but errors");
}

void refuseIdleOptions(const CLI::App& app, const Settings& s) {
  using benchmark::refuseIdle;
  if (s.study != Study::none)
    refuseIdle(app, {"--output-interval", "--profile"}, "with --study, which writes no pictures", "leave it out");
  if (s.out.empty()) refuseIdle(app, {"--output-interval"}, "without --out", "add --out DIR, or leave it out");
  if (s.cgWidth == 0.0 && s.study == Study::none)
    refuseIdle(app, {"--kernel", "--kernel-correction"}, "without a kernel", "add --cg-width X, or leave it out");
  if (s.quiet) refuseIdle(app, {"--reference"}, "with --quiet", "leave out one of them");
  if (s.quiet && s.summary.empty())
    refuseIdle(app, {"--profile"}, "with --quiet and no summary", "add --summary FILE, or leave out one of them");
}

}  // namespace

bool parseOptions(int argc, char** argv, Settings& settings) {
  CLI::App app{"Two particles slide over an elastic cantilever (Cheng et al., CMAME 403 (2023) 115651, sec. 6.1).",
               "cantilever"};
  app.get_formatter()->column_width(42);
  std::string dt;
  settings.dtCapped = true;
  WrittenParts written{};
  addModelOptions(app, settings);
  addPartOptions(app, written);
  addRunOptions(app, settings, dt);
  if (!benchmark::parseCommandLine(app, argc, argv)) return false;
  settings.dtAuto = dt == "auto";
  settings.dtCapped = settings.dtCapped && !settings.dtAuto && settings.femEvery == 1;
  mergeParts(written, settings);
  validate(settings);
  refuseIdleOptions(app, settings);
  return true;
}

}  // namespace dovetail::cantilever
