#include "dovetail/fem/model/constraints.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"

namespace dovetail::fem {

namespace {

constexpr std::size_t dofChunk = 16384;

std::string label(int node, int component) {
  return std::string("component ") + "xyz"[component] + " of node " + std::to_string(node);
}

void requireSet(std::span<const int> nodes, const char* where) {
  if (nodes.empty()) throw InputError("the node set is empty", where, "give at least one node");
}

}  // namespace

void Constraints::hold(std::span<const int> nodes, unsigned components) {
  requireSet(nodes, "Constraints::hold");
  if (components < 1 || components > allComponents)
    throw InputError("there are no components " + std::to_string(components), "Constraints::hold",
                     "give bits 1 (x), 2 (y), 4 (z)");
  for (const int node : nodes)
    for (int c = 0; c < 3; ++c)
      if (components >> c & 1u) prescribed.push_back({node, c, {}});
}

void Constraints::prescribe(std::span<const int> nodes, int component, const TimeFunction& displacement) {
  requireSet(nodes, "Constraints::prescribe");
  if (component < 0 || component > 2)
    throw InputError("there is no component " + std::to_string(component), "Constraints::prescribe",
                     "give 0 (x), 1 (y) or 2 (z)");
  if (!displacement) throw InputError("there is no function", "Constraints::prescribe", "give one, or call hold");
  for (const int node : nodes) prescribed.push_back({node, component, displacement});
}

std::size_t DofMap::dofOf(int node, int component) const {
  if (node < 0 || static_cast<std::size_t>(node) >= nodes_)
    throw InputError("node " + std::to_string(node) + " does not exist", "constraints",
                     "use 0 to " + std::to_string(nodes_ - 1));
  if (component < 0 || component > 2)
    throw InputError("there is no component " + std::to_string(component) + " of node " + std::to_string(node),
                     "constraints", "give 0 (x), 1 (y) or 2 (z)");
  return 3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(component);
}

void DofMap::claim(const Nodes& nodes, int node, int component, Role role) {
  constexpr std::array what = {"free", "fixed", "held", "prescribed", "tied"};
  Role& present = roles_[dofOf(node, component)];
  const auto n = static_cast<std::size_t>(node);
  const bool rests =
      present == Role::held || (present == Role::fixed && nodes.u[n][component] == 0.0 && nodes.v[n][component] == 0.0);
  if (present != Role::free && !(rests && role == Role::held))
    throw InputError(label(node, component) + " is constrained twice: " + what[static_cast<std::size_t>(present)] +
                         " and " + what[static_cast<std::size_t>(role)],
                     "constraints", "take one of the two away");
  present = role;
}

/// Keeps the free masters in the ties and puts the others aside.
void DofMap::sortMasters() {
  for (std::size_t i = 0; i < ties_.size(); ++i) {
    std::vector<Tie::Master> freeOnes;
    for (const Tie::Master& master : ties_[i].masters) {
      const Role role = roles_[dofOf(master.node, master.component)];
      if (role == Role::tied)
        throw InputError(label(master.node, master.component) + " is tied and a master of " +
                             label(ties_[i].node, ties_[i].component),
                         "constraints", "tie both to the same masters");
      if (!std::isfinite(master.factor))
        throw InputError("a factor of the tie is not finite", label(ties_[i].node, ties_[i].component),
                         "give a number");
      if (role == Role::free)
        freeOnes.push_back(master);
      else
        restingMasters_.push_back({i, master});
    }
    ties_[i].masters = std::move(freeOnes);
  }
}

DofMap::DofMap(const Constraints& constraints, const Nodes& nodes)
    : nodes_(nodes.u.size()),
      roles_(3 * nodes_, Role::free),
      prescribed_(constraints.prescribed),
      ties_(constraints.ties) {
  for (std::size_t dof = 0; dof < roles_.size(); ++dof)
    if (nodes.fixed[dof / 3] >> dof % 3 & 1) roles_[dof] = Role::fixed;
  for (const Constraints::Prescribed& p : prescribed_)
    claim(nodes, p.node, p.component, p.displacement ? Role::prescribed : Role::held);
  for (const Tie& tie : ties_) claim(nodes, tie.node, tie.component, Role::tied);
  sortMasters();
  freeRow_.assign(roles_.size(), -1);
  for (std::size_t dof = 0; dof < roles_.size(); ++dof)
    if (roles_[dof] == Role::free) {
      freeRow_[dof] = static_cast<int>(freeDofs_.size());
      freeDofs_.push_back(static_cast<int>(dof));
    } else if (const int node = static_cast<int>(dof / 3); boundNodes_.empty() || boundNodes_.back() != node) {
      boundNodes_.push_back(node);
    }
}

std::vector<Vec3> DofMap::splitReactions(std::span<Vec3> r) const {
  std::vector<Vec3> ties(r.size());
  for (const Tie& tie : ties_)
    ties[static_cast<std::size_t>(tie.node)][tie.component] = r[static_cast<std::size_t>(tie.node)][tie.component];
  for (const auto& [tie, master] : restingMasters_) {
    const Tie& from = ties_[tie];
    r[static_cast<std::size_t>(master.node)][master.component] +=
        master.factor * ties[static_cast<std::size_t>(from.node)][from.component];
  }
  for (std::size_t dof = 0; dof < roles_.size(); ++dof)
    if (roles_[dof] == Role::free || roles_[dof] == Role::tied) r[dof / 3][static_cast<int>(dof % 3)] = 0.0;
  return ties;
}

bool DofMap::hasMotion() const {
  return std::ranges::any_of(prescribed_, [](const auto& p) { return static_cast<bool>(p.displacement); }) ||
         std::ranges::any_of(ties_, [](const Tie& tie) { return static_cast<bool>(tie.motion); });
}

void DofMap::reduce(std::span<const Vec3> f, std::span<double> r) const {
  parallelFor(size(), dofChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) r[i] = f[static_cast<std::size_t>(freeDofs_[i] / 3)][freeDofs_[i] % 3];
  });
  for (const Tie& tie : ties_) {
    const double force = f[static_cast<std::size_t>(tie.node)][tie.component];
    for (const Tie::Master& m : tie.masters)
      r[static_cast<std::size_t>(freeRow_[static_cast<std::size_t>(3 * m.node + m.component)])] += m.factor * force;
  }
}

void DofMap::addIncrement(std::span<const double> dq, std::span<Vec3> u) const {
  parallelFor(size(), dofChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) u[static_cast<std::size_t>(freeDofs_[i] / 3)][freeDofs_[i] % 3] += dq[i];
  });
  for (const Tie& tie : ties_) {
    double sum = 0.0;
    for (const Tie::Master& m : tie.masters)
      sum += m.factor * dq[static_cast<std::size_t>(freeRow_[static_cast<std::size_t>(3 * m.node + m.component)])];
    u[static_cast<std::size_t>(tie.node)][tie.component] += sum;
  }
}

/// @param motion  of a function that is not empty
template <class Motion>
void DofMap::setConstrained(std::span<Vec3> field, bool withOffsets, const Motion& motion) const {
  for (const Constraints::Prescribed& p : prescribed_)
    field[static_cast<std::size_t>(p.node)][p.component] = p.displacement ? motion(p.displacement) : 0.0;
  std::size_t resting = 0;
  for (std::size_t i = 0; i < ties_.size(); ++i) {
    const Tie& tie = ties_[i];
    double value = (withOffsets ? tie.offset : 0.0) + (tie.motion ? motion(tie.motion) : 0.0);
    const auto add = [&](const Tie::Master& m) {
      value += m.factor * field[static_cast<std::size_t>(m.node)][m.component];
    };
    for (const Tie::Master& m : tie.masters) add(m);
    for (; resting < restingMasters_.size() && restingMasters_[resting].tie == i; ++resting)
      add(restingMasters_[resting].master);
    field[static_cast<std::size_t>(tie.node)][tie.component] = value;
  }
}

void DofMap::apply(double t, std::span<Vec3> u) const {
  setConstrained(u, true, [t](const TimeFunction& motion) { return motion(t); });
}

void DofMap::applyVelocity(double t, double dt, std::span<Vec3> v) const {
  setConstrained(v, false, [=](const TimeFunction& motion) {
    return dt > 0.0 ? (motion(t + 0.5 * dt) - motion(t - 0.5 * dt)) / dt : 0.0;
  });
}

void DofMap::applyAcceleration(double t, double dt, std::span<Vec3> a) const {
  setConstrained(a, false, [=](const TimeFunction& motion) {
    return (motion(t + dt) - 2.0 * motion(t) + motion(t - dt)) / (dt * dt);
  });
}

}  // namespace dovetail::fem
