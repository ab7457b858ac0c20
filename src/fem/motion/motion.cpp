#include "dovetail/fem/motion/motion.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/parallel.hpp"
#include "force_sum.hpp"

namespace dovetail::fem {

namespace {

constexpr std::size_t nodeGrain = 4096;

/// 0 · v is NaN if v is not finite, and a sum passes it on.
double poison(const Vec3& v) { return 0.0 * (v.x + v.y + v.z); }

}  // namespace

struct Motion::Impl {
  Model* model;
  DofMap dofs;
  ModelMass mass;
  detail::ForceSum sum;
  std::vector<Vec3> acceleration;  // where masses are not lumped

  Impl(Model& m, double share) : model(&m), dofs(m.constraints, m.nodes), mass(m, dofs, share), sum(m) {}
};

Motion::Motion(Model& model, double massShare) : impl_(std::make_unique<Impl>(model, massShare)) {}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

Model& Motion::model() const { return *impl_->model; }
const DofMap& Motion::dofs() const { return impl_->dofs; }
const ModelMass& Motion::mass() const { return impl_->mass; }
std::span<const double> Motion::energies() const { return impl_->sum.energies; }
std::span<const std::vector<Vec3>> Motion::loads() const { return impl_->sum.loads; }

double Motion::forces(double dt, bool withEnergy) {
  Model& model = *impl_->model;
  return impl_->sum.evaluate(model, model.nodes, {model.t, dt, &impl_->mass}, model.nodes.f, withEnergy);
}

void Motion::setLoads(std::vector<std::vector<Vec3>> loads) { impl_->sum.loads = std::move(loads); }

bool Motion::kick(double dt) {
  Nodes& nodes = impl_->model->nodes;
  if (!impl_->mass.isDiagonal()) {
    impl_->acceleration = nodes.f;
    impl_->mass.solve(impl_->acceleration);
    return kick(impl_->acceleration, dt);
  }
  const std::span<const int> row = impl_->dofs.freeRow();
  const double sum = parallelSum(nodes.v.size(), nodeGrain, [&](std::size_t begin, std::size_t end) {
    double bad = 0.0;
    for (std::size_t n = begin; n < end; ++n) {
      Vec3& v = nodes.v[n];
      const double factor = dt / nodes.mass[n];
      if (row[3 * n] >= 0) v.x += factor * nodes.f[n].x;
      if (row[3 * n + 1] >= 0) v.y += factor * nodes.f[n].y;
      if (row[3 * n + 2] >= 0) v.z += factor * nodes.f[n].z;
      bad += poison(v);
    }
    return bad;
  });
  return sum == 0.0;
}

bool Motion::kick(std::span<const Vec3> a, double dt) {
  std::vector<Vec3>& v = impl_->model->nodes.v;
  const double sum = parallelSum(v.size(), nodeGrain, [&](std::size_t begin, std::size_t end) {
    double bad = 0.0;
    for (std::size_t n = begin; n < end; ++n) {
      v[n] += dt * a[n];
      bad += poison(v[n]);
    }
    return bad;
  });
  return sum == 0.0;
}

void Motion::drift(double dt) {
  Model& model = *impl_->model;
  fem::drift(model.nodes, dt);
  model.t += dt;
  impl_->dofs.apply(model.t, model.nodes.u);
}

double Motion::commit(double dt) {
  Model& model = *impl_->model;
  double dissipated = 0.0;
  for (const auto& term : model.terms) dissipated += term->commit(model.nodes, {model.t, dt, &impl_->mass});
  return dissipated;
}

double Motion::kineticEnergy() const { return impl_->mass.kineticEnergy(impl_->model->nodes.v); }

}  // namespace dovetail::fem
