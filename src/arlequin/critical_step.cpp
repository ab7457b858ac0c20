#include "dovetail/arlequin/critical_step.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/loads.hpp"
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
  Operator(const Model& model, Parts parts) : model_(model), parts_(parts) {
    if (parts.solid) {
      // The terms' caches change, not the state.
      fem::Model& solid = const_cast<Solid&>(*model.solid).model();
      tangent_ = fem::couplingPattern(solid);
      for (const auto& term : solid.terms) term->addTangent(solid.nodes, {solid.t, 0.0}, tangent_);
    }
    if (parts.particles) model.discrete.laws->addDemand(demand_, model.discrete.particles, model.discrete.pairs, touch);
    held_.assign(model.discrete.particles.size(), false);
    for (const auto* drive : model.discrete.terms.all<dem::DriveTerm>())
      for (const std::int64_t id : drive->ids())
        held_[static_cast<std::size_t>(dem::find(model.discrete.particles, id))] = true;
  }

  Field start() const {
    Field field;
    if (parts_.particles) field.particles.resize(model_.discrete.particles.size());
    if (parts_.solid) field.nodes.resize(model_.solid->nodes().X.size());
    double phase = 0.3;
    for (auto* values : {&field.particles, &field.nodes})
      for (Vec3& v : *values)
        for (int c = 0; c < 3; ++c) v[c] = std::sin(phase += 1.7 + 0.013 * std::fmod(phase, 11.0));
    hold(field);
    return field;
  }

  /// M⁻¹ K q
  Field operator()(const Field& q) const {
    Field force{std::vector<Vec3>(q.particles.size()), std::vector<Vec3>(q.nodes.size())};
    if (parts_.particles) addContacts(q, force);
    if (parts_.solid) addElements(q, force);
    if (parts_.particles && parts_.solid && model_.coupling) addCoupling(q, force);
    for (std::size_t i = 0; i < force.particles.size(); ++i) force.particles[i] *= 1.0 / model_.discrete.particles.mass[i];
    if (parts_.solid) model_.solid->motion().accelerate(force.nodes);
    hold(force);
    return force;
  }

  /// aᵀ M b
  double product(const Field& a, const Field& b) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.particles.size(); ++i)
      sum += model_.discrete.particles.mass[i] * dot(a.particles[i], b.particles[i]);
    if (!parts_.solid) return sum;
    std::vector<Vec3> Mb(b.nodes.size());
    model_.solid->motion().mass().multiply(b.nodes, Mb);
    for (std::size_t n = 0; n < Mb.size(); ++n) sum += dot(a.nodes[n], Mb[n]);
    return sum;
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

  void addElements(const Field& q, Field& force) const {
    tangent_.multiply(q.nodes, force.nodes);
  }

  void addCoupling(const Field& q, Field& force) const {
    const Coupling& c = *model_.coupling;
    std::vector<Vec3> gap(c.rows()), lambda(c.rows());
    gapOf(c.gap, c.overlap, q.particles, q.nodes, gap);
    c.constraint->applyStiffness(gap, lambda);
    for (Vec3& value : lambda) value = -value;
    pullParticles(c.gap, c.overlap, lambda, force.particles);
    pullNodes(c.gap, lambda, force.nodes);
  }

  const Model& model_;
  Parts parts_;
  fem::BlockMatrix tangent_;
  static constexpr double touch = 1e-300;  // m: all pairs of the list count, those apart as if they just touched
  dem::ContactDemand demand_;
  std::vector<bool> held_;
};

void addScaled(Field& a, double factor, const Field& b) {
  for (std::size_t i = 0; i < a.particles.size(); ++i) a.particles[i] += factor * b.particles[i];
  for (std::size_t n = 0; n < a.nodes.size(); ++n) a.nodes[n] += factor * b.nodes[n];
}

void scale(Field& a, double factor) {
  for (Vec3& v : a.particles) v *= factor;
  for (Vec3& v : a.nodes) v *= factor;
}

/// 2/ω of the largest eigenvalue by Lanczos iteration in the inner product of the mass.
double limitOf(const Model& model, Parts parts) {
  constexpr int mostSteps = 120;
  const Operator A(model, parts);
  Field q = A.start(), before;
  scale(q, 1.0 / std::sqrt(A.product(q, q)));
  std::vector<double> diagonal, offDiagonal;
  double bound = 0.0;
  for (int step = 0; step < mostSteps; ++step) {
    Field w = A(q);
    diagonal.push_back(A.product(w, q));
    addScaled(w, -diagonal.back(), q);
    if (!offDiagonal.empty()) addScaled(w, -offDiagonal.back(), before);
    const double beta = std::sqrt(std::max(0.0, A.product(w, w)));
    if (!std::isfinite(beta))
      throw NumericalError("the stiffness is not finite", "criticalStep", "check masses, weights and the penalty");
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
    ritz.computeFromTridiagonal(
        Eigen::Map<const Eigen::VectorXd>(diagonal.data(), static_cast<Eigen::Index>(diagonal.size())),
        Eigen::Map<const Eigen::VectorXd>(offDiagonal.data(), static_cast<Eigen::Index>(offDiagonal.size())));
    const Eigen::Index last = ritz.eigenvalues().size() - 1;
    const double theta = ritz.eigenvalues()[last], error = beta * std::abs(ritz.eigenvectors()(last, last));
    bound = theta + error;
    if (error <= 1e-4 * theta || beta <= 1e-14 * theta) break;
    offDiagonal.push_back(beta);
    before = std::move(q);
    scale(w, 1.0 / beta);
    q = std::move(w);
  }
  return 2.0 / std::sqrt(bound);
}

}  // namespace

CriticalStep criticalStep(const Model& model) {
  constexpr double none = std::numeric_limits<double>::infinity();
  CriticalStep limit{none, none, none};
  if (!model.discrete.pairs.pairs().empty()) limit.particles = limitOf(model, {true, false});
  if (model.solid) limit.solid = limitOf(model, {false, true});
  limit.together = model.solid ? limitOf(model, {true, true}) : limit.particles;
  return limit;
}

}  // namespace dovetail::arlequin
