#include "tables.hpp"

#include <algorithm>
#include <map>

#include "dovetail/report/table.hpp"
#include "dovetail/report/text.hpp"

namespace dovetail::coupling_matrix {

namespace {

using report::format;
using report::Json;

Json entryOf(const Row& row) {
  const Figures& f = row.figures;
  Json entry;
  for (std::size_t k = 0; k < factors; ++k) entry[factorNames[k]] = levelName(k, levelsOf(row.c)[k]);
  entry["dt_s"] = f.dt;
  for (std::size_t k = 0; k < fractions.size(); ++k)
    entry[format("energy_at_%g", fractions[k])] = report::numberOrNull(f.energy[k]);
  entry["largest_energy"] = f.largestEnergy;
  entry["energy_order"] = report::numberOrNull(f.energyOrder());
  entry["momentum"] = f.momentum;
  for (std::size_t k = 0; k < fractions.size(); ++k)
    entry[format("angular_at_%g", fractions[k])] = report::numberOrNull(f.angular[k]);
  entry["mass"] = f.mass;
  entry["friction_fraction"] = f.friction;
  entry["same_for_threads"] = f.threads;
  entry["same_after_restart"] = f.restart;
  entry["seconds"] = f.seconds;
  entry["falls_short"] = shortfall(row.c, f);
  entry["refused"] = f.refused;
  return entry;
}

/// The worst figures of some cases.
struct Worst {
  int cases = 0, refused = 0, shortOf = 0;
  double energy = 0.0, order = 1e9, momentum = 0.0, angularExplicit = 0.0, angularImplicit = 0.0, mass = 0.0;

  void take(const Row& row) {
    ++cases;
    const Figures& f = row.figures;
    if (!f.refused.empty()) {
      ++refused;
      return;
    }
    if (!shortfall(row.c, f).empty()) ++shortOf;
    if (!f.broke.empty()) return;
    energy = std::max(energy, f.largestEnergy);
    order = std::min(order, f.energyOrder());
    momentum = std::max(momentum, f.momentum);
    double& angular = row.c.isImplicit() ? angularImplicit : angularExplicit;
    angular = std::max(angular, f.angular[1]);
    mass = std::max(mass, f.mass);
  }
  std::string line(const std::string& name) const {
    if (cases == refused) return format("| %s | %d | %d | | | | | | | |\n", name.c_str(), cases, refused);
    return format("| %s | %d | %d | %d | %.1e | %.1f | %.1e | %.1e | %.1e | %.1e |\n", name.c_str(), cases, refused,
                  shortOf, energy, order, momentum, angularExplicit, angularImplicit, mass);
  }
};

std::string worstByLevel(const std::vector<Row>& rows) {
  std::string text =
      "| cases with | cases | refused | short of what is asked | energy | its least order | momentum | angular, "
      "explicit | "
      "angular, implicit | mass |\n|---|---|---|---|---|---|---|---|---|---|\n";
  Worst all;
  for (const Row& row : rows) all.take(row);
  text += all.line("all");
  for (std::size_t f = 0; f < factors; ++f)
    for (int level = 0; level < levels[f]; ++level) {
      Worst worst;
      for (const Row& row : rows)
        if (levelsOf(row.c)[f] == level) worst.take(row);
      if (worst.cases > 0) text += worst.line(levelName(f, level));
    }
  return text;
}

/// Cases by what is said of them.
std::string listed(const std::map<std::string, std::vector<std::string>>& cases, const char* title) {
  if (cases.empty()) return {};
  std::string text = format("\n%s\n\n", title);
  for (const auto& [what, names] : cases)
    text += format("- %s: %zu, such as %s\n", what.c_str(), names.size(), names.front().c_str());
  return text;
}

}  // namespace

std::string csvOf(const std::vector<Row>& rows, const io::KeyValues& provenance) {
  std::vector<Json> entries;
  for (const Row& row : rows) entries.push_back(entryOf(row));
  return report::csvOf(entries, provenance);
}

std::string markdownOf(const std::vector<Row>& rows) {
  std::map<std::string, std::vector<std::string>> shortOf, refused;
  for (const Row& row : rows) {
    if (!row.figures.refused.empty()) refused[row.figures.refused].push_back(nameOf(row.c));
    if (const std::string what = shortfall(row.c, row.figures); !what.empty()) shortOf[what].push_back(nameOf(row.c));
  }
  return worstByLevel(rows) + listed(shortOf, "Short of what is asked:") + listed(refused, "Refused:");
}

}  // namespace dovetail::coupling_matrix
