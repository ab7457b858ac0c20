#include "dovetail/arlequin/critical_step.hpp"

#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/fem/motion/largest_eigenvalue.hpp"
#include "dovetail/fem/solve/block_matrix.hpp"
#include "forces.hpp"

namespace dovetail::arlequin {

namespace {

/// Values at all particles and nodes.
struct Field {
  std::vector<Vec3> particles, nodes;
};

struct Parts {
  bool particles, solid;
};

class Operator {
public:
  Operator(Model& model, Parts parts) : model_(model), parts_(parts) {
    if (parts.solid) {
      fem::Model& solid = model.solid->model();
      tangent_ = fem::zeroTangent(solid);
      for (const auto& term : solid.terms) term->addTangent(solid.nodes, {solid.t, 0.0}, tangent_);
    }
    if (parts.particles) model.discrete.laws->addDemand(demand_, model.discrete.particles, model.discrete.pairs, touch);
    held_.assign(model.discrete.particles.size(), false);
    for (const auto* drive : model.discrete.terms.all<dem::DriveTerm>())
      for (const std::int64_t id : drive->ids())
        held_[static_cast<std::size_t>(dem::find(model.discrete.particles, id))] = true;
  }

  std::size_t size() const {
    return 3 * ((parts_.particles ? model_.discrete.particles.size() : 0) +
                (parts_.solid ? model_.solid->nodes().X.size() : 0));
  }

  Field stiffness(const Field& q) const {
    Field force{std::vector<Vec3>(q.particles.size()), std::vector<Vec3>(q.nodes.size())};
    if (parts_.particles) addContacts(q, force);
    if (parts_.solid) addElements(q, force);
    if (parts_.particles && parts_.solid && model_.coupling) addCoupling(q, force);
    return force;
  }
  Field mass(const Field& q) const {
    Field p = q;
    for (std::size_t i = 0; i < p.particles.size(); ++i) p.particles[i] *= model_.discrete.particles.mass[i];
    if (!parts_.solid) return p;
    model_.solid->motion().mass().multiply(q.nodes, p.nodes);
    return p;
  }
  Field inverseMass(Field f) const {
    for (std::size_t i = 0; i < f.particles.size(); ++i) f.particles[i] *= 1.0 / model_.discrete.particles.mass[i];
    if (parts_.solid) model_.solid->motion().accelerate(f.nodes);
    return f;
  }

  /// y = f(x) for the components that are not held; the others are zero on both sides.
  template <class Function>
  auto ofFree(const Function& f) const {
    return [this, f](std::span<const double> x, std::span<double> y) {
      Field q;
      if (parts_.particles) q.particles.resize(model_.discrete.particles.size());
      if (parts_.solid) q.nodes.resize(model_.solid->nodes().X.size());
      std::size_t k = 0;
      for (auto* values : {&q.particles, &q.nodes})
        for (Vec3& v : *values)
          for (int c = 0; c < 3; ++c) v[c] = x[k++];
      hold(q);
      q = f(q);
      hold(q);
      k = 0;
      for (const auto* values : {&q.particles, &q.nodes})
        for (const Vec3& v : *values)
          for (int c = 0; c < 3; ++c) y[k++] = v[c];
    };
  }

private:
  void hold(Field& field) const {
    for (std::size_t i = 0; i < field.particles.size(); ++i)
      if (held_[i]) field.particles[i] = {};
    for (std::size_t n = 0; n < field.nodes.size(); ++n)
      for (int c = 0; c < 3; ++c)
        if (model_.solid->nodes().fixed[n] >> c & 1) field.nodes[n][c] = 0.0;
  }

  void addContacts(const Field& q, Field& force) const {
    const auto& x = model_.discrete.particles.x;
    for (const auto& link : demand_.links) {
      const auto i = static_cast<std::size_t>(link.particle), j = static_cast<std::size_t>(link.partner);
      const Vec3 n = normalized(model_.discrete.pairs.periodicity().minimumImage(x[i] - x[j]));
      const Vec3 f = link.stiffness * dot(n, q.particles[i] - q.particles[j]) * n;
      force.particles[i] += f;
      force.particles[j] -= f;
    }
  }

  void addElements(const Field& q, Field& force) const { tangent_.multiply(q.nodes, force.nodes); }

  void addCoupling(const Field& q, Field& force) const {
    const Coupling& c = *model_.coupling;
    std::vector<Vec3> gap(c.rows()), lambda(c.rows());
    gapOf(c.gap, c.overlap, q.particles, q.nodes, gap);
    c.constraint->applyStiffness(gap, lambda);
    for (Vec3& value : lambda) value = -value;
    pullParticles(c.gap, c.overlap, lambda, force.particles);
    pullNodes(c.gap, lambda, force.nodes);
  }

  Model& model_;
  Parts parts_;
  fem::BlockMatrix tangent_;
  static constexpr double touch = 1e-300;  // m: all pairs of the list count, those apart as if they just touched
  dem::ContactDemand demand_;
  std::vector<bool> held_;
};

/// 2/ω of the largest eigenvalue.
double limitOf(Model& model, Parts parts) {
  constexpr double accuracy = 1e-4;
  const Operator A(model, parts);
  return 2.0 / std::sqrt(fem::largestEigenvalue({A.size(), A.ofFree([&](const Field& q) { return A.stiffness(q); }),
                                                 A.ofFree([&](const Field& q) { return A.mass(q); }),
                                                 A.ofFree([&](const Field& q) { return A.inverseMass(q); })},
                                                accuracy));
}

}  // namespace

CriticalStep criticalStep(Model& model) {
  constexpr double none = std::numeric_limits<double>::infinity();
  CriticalStep limit{none, none, none};
  if (!model.discrete.pairs.pairs().empty()) limit.particles = limitOf(model, {true, false});
  if (model.solid) limit.solid = limitOf(model, {false, true});
  limit.together = model.solid ? limitOf(model, {true, true}) : limit.particles;
  return limit;
}

}  // namespace dovetail::arlequin
