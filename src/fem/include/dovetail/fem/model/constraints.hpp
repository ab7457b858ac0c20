// Held, prescribed and tied components: every displacement as a linear function of the free ones.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/model/nodes.hpp"
#include "dovetail/fem/model/time_functions.hpp"

namespace dovetail::fem {

/// u_dof = Σ factor_k u_(3 node_k + component_k) + offset + motion(t).
struct Tie {
  struct Master {
    int node, component;
    double factor;
  };
  int node, component;
  std::vector<Master> masters;
  double offset = 0.0;  ///< m
  TimeFunction motion;  ///< m; empty = none
};

/// The list of constraints of a model. Masters of ties may be free, held or prescribed, but not tied themselves.
struct Constraints {
  struct Prescribed {
    int node, component;
    TimeFunction displacement;  ///< m; empty = held at 0
  };
  std::vector<Prescribed> prescribed;
  std::vector<Tie> ties;

  /// u = 0 for the components (bits as in fix()). Holding a component again changes nothing.
  /// @throws InputError for an empty set or components outside 1…7
  void hold(std::span<const int> nodes, unsigned components = allComponents);
  /// u_component = displacement(t).
  /// @throws InputError for an empty set, a component outside 0…2 or an empty function
  void prescribe(std::span<const int> nodes, int component, const TimeFunction& displacement);
  bool empty() const { return prescribed.empty() && ties.empty(); }
};

/// What moves a component: the balance of forces; its velocity in Nodes::v (fixed); a support that rests or follows a
/// function of time; the masters of its tie.
enum class Role : std::uint8_t { free, fixed, held, prescribed, tied };

/// Constraints of a model, sorted out: u = T q + g(t) with q the free components. Velocities and virtual displacements
/// follow T; forces go back by Tᵀ, so constraints that rest do no work.
class DofMap {
public:
  /// Components held in nodes.fixed are free of q too (their displacement is what nodes.u says).
  /// @throws InputError naming node and component that is constrained twice (holding what is held, or fixed at rest
  ///         without displacement, is no fault), a master that is tied itself, a number out of range
  DofMap(const Constraints& constraints, const Nodes& nodes);

  std::size_t size() const { return freeDofs_.size(); }  ///< entries of q
  std::size_t nodes() const { return nodes_; }
  bool hasTies() const { return !ties_.empty(); }
  /// Whether anything is a function of time.
  bool hasMotion() const;
  /// Entry of q that is component dof % 3 of node dof / 3, −1 if it is not free.
  std::span<const int> freeRow() const { return freeRow_; }
  /// Of component dof % 3 of node dof / 3.
  Role role(std::size_t dof) const { return roles_[dof]; }
  /// Nodes with a component that is not free, ascending.
  std::span<const int> boundNodes() const { return boundNodes_; }
  /// Its inverse.
  std::span<const int> freeDofs() const { return freeDofs_; }
  /// With the free masters only: those at rest or prescribed have no entry of q.
  std::span<const Tie> ties() const { return ties_; }

  /// r = Tᵀ f.
  void reduce(std::span<const Vec3> f, std::span<double> r) const;
  /// u += T dq.
  void addIncrement(std::span<const double> dq, std::span<Vec3> u) const;
  /// Sets prescribed and tied components of u at time t; free ones and those of nodes.fixed are read.
  void apply(double t, std::span<Vec3> u) const;
  /// Sets the same components of a velocity; motions by the central difference of their function over dt (0 if dt is
  /// 0).
  void applyVelocity(double t, double dt, std::span<Vec3> v) const;
  /// Sets the same components of an acceleration, m/s²; motions by the second central difference over dt > 0.
  void applyAcceleration(double t, double dt, std::span<Vec3> a) const;
  /// Forces of supports and of ties from those of all constraints together, r = M a − f: a tie passes what it does to
  /// its node on to its masters, and where these are held or moved, their supports bear it.
  /// @param r  N; becomes the forces of supports, 0 at components without
  /// @return forces of ties on the nodes that they carry, N
  std::vector<Vec3> splitReactions(std::span<Vec3> r) const;

private:
  struct RestingMaster {
    std::size_t tie;
    Tie::Master master;
  };
  std::size_t dofOf(int node, int component) const;
  void claim(const Nodes& nodes, int node, int component, Role role);
  void sortMasters();
  template <class Motion>
  void setConstrained(std::span<Vec3> field, bool withOffsets, const Motion& motion) const;

  std::size_t nodes_;
  std::vector<Role> roles_;
  std::vector<int> freeRow_, freeDofs_, boundNodes_;
  std::vector<Constraints::Prescribed> prescribed_;
  std::vector<Tie> ties_;
  std::vector<RestingMaster> restingMasters_;
};

}  // namespace dovetail::fem
