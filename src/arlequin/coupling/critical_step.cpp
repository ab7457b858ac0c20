#include "dovetail/arlequin/critical_step.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "dovetail/dem/model/loads.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "dovetail/linalg/largest_eigenvalue.hpp"

namespace dovetail::arlequin {

namespace {

/// Values at all particles and nodes.
struct Field {
  std::vector<Vec3> particles, nodes;
};

struct Parts {
  bool particles, solid;
};

struct Scene {
  dem::Model& grains;
  fem::Model* solid;
  const fem::ModelMass* mass;
  ArlequinCoupling* tie;
};

class Operator {
public:
  Operator(const Scene& scene, Parts parts) : scene_(scene), grains_(scene.grains), parts_(parts) {
    if (parts.solid) {
      fem::Model& solid = *scene.solid;
      tangent_ = fem::zeroTangent(solid);
      fem::addTangents(solid, {solid.t, 0.0}, tangent_);
    }
    const dem::Particles& p = grains_.particles;
    if (parts.particles) grains_.laws->addDemand(demand_, p, grains_.pairs, touch);
    held_.assign(p.size(), false);
    for (const auto* drive : grains_.terms.all<dem::DriveTerm>())
      for (const std::int64_t id : drive->ids()) held_[static_cast<std::size_t>(dem::find(p, id))] = true;
  }

  std::size_t size() const {
    return 3 * ((parts_.particles ? grains_.particles.size() : 0) + (parts_.solid ? scene_.solid->nodes.X.size() : 0));
  }

  Field stiffness(const Field& q) const {
    Field force{std::vector<Vec3>(q.particles.size()), std::vector<Vec3>(q.nodes.size())};
    if (parts_.particles) addContacts(q, force);
    if (parts_.solid) addElements(q, force);
    if (parts_.particles && parts_.solid && scene_.tie)
      scene_.tie->addStiffness(grains_, q.particles, q.nodes, force.particles, force.nodes);
    return force;
  }
  Field mass(const Field& q) const {
    Field p = q;
    for (std::size_t i = 0; i < p.particles.size(); ++i) p.particles[i] *= mass(i);
    if (!parts_.solid) return p;
    scene_.mass->multiply(q.nodes, p.nodes);
    return p;
  }
  Field inverseMass(Field f) const {
    for (std::size_t i = 0; i < f.particles.size(); ++i) f.particles[i] *= 1.0 / mass(i);
    if (parts_.solid) scene_.mass->solve(f.nodes);
    return f;
  }

  /// y = f(x) for the components that are not held; the others are zero on both sides.
  template <class Function>
  auto ofFree(const Function& f) const {
    return [this, f](std::span<const double> x, std::span<double> y) {
      Field q;
      if (parts_.particles) q.particles.resize(grains_.particles.size());
      if (parts_.solid) q.nodes.resize(scene_.solid->nodes.X.size());
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
        if (scene_.solid->nodes.fixed[n] >> c & 1) field.nodes[n][c] = 0.0;
  }

  void addContacts(const Field& q, Field& force) const {
    const auto& x = grains_.particles.x;
    for (const auto& link : demand_.links) {
      const auto i = static_cast<std::size_t>(link.particle), j = static_cast<std::size_t>(link.partner);
      const Vec3 n = normalized(grains_.pairs.periodicity().minimumImage(x[i] - x[j]));
      const Vec3 f = link.stiffness * dot(n, q.particles[i] - q.particles[j]) * n;
      force.particles[i] += f;
      force.particles[j] -= f;
    }
  }

  void addElements(const Field& q, Field& force) const { tangent_.multiply(q.nodes, force.nodes); }

  double mass(std::size_t i) const { return grains_.particles.weightOf(i) * grains_.particles.mass[i]; }

  Scene scene_;
  dem::Model& grains_;
  Parts parts_;
  linalg::BlockMatrix tangent_;
  static constexpr double touch = 1e-300;  // m: all pairs of the list count, those apart as if they just touched
  dem::ContactDemand demand_;
  std::vector<bool> held_;
};

/// 2/ω of the largest eigenvalue.
double limitOf(const Scene& scene, Parts parts) {
  constexpr double accuracy = 1e-4;
  const Operator A(scene, parts);
  return 2.0 / std::sqrt(linalg::largestEigenvalue({A.size(), A.ofFree([&](const Field& q) { return A.stiffness(q); }),
                                                    A.ofFree([&](const Field& q) { return A.mass(q); }),
                                                    A.ofFree([&](const Field& q) { return A.inverseMass(q); })},
                                                   accuracy));
}

}  // namespace

CriticalStep criticalStep(dem::Model& grains, coupling::SolidSide* side, double massFraction, ArlequinCoupling* tie) {
  constexpr double none = std::numeric_limits<double>::infinity();
  CriticalStep limit{none, none, none};
  std::optional<fem::Motion> motion;
  if (side) motion.emplace(*side->model, massFraction);
  if (tie) tie->neighbourListUpdated(grains);
  const Scene scene{grains, side ? side->model : nullptr, side ? &motion->mass() : nullptr, tie};
  if (!grains.pairs.pairs().empty()) limit.particles = limitOf(scene, {true, false});
  if (side) limit.solid = limitOf(scene, {false, true});
  limit.together = side ? limitOf(scene, {true, true}) : limit.particles;
  return limit;
}

}  // namespace dovetail::arlequin
