// Held, prescribed and tied components: every displacement as a linear function of the free ones.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/nodes.hpp"

namespace dovetail::fem {

/// A number as a function of time, s.
using TimeFunction = std::function<double(double)>;

/// u_dof = Σ factor_k u_(3 node_k + component_k) + offset.
struct Tie {
  struct Master {
    int node, component;
    double factor;
  };
  int node, component;
  std::vector<Master> masters;
  double offset = 0.0;  ///< m
};

/// The list of constraints of a model. Masters of ties must be free themselves.
struct Constraints {
  struct Prescribed {
    int node, component;
    TimeFunction displacement;  ///< m
  };
  std::vector<Prescribed> prescribed;
  std::vector<Tie> ties;

  /// u = 0 for the components (bits as in fix()).
  void hold(std::span<const int> nodes, unsigned components = allComponents);
  /// u_component = displacement(t).
  void prescribe(std::span<const int> nodes, int component, const TimeFunction& displacement);
  bool empty() const { return prescribed.empty() && ties.empty(); }
};

/// Constraints of a model, sorted out: u = T q + g(t) with q the free components. Velocities and virtual displacements
/// follow T; forces go back by Tᵀ, so constraints that rest do no work.
class DofMap {
public:
  /// Components held in nodes.fixed are free of q too (their displacement is what nodes.u says).
  /// @throws InputError naming node and component that is constrained twice, a master that is not free, a number out of
  ///         range
  DofMap(const Constraints& constraints, const Nodes& nodes);

  std::size_t size() const { return freeDofs_.size(); }  ///< entries of q
  std::size_t nodes() const { return nodes_; }
  bool hasTies() const { return !ties_.empty(); }
  /// Entry of q that is component dof % 3 of node dof / 3, −1 if it is not free.
  std::span<const int> freeRow() const { return freeRow_; }
  /// Its inverse.
  std::span<const int> freeDofs() const { return freeDofs_; }
  std::span<const Tie> ties() const { return ties_; }

  /// r = Tᵀ f.
  void reduce(std::span<const Vec3> f, std::span<double> r) const;
  /// u += T dq.
  void addIncrement(std::span<const double> dq, std::span<Vec3> u) const;
  /// Sets prescribed and tied components of u at time t; free ones are read.
  void apply(double t, std::span<Vec3> u) const;
  /// Sets the same components of a velocity; prescribed ones by the central difference of their function over dt.
  void applyVelocity(double t, double dt, std::span<Vec3> v) const;

private:
  std::size_t nodes_;
  std::vector<int> freeRow_, freeDofs_;
  std::vector<Constraints::Prescribed> prescribed_;
  std::vector<Tie> ties_;
};

}  // namespace dovetail::fem
