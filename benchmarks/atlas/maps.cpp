// What became of stiff and extreme cases.
#include <algorithm>
#include <cmath>
#include <map>
#include <regex>

#include "dovetail/report/text.hpp"
#include "results.hpp"

namespace dovetail::atlas {

namespace {

using report::format, report::Json, report::Map;

/// A cell, and where it stands.
struct Placed {
  std::string row, column;
  Map::Cell cell;
};

std::string command(const std::string& study, const std::string& label) {
  return study.substr(0, study.find(" --only")) + " --only '" + label + "'";
}

/// Rows and columns in the order in which they first come.
Map mapOf(const std::string& title, const std::string& x, const std::string& y, const std::vector<Placed>& placed) {
  Map map{title, x, y, {}, {}, {}};
  const auto numberIn = [](std::vector<std::string>& names, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) names.push_back(name);
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (const Placed& p : placed) numberIn(map.rows, p.row), numberIn(map.columns, p.column);
  map.cells.assign(map.rows.size(), std::vector<Map::Cell>(map.columns.size()));
  for (const Placed& p : placed) map.cells[numberIn(map.rows, p.row)][numberIn(map.columns, p.column)] = p.cell;
  return map;
}

Map::Outcome outcomeOf(const Json& row) {
  const std::string outcome = wordOf(row, "outcome");
  if (outcome == "finished" || outcome == "bounded") return Map::Outcome::survived;
  return outcome == "refused" && !wordOf(row, "message").empty() ? Map::Outcome::refused : Map::Outcome::failed;
}

std::string detailOf(const Json& row, const std::string& figure, const std::string& repeat) {
  const std::string why = wordOf(row, "message");
  return wordOf(row, "outcome") + (figure.empty() ? "" : ", " + figure) + (why.empty() ? "" : ": " + why) + "\n\n" +
         repeat;
}

/// Labels of a study that belong to one map. The first group of the pattern is the column, the others make the row.
struct Rule {
  const char* study;
  const char* pattern;
  const char* title;
  const char* x;
  const char* y;
  const char* figure;  ///< told in the cell
};

const Rule rules[] = {
    {"cantilever-stability", R"(dt at ([^ ]+) of the critical step()())", "Surface coupling: time step",
     "step over the critical step", "", "energy_drift_relative"},
    {"cantilever-stability", R"(stiffness ratio ([^ ]+)()())", "Surface coupling: stiffness",
     "contact stiffness over E d", "", "energy_drift_relative"},
    {"cantilever-stability", R"(width ([^ ]+) d, (Lucy|Gauss)())", "Surface coupling: kernel width",
     "width over the particle's diameter", "kernel", "energy_drift_relative"},
    {"wave-stability", R"((?:penalty|multiplier), dt at ([^ ]+) of the critical step()())",
     "Volume coupling: time step", "step over the critical step", "constraint", "ledger_residual_relative"},
    {"wave-stability", R"((?:penalty|multiplier), weight floor ([^ ,]+)(, dt auto)?())",
     "Volume coupling: weight floor", "least weight of either model", "constraint", "ledger_residual_relative"},
    {"wave-stability", R"((?:penalty|multiplier), stiffness ratio ([^ ,]+)(, dt auto)?())",
     "Volume coupling: modulus ratio", "E of the solid over that of the particles", "constraint",
     "ledger_residual_relative"},
    {"wave-stability", R"((?:penalty|multiplier), density ratio ([^ ,]+)(, dt auto)?())",
     "Volume coupling: density ratio", "density of the solid over that of the particles", "constraint",
     "ledger_residual_relative"},
    {"wave-stability", R"(penalty, penalty ([^ ,]+)(, dt auto)?())", "Volume coupling: penalty", "penalty (Pa/m²)",
     "constraint", "ledger_residual_relative"},
};

/// "penalty, dt auto" of "penalty, weight floor 0.1, dt auto"
std::string rowOf(const std::string& label, const std::smatch& found, const Rule& rule) {
  const bool byConstraint = std::string(rule.y) == "constraint";
  return (byConstraint ? label.substr(0, label.find(',')) : std::string()) + found[2].str();
}

std::vector<Placed> cellsOf(const Result& study, const Rule& rule) {
  const std::regex pattern(rule.pattern);
  std::vector<Placed> placed;
  for (const Json& row : study.content["runs"]) {
    const std::string label = wordOf(row, "label");
    std::smatch found;
    if (!std::regex_match(label, found, pattern)) continue;
    const double figure = numberOf(row, rule.figure);
    const std::string value = std::isfinite(figure) ? format("%.0e", std::abs(figure)) : "";
    const std::string told = value.empty() ? "" : std::string(rule.figure) + format(" %.3e", figure);
    placed.push_back({rowOf(label, found, rule),
                      found[1].str(),
                      {outcomeOf(row), value, detailOf(row, told, command(study.command, label))}});
  }
  return placed;
}

/// Single cases in one column.
std::vector<Placed> listOf(const Result& study) {
  std::vector<Placed> placed;
  for (const Json& row : study.content["runs"]) {
    const std::string label = wordOf(row, "label"), value = wordOf(row, "value");
    placed.push_back({label,
                      "outcome",
                      {outcomeOf(row), value == "-" ? "" : value,
                       detailOf(row, wordOf(row, "figure") + " " + value, command(study.command, label))}});
  }
  return placed;
}

/// Of what changed hands in a run of a scene, what may be left over for the energy to have stayed: in an impact a
/// twentieth of the energy is a fortieth of the speed of rebound, which is about how well a coefficient of restitution
/// is known.
constexpr double memoryFraction = 0.05;

/// Scenes run with every combination of two values.
Map::Outcome outcomeOfScene(const Json& row, double fraction) {
  const Map::Outcome outcome = outcomeOf(row);
  return outcome == Map::Outcome::survived && !(fraction < memoryFraction) ? Map::Outcome::failed : outcome;
}

std::string sceneCommand(const Result& study, const std::string& label) {
  std::string words = study.command.substr(0, study.command.find(" --over"));
  words.replace(words.find(" study "), 7, " run ");
  std::size_t begin = 0;
  while (begin < label.size()) {
    const std::size_t end = std::min(label.find(", ", begin), label.size());
    words += " --set '" + label.substr(begin, end - begin) + "'";
    begin = end + 2;
  }
  return words;
}

/// "size ratio" of a scene's parameter size_ratio
std::string axisName(std::string parameter) {
  if (parameter == "safety") return "fraction of the critical step (safety)";
  std::replace(parameter.begin(), parameter.end(), '_', ' ');
  return parameter;
}

std::vector<Placed> cellsOfScenes(const Result& study, std::string& x, std::string& y) {
  std::vector<Placed> placed;
  for (const Json& row : study.content["runs"]) {
    const Json& settings = row["settings"];
    auto at = settings.begin();
    y = axisName(at.key());
    const std::string rowName = at.value();
    ++at;
    x = axisName(at.key());
    const double fraction = numberOf(row, "largest_residual_fraction");
    placed.push_back(
        {rowName,
         at.value(),
         {outcomeOfScene(row, fraction), std::isfinite(fraction) ? format("%.0e", fraction) : "",
          detailOf(row, std::isfinite(fraction) ? format("residual of %.3e of the exchanged energy", fraction) : "",
                   sceneCommand(study, wordOf(row, "label")))}});
  }
  return placed;
}

class Atlas {
public:
  void add(const Map& map) {
    for (std::size_t r = 0; r < map.rows.size(); ++r)
      for (std::size_t c = 0; c < map.columns.size(); ++c) {
        const Map::Cell& cell = map.cells[r][c];
        if (cell.outcome == Map::Outcome::none) continue;
        ++counts_[cell.outcome];
        rows_.push_back({{"map", map.title},
                         {"row", map.rows[r]},
                         {"column", map.columns[c]},
                         {"outcome", report::wordOf(cell.outcome)},
                         {"value", cell.value},
                         {"detail", cell.detail}});
      }
    maps_.push_back(map);
  }
  Chapter chapter() const {
    Chapter chapter{{}, rows_};
    if (maps_.empty()) return chapter;
    const auto count = [&](Map::Outcome outcome) { return counts_.contains(outcome) ? counts_.at(outcome) : 0; };
    report::Section section{"Stability", {}};
    section.blocks.push_back(report::Paragraph{
        format("%zu cells: %d survived, %d refused with a reason, %d failed. Press a cell for details and the command "
               "that repeats it. The number is the relative error of the energy; the scenes' runs (grains, surface and "
               "volume coupling over two values) have survived if it is below %.0f %% of the exchanged energy, with "
               "automatic steps, which give an impact eight steps at least.",
               rows_.size(), count(Map::Outcome::survived), count(Map::Outcome::refused), count(Map::Outcome::failed),
               100.0 * memoryFraction)});
    for (const Map& map : maps_) section.blocks.push_back(map);
    chapter.sections.push_back(std::move(section));
    return chapter;
  }

private:
  std::vector<Map> maps_;
  std::vector<Json> rows_;
  std::map<Map::Outcome, int> counts_;
};

}  // namespace

Chapter mapsOf(const std::vector<Result>& results) {
  Atlas atlas;
  for (const Rule& rule : rules)
    if (const Result* const study = find(results, rule.study)) {
      const std::vector<Placed> placed = cellsOf(*study, rule);
      if (!placed.empty()) atlas.add(mapOf(rule.title, rule.x, rule.y, placed));
    }
  for (const Result& result : results)
    if (result.id.starts_with("map: ") && !result.content.is_null()) {
      std::string x, y;
      const std::vector<Placed> placed = cellsOfScenes(result, x, y);
      atlas.add(mapOf(result.id.substr(5), x, y, placed));
    }
  if (const Result* const study = find(results, "dem-stability"))
    atlas.add(mapOf("Grains: stiff and extreme cases", "", "case", listOf(*study)));
  return atlas.chapter();
}

}  // namespace dovetail::atlas
