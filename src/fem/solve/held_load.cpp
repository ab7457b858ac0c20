#include "dovetail/fem/solve/held_load.hpp"

#include <algorithm>

namespace dovetail::fem {

void HeldLoad::hold(Model& model) {
  end();
  const DofMap dofs(model.constraints, model.nodes);
  dofs.apply(model.t, model.nodes.u);
  std::vector<Vec3> sum(model.nodes.X.size());
  for (const auto& term : model.terms) term->addForces(model.nodes, {.t = model.t}, sum);
  std::vector<double> free(dofs.size());
  dofs.reduce(sum, free);
  force_.assign(sum.size(), {});
  for (std::size_t i = 0; i < free.size(); ++i)
    force_[static_cast<std::size_t>(dofs.freeDofs()[i] / 3)][dofs.freeDofs()[i] % 3] = free[i];
  last_ = model.nodes.u;
}

void HeldLoad::release(double before, double after, double from, double to) {
  before_ = before, after_ = after, from_ = from, to_ = to;
}

bool HeldLoad::isIdle() const {
  return std::ranges::all_of(force_, [](const Vec3& f) { return f == Vec3{}; });
}

double HeldLoad::factor(double t) const {
  if (!(to_ > from_)) return after_;
  return before_ + std::clamp((t - from_) / (to_ - from_), 0.0, 1.0) * (after_ - before_);
}

void HeldLoad::addForces(const Nodes&, const Instant& now, std::span<Vec3> f) {
  const double s = factor(now.t);
  for (std::size_t n = 0; n < force_.size(); ++n) f[n] -= s * force_[n];
}

double HeldLoad::energy(const Nodes& nodes, const Instant& now) {
  double sum = 0.0;
  for (std::size_t n = 0; n < force_.size(); ++n) sum += dot(force_[n], nodes.u[n]);
  return factor(now.t) * sum;
}

double HeldLoad::commit(const Nodes& nodes, const Instant& now) {
  const double s = factor(now.t), mean = 0.5 * (lastFactor_ + s);
  for (std::size_t n = 0; n < force_.size(); ++n) work_ -= mean * dot(force_[n], nodes.u[n] - last_[n]);
  last_ = nodes.u;
  lastFactor_ = s;
  return 0.0;
}

void HeldLoad::save(ByteWriter& archive) const {
  archive(force_, last_, before_, after_, from_, to_, lastFactor_, work_);
}
void HeldLoad::load(ByteReader& archive) { archive(force_, last_, before_, after_, from_, to_, lastFactor_, work_); }

}  // namespace dovetail::fem
