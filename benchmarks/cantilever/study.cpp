#include "dovetail/core/finite.hpp"
#include "run.hpp"

namespace dovetail::cantilever {

namespace {

using Plan = benchmark::Plan<Settings>;

void setFactor(Settings& settings, double factor) {
  settings.dtFactor = factor;
  settings.dtCapped = false;
}

Settings withWidth(Settings settings, double width, Scheme scheme) {
  settings.cgWidth = width;
  applyScheme(settings, scheme);
  return settings;
}

/// Coarse-graining widths 0 … 20 d in both schemes.
Plan widthsPlan(const Settings& base) {
  struct Variant {
    const char* name;
    Scheme scheme;
    Correction correction;
  };
  Plan plan;
  for (const Variant& variant : {Variant{"conservative", Scheme::conservative, Correction::symmetric},
                                 Variant{"conservative, linear", Scheme::conservative, Correction::linear},
                                 Variant{"conservative, no correction", Scheme::conservative, Correction::none},
                                 Variant{"paper", Scheme::paper, Correction::none}})
    for (const double width : {0.0, 2.0, 4.0, 6.0, 10.0, 15.0, 20.0}) {
      Settings settings = withWidth(base, width, variant.scheme);
      settings.correction = variant.correction;
      if (variant.scheme == Scheme::paper) setFactor(settings, 0.02);
      plan.emplace_back(std::string(variant.name) + ", c = " + formatNumber(width) + " d", settings);
    }
  return plan;
}

/// Elements × meshes × time steps × FEM sub-steps.
Plan paretoPlan(const Settings& base) {
  using Mesh = std::pair<const char*, std::array<int, 3>>;
  Plan plan;
  Settings settings = withWidth(base, base.cgWidth, Scheme::conservative);
  for (const char* element : {"hex8", "hybrid8"})
    for (const auto& [mesh, elements] :
         {Mesh{"2x15x1", {2, 15, 1}}, Mesh{"2x30x2", {2, 30, 2}}, Mesh{"4x60x4", {4, 60, 4}}})
      for (const double factor : {0.0, 0.1, 0.05, 0.02})
        for (const int every : {1, 2, 4}) {
          settings.element = element;
          settings.mesh = elements;
          settings.dtAuto = factor == 0.0;
          setFactor(settings, settings.dtAuto ? 0.05 : factor);
          settings.femEvery = every;
          plan.emplace_back(std::string(element) + ", " + mesh + ", dt " +
                                (settings.dtAuto ? "auto" : formatNumber(factor)) + ", FEM every " +
                                std::to_string(every),
                            settings);
        }
  return plan;
}

/// Time steps around the critical one, stiffness ratios 1e-3 … 1e4, widths to 40 d.
Plan stabilityPlan(const Settings& asked) {
  Plan plan;
  Settings base = asked;
  base.until = base.until.value_or(2.0);
  Settings settings = base;
  settings.dtAuto = false;
  for (const double share : {0.5, 0.9, 0.99, 1.01, 1.2, 1.4, 1.5, 2.0})
    for (const bool insisted : {false, true}) {
      if (insisted && share <= 1.0) continue;
      settings.shareOfCritical = share;
      settings.beyondCritical = insisted;
      plan.emplace_back("dt at " + formatNumber(share) + " of the critical step" + (insisted ? ", insisted on" : ""),
                        settings);
    }
  settings = base;
  for (const double ratio : {1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4}) {
    settings.stiffnessRatio = ratio;
    settings.dtAuto = ratio > 1.0;
    plan.emplace_back("stiffness ratio " + formatNumber(ratio), settings);
  }
  for (const double width : {0.01, 1.0, 10.0, 20.0, 40.0})
    for (const KernelName kernel : {KernelName::lucy, KernelName::gauss}) {
      settings = withWidth(base, width, base.scheme);
      settings.kernel = kernel;
      plan.emplace_back("width " + formatNumber(width) + " d, " + (kernel == KernelName::lucy ? "Lucy" : "Gauss"),
                        settings);
    }
  return plan;
}

/// The parts of the paper's scheme one at a time.
Plan ablationPlan(const Settings& base) {
  Plan plan;
  for (const double width : {0.0, 10.0}) {
    const std::string at = ", c = " + formatNumber(width) + " d";
    Settings plain = withWidth(base, width, Scheme::conservative);
    plain.surface = Surface::flat;
    setFactor(plain, 0.02);
    plain.correction = Correction::none;
    plan.emplace_back("conservative" + at, plain);
    const auto add = [&](const char* part, auto change) {
      Settings settings = plain;
      change(settings);
      plan.emplace_back(std::string("+ ") + part + at, settings);
    };
    add("load one step old", [](Settings& s) { s.lag = Lag::load; });
    add("load and skin one step old", [](Settings& s) { s.lag = Lag::loadAndSkin; });
    add("spread load, local gap", [](Settings& s) { s.transfer = Transfer::spread; });
    add("the authors' face rule", [](Settings& s) { s.edges = EdgeHandling::paper; });
    add("deformed metric", [](Settings& s) { s.metric = Metric::deformed; });
    add("implicit FEM", [](Settings& s) { s.fem = FemStepper::newmark; });
    add("restitution 0.99", [](Settings& s) { s.restitution = 0.99; });
    add("load one step old, implicit FEM, consistent mass", [](Settings& s) {
      s.lag = Lag::load;
      s.fem = FemStepper::newmark;
      s.mass = MassMatrix::consistent;
    });
    plan.emplace_back("the paper's scheme" + at, withWidth(plain, width, Scheme::paper));
  }
  return plan;
}

}  // namespace

benchmark::CaseStudy<Settings> studyOf(const Settings&) {
  benchmark::CaseStudy<Settings> study;
  study.plans = {
      {"widths", widthsPlan}, {"pareto", paretoPlan}, {"ablation", ablationPlan}, {"stability", stabilityPlan}};
  study.program = "cantilever";
  study.fronts = {{"time_mean_error_dynamic_m", "on_error_front"}, {"energy_drift_relative", "on_drift_front"}};
  study.shown = {"energy_drift_relative",
                 "energy_min_J",
                 "energy_max_J",
                 "leave_time_s",
                 "time_mean_error_m",
                 "time_mean_error_vertical_m",
                 "time_mean_error_dynamic_m"};
  study.about["published_code"] = {{"seconds_per_step", publishedSecondsPerStep}, {"dt_factor", publishedDtFactor}};
  return study;
}

}  // namespace dovetail::cantilever
