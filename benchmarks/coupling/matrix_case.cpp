#include "matrix_case.hpp"

#include <set>

namespace dovetail::coupling_matrix {

namespace {

const std::array<std::vector<const char*>, factors> names{{{"hex8", "enhanced", "hex20", "tet4", "tet10"},
                                                           {"StVK", "neo-Hookean", "J2", "Drucker-Prager"},
                                                           {"surface", "penalty", "multipliers"},
                                                           {"frictional", "Hertz-Mindlin", "rolling"},
                                                           {"explicit1", "explicit4", "implicit1", "implicit4"}}};

/// Factor and level, twice.
using Pair = std::array<int, 4>;

std::vector<Pair> pairsOf(const Case& c) {
  const auto level = levelsOf(c);
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < factors; ++a)
    for (std::size_t b = a + 1; b < factors; ++b)
      pairs.push_back({static_cast<int>(a), level[a], static_cast<int>(b), level[b]});
  return pairs;
}

}  // namespace

std::array<int, factors> levelsOf(const Case& c) {
  return {static_cast<int>(c.element), static_cast<int>(c.law), static_cast<int>(c.joint), static_cast<int>(c.contact),
          static_cast<int>(c.macroSteps)};
}

Case caseOf(const std::array<int, factors>& level) {
  return {static_cast<Element>(level[0]), static_cast<SolidLaw>(level[1]), static_cast<Joint>(level[2]),
          static_cast<ContactKind>(level[3]), static_cast<MacroSteps>(level[4])};
}

std::string levelName(std::size_t factor, int level) { return names[factor][static_cast<std::size_t>(level)]; }

std::string nameOf(const Case& c) {
  std::string name;
  for (std::size_t f = 0; f < factors; ++f) name += (f > 0 ? " " : "") + levelName(f, levelsOf(c)[f]);
  return name;
}

std::vector<Case> allCases() {
  std::vector<Case> cases;
  std::array<int, factors> level{};
  for (;;) {
    cases.push_back(caseOf(level));
    std::size_t f = factors;
    while (f > 0 && ++level[f - 1] == levels[f - 1]) level[--f] = 0;
    if (f == 0) return cases;
  }
}

std::vector<Case> pairwiseCases() {
  const std::vector<Case> all = allCases();
  std::set<Pair> open;
  for (const Case& c : all)
    for (const Pair& pair : pairsOf(c)) open.insert(pair);
  std::vector<Case> chosen;
  while (!open.empty()) {
    const Case* best = nullptr;
    std::size_t most = 0;
    for (const Case& c : all) {
      std::size_t gain = 0;
      for (const Pair& pair : pairsOf(c)) gain += open.count(pair);
      if (gain > most) most = gain, best = &c;
    }
    for (const Pair& pair : pairsOf(*best)) open.erase(pair);
    chosen.push_back(*best);
  }
  return chosen;
}

}  // namespace dovetail::coupling_matrix
