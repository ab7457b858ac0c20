#include "freedom.hpp"

#include <algorithm>

namespace dovetail::rve {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Of the four sides, for one component.
using Sides = std::array<Condition, 4>;

Condition atCorner(Condition one, Condition other) {
  for (const Condition c : {Condition::displacement, Condition::traction})
    if (one == c || other == c) return c;
  return Condition::periodic;
}

/// What each grain of the frame obeys.
std::vector<Condition> conditionsOf(const Border& border, const Sides& sides) {
  std::vector<Condition> on;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t m = 0; m < border.side[k].size(); ++m)
      on.push_back(m == 0 ? atCorner(sides[k], sides[(k + 3) % 4]) : sides[k]);
  return on;
}

/// Places of the grains at the corners.
std::vector<int> cornersOf(const Border& border) {
  std::vector<int> corners;
  int place = 0;
  for (const std::vector<Placed>& side : border.side) {
    corners.push_back(place);
    place += static_cast<int>(side.size());
  }
  return corners;
}

/// Copies of one grain that are whole periods apart along axes that are periodic, each set of them, alone or not.
std::vector<std::vector<int>> copiesAcross(const Frame& frame, const std::array<bool, 3>& periodic) {
  std::vector<std::vector<int>> sets;
  for (const std::vector<int>& group : frame.alike) {
    const std::size_t before = sets.size();
    for (const int q : group) {
      const auto isCopy = [&](const std::vector<int>& set) {
        for (std::size_t k = 0; k < 3; ++k)
          if (!periodic[k] && frame.image[at(q)][k] != frame.image[at(set.front())][k]) return false;
        return true;
      };
      const auto found = std::find_if(sets.begin() + static_cast<std::ptrdiff_t>(before), sets.end(), isCopy);
      found == sets.end() ? sets.push_back({q}) : found->push_back(q);
    }
  }
  return sets;
}

Freedom freedomOf(const Frame& frame, const Border& border, const Sides& sides, const std::vector<int>& alsoHeld) {
  const std::vector<Condition> on = conditionsOf(border, sides);
  std::array<bool, 3> periodic{};
  periodic[border.upwards] = sides[0] == Condition::periodic;
  periodic[border.sideways] = sides[1] == Condition::periodic;
  Freedom left;
  for (const std::vector<int>& set : copiesAcross(frame, periodic)) {
    const auto any = [&](auto&& holds) { return std::ranges::any_of(set, holds); };
    if (any([&](int q) {
          return on[at(q)] == Condition::displacement || std::ranges::find(alsoHeld, q) != alsoHeld.end();
        })) {
      left.held.insert(left.held.end(), set.begin(), set.end());
      continue;
    }
    if (set.size() > 1) left.together.push_back(set);
    if (any([&](int q) { return on[at(q)] == Condition::traction; })) left.balanced.push_back(set);
  }
  return left;
}

/// Turns obey what leaves more.
Condition looser(const SideCondition& side) { return std::max(side.along, side.across); }

}  // namespace

void setFreedom(Frame& frame, const Border& border, const Conditions& c) {
  const std::vector<int> held = c.cornersHeld ? cornersOf(border) : std::vector<int>{};
  const std::array<SideCondition, 4> sides{c.bottom, c.right, c.top, c.left};
  Sides along{}, across{}, turns{};
  for (std::size_t k = 0; k < 4; ++k) {
    along[k] = sides[k].along;
    across[k] = sides[k].across;
    turns[k] = looser(sides[k]);
  }
  frame.byComponent = along != across;
  frame.freedom = {freedomOf(frame, border, along, held), freedomOf(frame, border, across, held),
                   freedomOf(frame, border, turns, {})};
  frame.freedom[2].balanced.clear();
}

}  // namespace dovetail::rve
