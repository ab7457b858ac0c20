#include "dovetail/core/finite.hpp"
#include "study.hpp"

namespace dovetail::cantilever {

namespace {

StudyRow planned(std::string label, const Settings& settings) {
  StudyRow row;
  row.label = std::move(label);
  row.settings = settings;
  return row;
}

void setFactor(Settings& settings, double factor) {
  settings.dtFactor = factor;
  settings.dtCapped = false;
}

Settings withScheme(Settings settings, Scheme scheme) {
  applyScheme(settings, scheme);
  return settings;
}

}  // namespace

std::vector<StudyRow> widthsPlan(const Settings& base) {
  struct Variant {
    const char* name;
    Scheme scheme;
    Correction correction;
  };
  std::vector<StudyRow> rows;
  for (const Variant& variant : {Variant{"conservative", Scheme::conservative, Correction::symmetric},
                                 Variant{"conservative, linear", Scheme::conservative, Correction::linear},
                                 Variant{"conservative, no correction", Scheme::conservative, Correction::none},
                                 Variant{"paper", Scheme::paper, Correction::none}})
    for (double width : {0.0, 2.0, 4.0, 6.0, 10.0, 15.0, 20.0}) {
      Settings settings = base;
      settings.cgWidth = width;
      applyScheme(settings, variant.scheme);
      settings.correction = variant.correction;
      if (variant.scheme == Scheme::paper) setFactor(settings, 0.02);
      rows.push_back(planned(std::string(variant.name) + ", c = " + formatNumber(width) + " d", settings));
    }
  return rows;
}

std::vector<StudyRow> paretoPlan(const Settings& base) {
  struct Mesh {
    const char* name;
    std::array<int, 3> elements;
  };
  std::vector<StudyRow> rows;
  Settings settings = withScheme(base, Scheme::conservative);
  for (const char* element : {"hex8", "hybrid8"})
    for (const Mesh& mesh : {Mesh{"2x15x1", {2, 15, 1}}, Mesh{"2x30x2", {2, 30, 2}}, Mesh{"4x60x4", {4, 60, 4}}})
      for (double factor : {0.0, 0.1, 0.05, 0.02})
        for (int every : {1, 2, 4}) {
          settings.element = element;
          settings.mesh = mesh.elements;
          settings.dtAuto = factor == 0.0;
          setFactor(settings, settings.dtAuto ? 0.05 : factor);
          settings.femEvery = every;
          rows.push_back(planned(std::string(element) + ", " + mesh.name + ", dt " +
                                     (settings.dtAuto ? "auto" : formatNumber(factor)) + ", FEM every " +
                                     std::to_string(every),
                                 settings));
        }
  return rows;
}

std::vector<StudyRow> stabilityPlan(const Settings& base) {
  std::vector<StudyRow> rows;
  Settings settings = base;
  settings.until = base.until.value_or(2.0);
  settings.dtAuto = false;
  for (double share : {0.5, 0.9, 0.99, 1.01, 1.2, 1.4, 1.5, 2.0}) {
    settings.shareOfCritical = share;
    rows.push_back(planned("dt at " + formatNumber(share) + " of the critical step", settings));
    if (share <= 1.0) continue;
    settings.beyondCritical = true;
    rows.push_back(planned("dt at " + formatNumber(share) + " of the critical step, insisted on", settings));
    settings.beyondCritical = false;
  }
  settings = base;
  settings.until = base.until.value_or(2.0);
  for (double ratio : {1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4}) {
    settings.stiffnessRatio = ratio;
    settings.dtAuto = ratio > 1.0;
    rows.push_back(planned("stiffness ratio " + formatNumber(ratio), settings));
  }
  settings = base;
  settings.until = base.until.value_or(2.0);
  for (double width : {0.01, 1.0, 10.0, 20.0, 40.0})
    for (KernelName kernel : {KernelName::lucy, KernelName::gauss}) {
      settings.cgWidth = width;
      applyScheme(settings, settings.scheme);
      settings.kernel = kernel;
      rows.push_back(
          planned("width " + formatNumber(width) + " d, " + (kernel == KernelName::lucy ? "Lucy" : "Gauss"), settings));
    }
  return rows;
}

std::vector<StudyRow> ablationPlan(const Settings& base) {
  std::vector<StudyRow> rows;
  for (double width : {0.0, 10.0}) {
    const std::string at = ", c = " + formatNumber(width) + " d";
    Settings plain = base;
    plain.cgWidth = width;
    applyScheme(plain, Scheme::conservative);
    plain.surface = Surface::flat;
    setFactor(plain, 0.02);
    plain.correction = Correction::none;
    rows.push_back(planned("conservative" + at, plain));
    const auto add = [&](const char* part, auto change) {
      Settings settings = plain;
      change(settings);
      rows.push_back(planned(std::string("+ ") + part + at, settings));
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
    Settings paper = withScheme(plain, Scheme::paper);
    rows.push_back(planned("the paper's scheme" + at, paper));
  }
  return rows;
}

}  // namespace dovetail::cantilever
