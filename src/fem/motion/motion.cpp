#include "dovetail/fem/motion/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "dovetail/core/parallel.hpp"
#include "force_sum.hpp"

namespace dovetail::fem {

namespace {

constexpr std::size_t nodeChunk = 4096;

static_assert(sizeof(Vec3) == 3 * sizeof(double));

/// v += increment(k) of component k = 0, 1 … Whether v is finite: 0 · v is NaN if it is not, and sums pass it on;
/// several side by side, so that none waits for the one before.
template <class Increment>
bool add(std::vector<Vec3>& v, Increment&& increment) {
  constexpr std::size_t lanes = 24;
  if (v.empty()) return true;
  double* const value = &v.front().x;
  const double sum = parallelSum(v.size(), nodeChunk, [&](std::size_t begin, std::size_t end) {
    std::array<double, lanes> bad{};
    std::size_t k = 3 * begin;
    for (; k + lanes <= 3 * end; k += lanes)
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        value[k + lane] += increment(k + lane);
        bad[lane] += 0.0 * value[k + lane];
      }
    for (; k < 3 * end; ++k) {
      value[k] += increment(k);
      bad[0] += 0.0 * value[k];
    }
    double all = 0.0;
    for (const double one : bad) all += one;
    return all;
  });
  return sum == 0.0;
}

}  // namespace

struct Motion::Impl {
  Model* model;
  DofMap dofs;
  ModelMass mass;
  detail::ForceSum sum;
  std::vector<Vec3> acceleration;  // where masses are not lumped

  Impl(Model& m, double fraction) : model(&m), dofs(m.constraints, m.nodes), mass(m, dofs, fraction), sum(m) {}
};

Motion::Motion(Model& model, double massFraction) : impl_(std::make_unique<Impl>(model, massFraction)) {}
Motion::~Motion() = default;
Motion::Motion(Motion&&) noexcept = default;

Model& Motion::model() const { return *impl_->model; }
const DofMap& Motion::dofs() const { return impl_->dofs; }
const ModelMass& Motion::mass() const { return impl_->mass; }
std::span<const double> Motion::energies() const { return impl_->sum.energies; }
std::span<const std::vector<Vec3>> Motion::loads() const { return impl_->sum.loads; }

double Motion::forces(double dt, bool withEnergy, bool willCommit) {
  Model& model = *impl_->model;
  const Instant now{.t = model.t, .dt = dt, .mass = &impl_->mass, .willCommit = willCommit};
  return impl_->sum.evaluate(model, model.nodes, now, model.nodes.f, withEnergy);
}

void Motion::setLoads(std::vector<std::vector<Vec3>> loads) { impl_->sum.loads = std::move(loads); }

bool Motion::kick(double dt) {
  Nodes& nodes = impl_->model->nodes;
  if (!impl_->mass.isDiagonal()) {
    impl_->acceleration = nodes.f;
    impl_->mass.solve(impl_->acceleration);
    return kick(impl_->acceleration, dt);
  }
  const double* const f = &nodes.f.front().x;
  const double* const inverse = impl_->mass.inverse().data();
  return add(nodes.v, [=](std::size_t k) { return (dt * inverse[k]) * f[k]; });
}

bool Motion::kick(std::span<const Vec3> a, double dt) {
  const double* const rate = &a.front().x;
  return add(impl_->model->nodes.v, [=](std::size_t k) { return dt * rate[k]; });
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

void Motion::renew() {
  Model& model = *impl_->model;
  addMass(model);
  impl_ = std::make_unique<Impl>(model, impl_->mass.fraction());
}

double Motion::kineticEnergy() const { return impl_->mass.kineticEnergy(impl_->model->nodes.v); }

}  // namespace dovetail::fem
