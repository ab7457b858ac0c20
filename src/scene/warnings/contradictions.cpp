// Parts of a scene that are there twice, or undo each other.
#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "build/time_functions.hpp"
#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/scene/files.hpp"
#include "keys/keys.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

template <class Item>
void lookAtItems(const std::string& list, const std::vector<Item>& items, Lines& lines) {
  std::map<std::string, std::size_t> known;
  for (std::size_t k = 0; k < items.size(); ++k) {
    Item copy = items[k];
    const std::string text = textOf([&](Fields& fields) { describe(fields, copy); });
    const auto [first, isNew] = known.emplace(text, k);
    if (!isNew)
      lines.push_back(item(list, first->second) + " and " + item(list, k) + " are identical" +
                      (list.ends_with("supports") ? "" : ", and both act") + ": leave one of them out.");
  }
}

void lookAtSupports(const std::string& of, const std::vector<Support>& supports, Lines& lines) {
  for (std::size_t k = 0; k < supports.size(); ++k) {
    const Support& one = supports[k];
    const std::array held{one.x, one.y, one.z};
    const TimeVector& path = one.displacement ? *one.displacement : one.velocity;
    for (std::size_t c = 0; c < 3; ++c)
      if (!held[c] && !(isConstant(path[c]) && path[c].number == 0.0))
        lines.push_back(item(of, k) + " moves along " + "xyz"[c] +
                        ", which is not among its components, so that this has no effect: add \"" + "xyz"[c] +
                        "\" to \"components\", or leave that part of its motion out.");
  }
}

double pressureOf(const Load& load) {
  const auto* const pressure = std::get_if<PressureLoad>(&load.kind);
  return pressure && pressure->pressure.expression.empty() ? pressure->pressure.number : 0.0;
}

void lookAtLoads(const std::string& of, const std::vector<Load>& loads, Lines& lines) {
  for (std::size_t j = 0; j < loads.size(); ++j)
    for (std::size_t i = 0; i < j; ++i)
      if (loads[i].on == loads[j].on && pressureOf(loads[i]) != 0.0 && pressureOf(loads[i]) == -pressureOf(loads[j]))
        lines.push_back(item(of, i) + " and " + item(of, j) + " on " + quoted(loads[i].on) +
                        " cancel each other: leave both out, or give one of them another set.");
}

/// What supports hold feels no load.
void lookAtHeldFaces(const Built& built, const Scene& scene, std::size_t s, const std::string& of, Lines& lines) {
  if (!built.run->solid(s).mass || isOfPoints(scene.solids[s])) return;  // not started, or held by borders
  const fem::DofMap& dofs = built.run->solid(s).mass->dofs();
  const auto isHeld = [&](int node) {
    for (std::size_t c = 0; c < 3; ++c) {
      const fem::Role role = dofs.role(3 * static_cast<std::size_t>(node) + c);
      if (role == fem::Role::free || role == fem::Role::tied) return false;
    }
    return true;
  };
  for (std::size_t k = 0; k < scene.solids[s].loads.size(); ++k) {
    const std::string& set = scene.solids[s].loads[k].on;
    if (std::holds_alternative<NodalLoad>(scene.solids[s].loads[k].kind)) continue;
    if (std::ranges::all_of(fem::faceSet(built.meshes[s], set), [&](const fem::Face& face) {
          return std::all_of(face.node.begin(), face.node.begin() + fem::nodesOf(face.shape), isHeld);
        }))
      lines.push_back(item(of, k) + " acts on " + quoted(set) +
                      ", all of whose nodes are held, and loads the supports only: give it a free face.");
  }
}

/// Their overlap moves them as well.
void lookAtDrivenInOverlaps(const Built& built, Lines& lines) {
  const dem::Model& grains = built.run->grains;
  for (const auto* tie : std::as_const(grains).terms.all<arlequin::ArlequinCoupling>()) {
    const auto held = tie->overlap().particle;
    const std::set<int> within(held.begin(), held.end());
    const auto drives = std::as_const(grains).terms.all<dem::DriveTerm>();
    for (std::size_t d = 0; d < drives.size(); ++d) {
      const auto count = std::ranges::count_if(
          drives[d]->ids(), [&](std::int64_t id) { return within.contains(dem::find(grains.particles, id)); });
      if (count > 0)
        lines.push_back(std::to_string(count) + " grains of drives." + std::to_string(d) + " lie in the overlap with " +
                        scene::quoted(tie->side().name) +
                        ", which constrains them as well: leave them out of the group.");
    }
  }
}

}  // namespace

void lookForContradictions(const Built& built, const Scene& scene, Lines& lines) {
  lookAtItems("walls", scene.walls, lines);
  lookAtItems("clumps", scene.clumps, lines);
  lookAtItems("insertions", scene.insertions, lines);
  lookAtItems("outlets", scene.outlets, lines);
  for (std::size_t s = 0; s < scene.solids.size(); ++s) {
    const std::string of = "solids." + std::to_string(s);
    lookAtItems(of + ".loads", scene.solids[s].loads, lines);
    lookAtItems(of + ".supports", scene.solids[s].supports, lines);
    lookAtItems(of + ".planes", scene.solids[s].planes, lines);
    lookAtSupports(of + ".supports", scene.solids[s].supports, lines);
    lookAtLoads(of + ".loads", scene.solids[s].loads, lines);
    lookAtHeldFaces(built, scene, s, of + ".loads", lines);
  }
  lookAtDrivenInOverlaps(built, lines);
}

}  // namespace dovetail::scene
