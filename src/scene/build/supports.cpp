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

Holders::Holders(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid, const Scene& scene, StepOf step)
    : model_(model),
      mesh_(mesh),
      solid_(solid),
      scene_(scene),
      step_(std::move(step)),
      heldBy_(3 * mesh.X.size(), nobody),
      carriedBy_(3 * mesh.X.size(), nullptr),
      masterOf_(3 * mesh.X.size(), nullptr) {}

std::string Holders::placeOf(int node, int component) const {
  const Vec3& X = mesh_.X[static_cast<std::size_t>(node)];
  const std::string axis(1, "xyz"[component]);
  return "component " + axis + " of the node at (" + rounded(X.x) + ", " + rounded(X.y) + ", " + rounded(X.z) + ") m";
}

namespace {

/// ((R − 1) r) along an axis for the turn of a support, which leaves that along its own axis alone.
std::function<double(const Vec3&, double)> turnOf(const Support& support, int component, const Scene& scene) {
  if (!support.point)
    throw InputError("the turn has no point on its axis", "", "give the support a \"point\", such as [0, 0, 0]");
  if (norm(support.turn->axis) == 0.0)
    throw InputError("the axis of the turn has no length", "", "give it a direction, such as [0, 0, 1]");
  const Vec3 axis = normalized(support.turn->axis);
  if (std::abs(axis[component]) == 1.0) return {};
  return [=, angle = travelOf(support.turn->angle, scene).displacement](const Vec3& r, double t) {
    const double phi = angle(t);
    const Vec3 turned = std::sin(phi) * cross(axis, r) + (1.0 - std::cos(phi)) * cross(axis, cross(axis, r));
    return turned[component];
  };
}

}  // namespace

const Vec3& Holders::startOf(const Motion& motion, int node) const {
  return (motion.from ? *motion.from : model_.nodes.u)[static_cast<std::size_t>(node)];
}

double Holders::at(const Motion& motion, int node, double t) const {
  return motion.field ? motion.field(mesh_.X[static_cast<std::size_t>(node)], startOf(motion, node), t)
                      : motion.displacement(t);
}

namespace {

/// Counted from a later time on.
template <class... Place>
void begin(std::function<double(Place...)>& function, double since);
template <>
void begin(TimeFunction& function, double since) {
  if (function && since > 0.0)
    function = [of = std::move(function), since](double t) { return of(std::max(0.0, t - since)); };
}
template <>
void begin(std::function<double(const Vec3&, const Vec3&, double)>& function, double since) {
  if (function && since > 0.0)
    function = [of = std::move(function), since](const Vec3& X, const Vec3& u, double t) {
      return of(X, u, std::max(0.0, t - since));
    };
}

}  // namespace

Holders::Motion Holders::motionOf(const SupportNow& held, int component) const {
  const Support& support = held.support;
  const auto c = static_cast<std::size_t>(component);
  Motion motion{.name = held.name, .since = held.since, .from = held.from.get()};
  const TimeValue& velocity = support.velocity[c];
  PlaceFunction displaced;
  if (support.displacement) {
    const TimeValue& displacement = (*support.displacement)[c];
    motion.steady = isConstant(displacement) && displacement.number == 0.0;
    motion.text = "moved by " + textOf(displacement);
    if (usesPlace(displacement))
      displaced = fieldOf(displacement, scene_);
    else
      motion.displacement = travelOf(displacement, scene_, step_).displacement;
  } else {
    motion.steady = isConstant(velocity);
    motion.velocity = motion.steady ? velocity.number : 0.0;
    motion.text = "moved with the velocity " + textOf(velocity);
    motion.displacement = travelAt(velocity, scene_, step_).displacement;
  }
  std::function<double(const Vec3&, double)> turned;
  if (support.turn) turned = turnOf(support, component, scene_);
  if (motion.steady && motion.velocity == 0.0 && !turned) motion.text = "held";
  if (turned) {
    const Vec3& axis = support.turn->axis;
    motion.text += ", turned by " + textOf(support.turn->angle) + " about [" + rounded(axis.x) + ", " +
                   rounded(axis.y) + ", " + rounded(axis.z) + "] through (" + rounded(support.point->x) + ", " +
                   rounded(support.point->y) + ", " + rounded(support.point->z) + ") m";
    motion.steady = false;
  }
  if (!displaced && !turned) {
    begin(motion.displacement, held.since);
    return motion;
  }
  motion.field = [=, point = support.point.value_or(Vec3{}), path = motion.displacement](const Vec3& X, const Vec3& u,
                                                                                         double t) {
    return (displaced ? displaced(X, t) : path(t)) + (turned ? turned(X + u - point, t) : 0.0);
  };
  begin(motion.field, held.since);
  return motion;
}

bool Holders::areSame(int first, int second, int node) {
  if (first == second) return true;
  const Motion &a = motions_[static_cast<std::size_t>(first)], &b = motions_[static_cast<std::size_t>(second)];
  if (a.field || b.field) return areAlike(a, b, node);
  const std::pair key{std::min(first, second), std::max(first, second)};
  if (const auto known = same_.find(key); known != same_.end()) return known->second;
  return same_[key] = areAlike(a, b, node);
}

/// At times that no period of a function is likely to share.
bool Holders::areAlike(const Motion& a, const Motion& b, int node) const {
  const auto rests = [](const Motion& one) { return one.steady && one.velocity == 0.0; };
  if (rests(a) && rests(b)) return true;
  if (a.since != b.since) return false;
  double largest = 0.0, apart = 0.0;
  constexpr int samples = 199;
  for (int k = 0; k <= samples && a.text != b.text; ++k) {
    const double t = durationOf(scene_) * std::pow(static_cast<double>(k) / samples, 1.37);
    const double p = at(a, node, t), q = at(b, node, t);
    largest = std::max({largest, std::abs(p), std::abs(q)});
    apart = std::max(apart, std::abs(p - q));
  }
  return apart <= 1e-9 * largest;
}

void Holders::lookForJump(const std::vector<int>& set, const Motion& motion, int component) {
  double jump = 0.0;
  for (const int node : set)
    if (const double own = at(motion, node, motion.since); std::abs(own) > std::abs(jump)) jump = own;
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
    } else if (!areSame(by, number, node)) {
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
  // Velocities mean nothing to load steps.
  if (!own.steady || (own.velocity != 0.0 && hasStatics(scene_))) return prescribe(fresh, component, own);
  fem::fix(model_.nodes, fresh, 1U << component);
  for (const int node : fresh) model_.nodes.v[static_cast<std::size_t>(node)][component] = own.velocity;
}

/// From where the nodes are: those of a state need not be where they are described.
void Holders::prescribe(const std::vector<int>& nodes, int component, const Motion& motion) {
  if (motion.field)
    for (const int node : nodes) {
      const auto n = static_cast<std::size_t>(node);
      const Vec3 X = mesh_.X[n], u = startOf(motion, node);
      model_.constraints.prescribe(std::array{node}, component,
                                   [=, field = motion.field](double t) { return u[component] + field(X, u, t); });
    }
  if (motion.field) return;
  const TimeFunction& displacement = motion.displacement;
  std::map<double, std::vector<int>> byStart;
  for (const int node : nodes) byStart[startOf(motion, node)[component]].push_back(node);
  for (const auto& [start, those] : byStart)
    if (start == 0.0)
      model_.constraints.prescribe(those, component, displacement);
    else
      model_.constraints.prescribe(those, component, [=, start = start](double t) { return start + displacement(t); });
}

void Holders::hold(const SupportNow& held) {
  const Support& support = held.support;
  const std::vector<int>& set = fem::nodeSet(mesh_, support.on);
  if (support.displacement && (!isConstant(support.velocity) || norm(constantOf(support.velocity)) > 0.0))
    throw InputError("both a velocity and a displacement are given", "", "leave one of them out");
  if (support.point && !support.turn)
    throw InputError("the support has a point and no turn about it", "", "give it a \"turn\", or leave point out");
  const std::array<bool, 3> components{support.x, support.y, support.z};
  if (std::ranges::count(components, true) == 0)
    throw InputError("components is empty, and the support on " + quoted(support.on) + " holds nothing", "",
                     "name components, such as [\"x\"], or leave the key out to hold all");
  for (int c = 0; c < 3; ++c) {
    if (!components[static_cast<std::size_t>(c)]) continue;
    Motion motion = motionOf(held, c);
    if (!motion.steady) lookForJump(set, motion, c);
    claim(set, c, std::move(motion));
  }
}

bool Holders::masterGoesAlong(const fem::Tie& tie, int motion) {
  return std::ranges::all_of(tie.masters, [&](const fem::Tie::Master& master) {
    const int by = heldBy_[indexOf(master.node, master.component)];
    return std::abs(master.factor) < negligible || (by != nobody && areSame(by, motion, master.node));
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

std::vector<std::string> putHolders(fem::Model& model, const fem::SolidMesh& mesh, const Solid& solid,
                                    const Scene& scene, const StepOf& step, const std::vector<SupportNow>& supports) {
  model.constraints = {};
  std::ranges::fill(model.nodes.fixed, fem::dimensionOf(mesh) == 2 ? unsigned{fem::componentZ} : 0U);
  Holders holders(model, mesh, solid, scene, step);
  for (const SupportNow& one : supports) atPlace(one.support.where, [&] { holders.hold(one); });
  for (const MeshTie& tie : solid.ties) atPlace(tie.where, [&] { holders.carry(tie); });
  return holders.jumps();
}

std::vector<SupportNow> supportsOf(const Solid& solid) {
  std::vector<SupportNow> all;
  for (std::size_t k = 0; k < solid.supports.size(); ++k)
    all.push_back({solid.supports[k], "supports item " + std::to_string(k) + " on " + quoted(solid.supports[k].on)});
  return all;
}

}  // namespace dovetail::scene
