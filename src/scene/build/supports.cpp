#include "supports.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dovetail/core/finite.hpp"
#include "dovetail/fem/model/ties.hpp"
#include "parts.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

constexpr double negligible = 1e-6;  // fraction of a master in a tie: files have that many digits

std::size_t indexOf(int node, int component) {
  return 3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(component);
}

std::string textOf(const TimeValue& value) { return isConstant(value) ? formatNumber(value.number) : value.expression; }

}  // namespace

Holders::Holders(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid, const Scene& scene)
    : model_(model),
      mesh_(mesh),
      solid_(solid),
      scene_(scene),
      heldBy_(3 * mesh.X.size(), nobody),
      carriedBy_(3 * mesh.X.size(), nullptr),
      masterOf_(3 * mesh.X.size(), nullptr) {}

std::string Holders::placeOf(int node, int component) const {
  const Vec3& X = mesh_.X[static_cast<std::size_t>(node)];
  return std::string("component ") + "xyz"[component] + " of the node at (" + rounded(X.x) + ", " + rounded(X.y) +
         ", " + rounded(X.z) + ") m";
}

Holders::Motion Holders::motionOf(const Support& support, int component, const Travel& travel) const {
  const auto number = &support - solid_.supports.data();
  const auto c = static_cast<std::size_t>(component);
  Motion motion{.name = "supports item " + std::to_string(number) + " on " + quoted(support.on)};
  motion.displacement = travel.displacement;
  const TimeValue& velocity = support.velocity[c];
  if (support.displacement) {
    const TimeValue& displacement = (*support.displacement)[c];
    motion.steady = isConstant(displacement) && displacement.number == 0.0;
    motion.text = "moved by " + textOf(displacement);
  } else {
    motion.steady = isConstant(velocity);
    motion.velocity = motion.steady ? velocity.number : 0.0;
    motion.text = "moved with the velocity " + textOf(velocity);
  }
  if (motion.steady && motion.velocity == 0.0) motion.text = "held";
  return motion;
}

/// At times that no period of a function is likely to share.
bool Holders::areSame(int first, int second) {
  if (first == second) return true;
  const std::pair key{std::min(first, second), std::max(first, second)};
  if (const auto known = same_.find(key); known != same_.end()) return known->second;
  const Motion &a = motions_[static_cast<std::size_t>(first)], &b = motions_[static_cast<std::size_t>(second)];
  double largest = 0.0, apart = 0.0;
  constexpr int samples = 199;
  for (int k = 0; k <= samples && a.text != b.text; ++k) {
    const double t = durationOf(scene_) * std::pow(static_cast<double>(k) / samples, 1.37);
    const double p = a.displacement(t), q = b.displacement(t);
    largest = std::max({largest, std::abs(p), std::abs(q)});
    apart = std::max(apart, std::abs(p - q));
  }
  return same_[key] = apart <= 1e-9 * largest;
}

void Holders::lookForJump(const Motion& motion, int component) {
  const double jump = motion.displacement(0.0);
  if (jump == 0.0) return;
  jumps_.push_back(
      "WARNING: Of " + quoted(solid_.name) + ", " + motion.name + " moves component " + "xyz"[component] + " by " +
      rounded(jump) +
      " m at once at t = 0, which strains only the elements next to it: let the displacement start at 0, such as \"" +
      rounded(jump) + "*min(t/T, 1)\" with a T of several periods of the solid, or move the mesh.");
}

void Holders::claim(const std::vector<int>& set, int component, Motion motion) {
  const int number = static_cast<int>(motions_.size());
  motions_.push_back(std::move(motion));
  std::vector<int> fresh;
  for (const int node : set) {
    int& by = heldBy_[indexOf(node, component)];
    if (by == nobody) {
      by = number;
      fresh.push_back(node);
    } else if (!areSame(by, number)) {
      const Motion &other = motions_[static_cast<std::size_t>(by)], &own = motions_.back();
      throw InputError(placeOf(node, component) + " is " + own.text + " here, and " + other.text + " by " + other.name,
                       "",
                       std::string("leave \"") + "xyz"[component] +
                           "\" out of the components of one, the nodes common to both out of one of the sets, or let "
                           "both do the same");
    }
  }
  if (fresh.empty()) return;
  const Motion& own = motions_.back();
  if (!own.steady) return prescribe(fresh, component, own.displacement);
  fem::fix(model_.nodes, fresh, 1U << component);
  for (const int node : fresh) model_.nodes.v[static_cast<std::size_t>(node)][component] = own.velocity;
}

/// From where the nodes are: those of a state need not be where they are described.
void Holders::prescribe(const std::vector<int>& nodes, int component, const TimeFunction& displacement) {
  std::map<double, std::vector<int>> byStart;
  for (const int node : nodes) byStart[model_.nodes.u[static_cast<std::size_t>(node)][component]].push_back(node);
  for (const auto& [start, those] : byStart)
    if (start == 0.0)
      model_.constraints.prescribe(those, component, displacement);
    else
      model_.constraints.prescribe(those, component, [=, start = start](double t) { return start + displacement(t); });
}

void Holders::hold(const Support& support) {
  const std::vector<int>& set = fem::nodeSet(mesh_, support.on);
  const std::array<Travel, 3> path = travels(support.velocity, support.displacement, scene_);
  const std::array<bool, 3> held{support.x, support.y, support.z};
  if (std::ranges::count(held, true) == 0)
    throw InputError("components is empty, and the support on " + quoted(support.on) + " holds nothing", "",
                     "name components, such as [\"x\"], or leave the key out to hold all");
  for (int c = 0; c < 3; ++c) {
    const auto axis = static_cast<std::size_t>(c);
    if (!held[axis]) continue;
    Motion motion = motionOf(support, c, path[axis]);
    if (!motion.steady) lookForJump(motion, c);
    claim(set, c, std::move(motion));
  }
}

bool Holders::masterGoesAlong(const fem::Tie& tie, int motion) {
  return std::ranges::all_of(tie.masters, [&](const fem::Tie::Master& master) {
    const int by = heldBy_[indexOf(master.node, master.component)];
    return std::abs(master.factor) < negligible || (by != nobody && areSame(by, motion));
  });
}

void Holders::carry(const MeshTie& tie) {
  for (fem::Tie& one :
       fem::tieInterface(mesh_, fem::nodeSet(mesh_, tie.nodes), fem::faceSet(mesh_, tie.faces), tie.tolerance)) {
    const std::size_t index = indexOf(one.node, one.component);
    if (const int by = heldBy_[index]; by != nobody) {
      if (masterGoesAlong(one, by)) continue;
      const Motion& support = motions_[static_cast<std::size_t>(by)];
      throw InputError(placeOf(one.node, one.component) + " is " + support.text + " by " + support.name +
                           ", and tied to nodes of " + quoted(tie.faces) + " that are not",
                       "",
                       "let the support hold those nodes too, or leave the node out of " + quoted(tie.nodes) +
                           " or of the support's set");
    }
    if (carriedBy_[index])
      throw InputError(
          placeOf(one.node, one.component) + " is in two ties", "",
          "leave the node out of one of the sets " + quoted(carriedBy_[index]->nodes) + " and " + quoted(tie.nodes));
    carriedBy_[index] = &tie;
    for (const fem::Tie::Master& master : one.masters) masterOf_[indexOf(master.node, master.component)] = &tie;
    model_.constraints.ties.push_back(std::move(one));
  }
  for (std::size_t index = 0; index < carriedBy_.size(); ++index)
    if (carriedBy_[index] && masterOf_[index])
      throw InputError(
          placeOf(static_cast<int>(index / 3), static_cast<int>(index % 3)) + " is tied by " +
              quoted(carriedBy_[index]->nodes) + ", and nodes of " + quoted(masterOf_[index]->nodes) +
              " are tied to it",
          "", "let both ties have the same faces, or leave the node out of " + quoted(carriedBy_[index]->nodes));
}

}  // namespace dovetail::scene
