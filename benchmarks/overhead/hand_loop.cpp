#include "hand_loop.hpp"

#include <algorithm>
#include <cmath>

namespace dovetail::overhead {

HandLoop::HandLoop(const dem::Model& model, double stiffness)
    : x(model.particles.x),
      v(model.particles.v),
      f(model.particles.f),
      start_(model.particles.x),
      diameter_(2.0 * model.particles.radius.front()),
      mass_(model.particles.mass.front()),
      stiffness_(stiffness),
      limit_(0.25 * model.pairs.innerSkin() * model.pairs.innerSkin()) {
  for (std::size_t k = 0; k < model.pairs.size(); ++k) {
    const int i = model.pairs.pairs()[k][0], j = model.pairs.pairs()[k][1];
    const Vec3 shift = model.pairs.shift(k);
    if (squaredNorm(shift) == 0.0)
      within_.push_back({i, j});
    else
      across_.push_back({i, j, shift});
  }
}

void HandLoop::step(double dt) {
  const double kick = (first_ ? 0.5 : 1.0) * dt / mass_, squaredDiameter = diameter_ * diameter_;
  first_ = false;
  double farthest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    v[i] += kick * f[i];
    x[i] += dt * v[i];
    f[i] = {};
    farthest = std::max(farthest, squaredNorm(x[i] - start_[i]));
  }
  good_ = good_ && farthest < limit_;
  const auto push = [&](std::size_t i, std::size_t j, const Vec3& between) {
    const double squared = squaredNorm(between);
    if (squared >= squaredDiameter) return;
    const double distance = std::sqrt(squared);
    const Vec3 force = (stiffness_ * (diameter_ - distance) / distance) * between;
    f[i] -= force;
    f[j] += force;
  };
  for (const auto& [i, j] : within_) {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    push(a, b, x[b] - x[a]);
  }
  for (const Pair& pair : across_) {
    const auto a = static_cast<std::size_t>(pair.i), b = static_cast<std::size_t>(pair.j);
    push(a, b, x[b] - pair.shift - x[a]);
  }
}

std::size_t HandLoop::bytes() const {
  return 4 * x.size() * sizeof(Vec3) + within_.size() * sizeof(within_[0]) + across_.size() * sizeof(across_[0]);
}

}  // namespace dovetail::overhead
