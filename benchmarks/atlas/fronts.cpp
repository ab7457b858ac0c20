// Error against run time.
#include <algorithm>
#include <cmath>
#include <map>

#include "dovetail/report/front.hpp"
#include "dovetail/report/text.hpp"
#include "results.hpp"

namespace dovetail::atlas {

namespace {

using report::Curve, report::Figure, report::format, report::Json;

/// A run: of which group, how long, how wrong.
struct Point {
  std::string label, group;
  double seconds, error;
  std::string command;
};

/// Points by group, and the front over all of them as a line.
Figure figureOf(const std::string& name, const std::string& title, const std::string& x, const std::string& y,
                const std::vector<Point>& points, const std::vector<Curve>& published, Chapter& chapter) {
  Figure figure{name, title, {x, true}, {y, true}, {}, {}};
  const auto counts = [](const Point& p) { return p.error > 0.0 && p.seconds > 0.0; };
  const std::vector<bool> on = report::onFront(
      points, counts, [](const Point& p) { return p.seconds; }, [](const Point& p) { return p.error; });
  std::map<std::string, Curve> groups;
  std::vector<std::pair<double, double>> front;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& p = points[k];
    if (!counts(p)) continue;
    Curve& curve = groups.try_emplace(p.group, Curve{p.group, {}, {}, false, true}).first->second;
    curve.x.push_back(p.seconds);
    curve.y.push_back(p.error);
    if (on[k]) front.emplace_back(p.seconds, p.error);
    chapter.rows.push_back({{"case", title},
                            {"label", p.label},
                            {"run_time", p.seconds},
                            {"error", p.error},
                            {"on_front", static_cast<bool>(on[k])},
                            {"command", p.command}});
  }
  std::sort(front.begin(), front.end());
  Curve line{"front", {}, {}, true, false};
  for (const auto& [seconds, error] : front) {
    line.x.push_back(seconds);
    line.y.push_back(error);
  }
  figure.curves.push_back(std::move(line));
  for (auto& [group, curve] : groups) figure.curves.push_back(std::move(curve));
  figure.curves.insert(figure.curves.end(), published.begin(), published.end());
  return figure;
}

std::string repeated(const Result& study, const std::string& label) {
  return study.command.substr(0, study.command.find(" --only")) + " --only '" + label + "'";
}

/// Runs of a study of a benchmark that finished.
template <class GroupOf>
std::vector<Point> pointsOf(const Result& study, const std::string& error, GroupOf groupOf) {
  std::vector<Point> points;
  for (const Json& row : study.content["runs"]) {
    if (wordOf(row, "outcome") != "finished") continue;
    const std::string label = wordOf(row, "label");
    points.push_back(
        {label, groupOf(label), numberOf(row, "wall_seconds"), std::abs(numberOf(row, error)), repeated(study, label)});
  }
  return points;
}

/// The authors' runs of 398 000 steps of 26 ms (benchmarks/cantilever/README.md): kernels of 0, 4 and 10 diameters.
std::vector<Curve> publishedCantilever() {
  return {{"authors' code, c = 0", {10348}, {52e-3}, false, true},
          {"c = 4 d", {10348}, {17e-3}, false, true},
          {"c = 10 d", {10348}, {4.9e-3}, false, true}};
}

void addCantilever(const std::vector<Result>& results, Chapter& chapter) {
  const Result* const study = find(results, "cantilever-pareto");
  if (!study) return;
  const auto byElement = [](const std::string& label) { return label.substr(0, label.find(',')); };
  chapter.sections.push_back(
      {"Error against run time: two particles slide over a cantilever",
       {report::Paragraph{
            "Surface coupling. Elements, meshes, steps and sub-steps of the solid; time of one core until the "
            "first particle leaves the beam. Against the static formula, which leaves inertia out, no run "
            "comes below some tenths of a millimetre; the authors' runs (CMAME 403, 115651: output "
            "deposited with the paper, 26 ms a step) stand there."},
        figureOf("cantilever_dynamic", "Off the moving-mass beam", "run time (s)", "time-mean error (m)",
                 pointsOf(*study, "time_mean_error_dynamic_m", byElement), {}, chapter),
        figureOf("cantilever_static", "Off the static formula", "run time (s)", "time-mean error (m)",
                 pointsOf(*study, "time_mean_error_m", byElement), publishedCantilever(), chapter),
        figureOf("cantilever_drift", "Drift of the energy", "run time (s)", "drift over the energy",
                 pointsOf(*study, "energy_drift_relative", byElement), {}, chapter)}});
}

/// What the authors' runs of the impulse lose, drawn where no time is known: as a table.
report::Table publishedWave() {
  return {{"case (authors' output, CMAME 403, 115651)", "energy lost in the overlap, %"},
          {{"n = 1 … 4 per edge, kernels of 0 … 2.5 elements", "30 … 56"}}};
}

void addWave(const std::vector<Result>& results, Chapter& chapter) {
  const Result* const study = find(results, "wave-pareto");
  if (!study) return;
  const auto byConstraint = [](const std::string& label) {
    return std::string(label.find("paper") != std::string::npos        ? "the paper's scheme"
                       : label.find("multiplier") != std::string::npos ? "multipliers"
                                                                       : "penalty");
  };
  chapter.sections.push_back(
      {"Error against run time: a pulse goes from particles into a solid",
       {report::Paragraph{"Volume coupling. Particles per element, kernel widths, constraints and steps; error of the "
                          "wave past the overlap against particles alone, and energy lost."},
        figureOf("wave_form", "Off particles alone", "run time (s)", "waveform error",
                 pointsOf(*study, "waveform_error_fem", byConstraint), {}, chapter),
        figureOf("wave_energy", "Energy lost", "run time (s)", "fraction of the input",
                 pointsOf(*study, "energy_lost_fraction", byConstraint), {}, chapter),
        publishedWave()}});
}

void addElements(const std::vector<Result>& results, Chapter& chapter) {
  const Result* const study = find(results, "fem-error-time");
  if (!study) return;
  std::map<std::string, std::vector<Point>> cases;
  for (const Json& row : study->content)
    cases[wordOf(row, "case")].push_back({wordOf(row, "element") + format(", %g cells", numberOf(row, "cells")),
                                          wordOf(row, "element"), numberOf(row, "seconds"),
                                          std::abs(numberOf(row, "error")), study->command});
  report::Section section{"Error against run time: elements of the solid", {}};
  int number = 0;
  for (const auto& [name, points] : cases)
    section.blocks.push_back(
        figureOf(format("elements_%d", ++number), name, "run time (s)", "relative error", points, {}, chapter));
  chapter.sections.push_back(std::move(section));
}

void addLaws(const std::vector<Result>& results, Chapter& chapter) {
  const Result* const study = find(results, "dem-accuracy");
  if (!study) return;
  std::vector<Point> errors, residuals;
  for (const Json& row : study->content["runs"]) {
    const std::string law = wordOf(row, "law");
    const std::string label = law + format(", %g steps per contact", numberOf(row, "steps_per_contact"));
    const double time = numberOf(row, "us_per_impact");
    errors.push_back({label, law, time, numberOf(row, "error"), study->command});
    residuals.push_back({label, law, time, numberOf(row, "residual"), study->command});
  }
  chapter.sections.push_back(
      {"Error against run time: laws of contact",
       {report::Paragraph{"Oblique collisions of spinning pairs with 10 to 160 steps per contact."},
        figureOf("laws_error", "Velocities and spins after an impact", "run time (µs per impact)", "relative error",
                 errors, {}, chapter),
        figureOf("laws_residual", "Residual of the energy", "run time (µs per impact)", "over what was lost", residuals,
                 {}, chapter)}});
}

void addFlagship(const std::vector<Result>& results, Chapter& chapter) {
  const Result* const study = find(results, "flagship");
  if (!study) return;
  report::Table table{{"quantity", "value"}, {}};
  for (const auto& [key, value] : study->content["figures"].items()) table.rows.push_back({key, report::textOf(value)});
  chapter.sections.push_back({"A pile is pushed into a bed: both couplings against grains alone",
                              {report::Paragraph{study->command}, std::move(table)}});
}

}  // namespace

Chapter frontsOf(const std::vector<Result>& results) {
  Chapter chapter;
  for (const auto add : {addCantilever, addWave, addElements, addLaws, addFlagship}) add(results, chapter);
  return chapter;
}

}  // namespace dovetail::atlas
