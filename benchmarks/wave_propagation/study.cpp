#include <array>

#include "dovetail/core/finite.hpp"
#include "run.hpp"

namespace dovetail::wave {

namespace {

using Plan = benchmark::Plan<Settings>;

std::string nameOf(Constraint constraint) {
  return std::array{"penalty", "multiplier", "dashpot"}[static_cast<std::size_t>(constraint)];
}

/// The settings as they are if they are of that scheme already.
Settings withScheme(Settings settings, Scheme scheme) {
  if (settings.scheme != scheme) applyScheme(settings, scheme);
  return settings;
}

/// The paper's scheme on the bar, with the signal and up to the time of `plain`.
Settings paperUnderTheSignalOf(const Settings& plain) {
  Settings paper = withScheme(plain, Scheme::paper);
  paper.signal = plain.signal;
  paper.until = endTime(plain);
  paper.femLength = solidElements(plain) * Case{}.elementSize;
  return paper;
}

/// Kernel widths 0 … 10 with penalty and multipliers, 0 … 2.5 in the paper's scheme.
Plan widthsPlan(const Settings& base) {
  Plan rows;
  const auto label = [](const std::string& what, double width) {
    return what + ", c = " + formatNumber(width) + " elements";
  };
  Settings settings = withScheme(base, Scheme::conservative);
  for (const Constraint constraint : {Constraint::penalty, Constraint::multiplier})
    for (const double width : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 5.0, 7.5, 10.0}) {
      settings.constraint = constraint;
      settings.cgWidth = width;
      rows.emplace_back(label(nameOf(constraint), width), settings);
    }
  settings = withScheme(base, Scheme::paper);
  for (const double width : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5}) {
    settings.cgWidth = width;
    rows.emplace_back(label("paper", width), settings);
  }
  return rows;
}

/// All constraints and both forms of the gap, by penalty.
Plan constraintsPlan(const Settings& base) {
  Plan rows;
  const Settings plain = withScheme(base, Scheme::conservative);
  for (const Gap gap : {Gap::atParticles, Gap::nodal}) {
    const std::string form = gap == Gap::nodal ? ", nodal gap" : ", gap at the particles";
    Settings settings = plain;
    settings.gap = gap;
    settings.constraint = Constraint::multiplier;
    rows.emplace_back("multiplier" + form, settings);
    for (const Constraint constraint : {Constraint::penalty, Constraint::dashpot})
      for (const double penalty : {1e7, 1e8, 1e9, 1e10, 1e11, 1e12}) {
        settings.constraint = constraint;
        settings.penalty = penalty;
        // A stiff spring asks for a shorter step; a dashpot for a floor that leaves both models mass to damp.
        settings.shareOfCritical.reset();
        if (constraint != Constraint::dashpot && penalty > 1e10) settings.shareOfCritical = 0.9;
        settings.weightFloor = constraint == Constraint::dashpot ? 0.1 : plain.weightFloor;
        rows.emplace_back(nameOf(constraint) + form + ", " + formatNumber(penalty) + " Pa/m2", settings);
      }
  }
  return rows;
}

/// Particles per element × width × constraint × time step, and the paper's scheme under the same signal.
Plan paretoPlan(const Settings& base) {
  Plan rows;
  Settings settings = withScheme(base, Scheme::conservative);
  for (const int n : {1, 2, 4}) {
    settings.particlesPerEdge = n;
    const std::string start = "n = " + std::to_string(n);
    for (const double width : {0.0, 1.5})
      for (const Constraint constraint : {Constraint::penalty, Constraint::multiplier})
        for (const double factor : {0.0, 0.02, 0.005}) {
          settings.cgWidth = width;
          settings.constraint = constraint;
          settings.dtAuto = factor == 0.0;
          settings.dtFactor = settings.dtAuto ? 0.02 : factor;
          rows.emplace_back(start + ", " + nameOf(constraint) + ", c = " + formatNumber(width) + ", dt " +
                                (settings.dtAuto ? "auto" : formatNumber(factor)),
                            settings);
        }
    settings.cgWidth = 0.0;
    settings.dtAuto = false;
    rows.emplace_back(start + ", the paper's scheme, c = 0, dt 0.01", paperUnderTheSignalOf(settings));
  }
  return rows;
}

void planSteps(const Settings& base, Plan& rows) {
  for (const Constraint constraint : {Constraint::penalty, Constraint::multiplier}) {
    Settings settings = base;
    settings.constraint = constraint;
    const std::string start = nameOf(constraint) + ", dt at ";
    for (const double share : {0.5, 0.9, 0.99, 1.01, 1.05, 1.2, 1.5, 2.0}) {
      settings.shareOfCritical = share;
      settings.beyondCritical = false;
      rows.emplace_back(start + formatNumber(share) + " of the critical step", settings);
      settings.beyondCritical = true;
      if (share > 1.0) rows.emplace_back(start + formatNumber(share) + " of the critical step, insisted on", settings);
    }
  }
}

/// Values of one setting, each with the step as it comes and with an automatic one.
void planDecades(const Settings& base, const char* what, double Settings::*part, const std::vector<double>& values,
                 Plan& rows) {
  for (const double value : values)
    for (const bool automatic : {false, true}) {
      Settings settings = base;
      settings.dtAuto = automatic;
      settings.*part = value;
      rows.emplace_back(
          nameOf(base.constraint) + ", " + what + " " + formatNumber(value) + (automatic ? ", dt auto" : ""), settings);
    }
}

/// Time steps around the critical one, weight floors to 0, penalties over six decades, stiffness and density ratios
/// 1e-3 … 1e3.
Plan stabilityPlan(const Settings& base) {
  Plan rows;
  Settings plain = withScheme(base, Scheme::conservative);
  plain.compare = plain.dtAuto = false;
  planSteps(plain, rows);
  const std::vector<double> ratios{1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3};
  for (const Constraint constraint : {Constraint::penalty, Constraint::multiplier}) {
    plain.constraint = constraint;
    planDecades(plain, "weight floor", &Settings::weightFloor, {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 0.0},
                rows);
    planDecades(plain, "stiffness ratio", &Settings::stiffnessRatio, ratios, rows);
    planDecades(plain, "density ratio", &Settings::densityRatio, ratios, rows);
  }
  plain.constraint = Constraint::penalty;
  planDecades(plain, "penalty", &Settings::penalty, {1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13}, rows);
  return rows;
}

}  // namespace

benchmark::CaseStudy<Settings> studyOf(const Settings&) {
  benchmark::CaseStudy<Settings> study;
  study.plans = {
      {"widths", widthsPlan}, {"pareto", paretoPlan}, {"stability", stabilityPlan}, {"constraints", constraintsPlan}};
  study.program = "wave_propagation";
  study.fronts = {{"waveform_error_fem", "on_waveform_front"}, {"energy_lost_share", "on_energy_front"}};
  study.shown = {"seconds_per_step", "energy_lost_share", "waveform_error_fem", "reflected_energy_share",
                 "paper_dissipated_share"};
  return study;
}

}  // namespace dovetail::wave
