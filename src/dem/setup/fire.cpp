#include "dovetail/dem/setup/fire.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/parallel.hpp"

namespace dovetail::dem {

namespace {
constexpr std::size_t chunkSize = 4096;
}

FireSums fireSums(const Particles& p) {
  return parallelSum(p.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    FireSums sums;
    for (std::size_t i = begin; i < end; ++i) {
      if (p.ownerOf(i) != Owner::nobody) continue;
      sums += {dot(p.f[i], p.v[i]), squaredNorm(p.v[i]), squaredNorm(p.f[i])};
      if (!p.rotates()) continue;
      const double r2 = p.radius[i] * p.radius[i];
      sums += {dot(p.torque[i], p.omega[i]), r2 * squaredNorm(p.omega[i]), squaredNorm(p.torque[i]) / r2};
    }
    return sums;
  });
}

void steer(Particles& p, const FireMix& mix, double dt) {
  parallelFor(p.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (p.ownerOf(i) != Owner::nobody) continue;
      const Vec3 kick = (0.5 * dt / p.mass[i]) * p.f[i];
      Vec3 v = mix.keep * p.v[i] + mix.lean * p.f[i];
      const double fastest = 0.5 * p.radius[i] / dt, squared = squaredNorm(v + kick);
      if (squared > fastest * fastest) v = (fastest / std::sqrt(squared)) * (v + kick) - kick;
      p.v[i] = v;
      if (p.rotates()) p.omega[i] = mix.keep * p.omega[i] + (mix.lean / (p.radius[i] * p.radius[i])) * p.torque[i];
    }
  });
}

void Fire::setLongest(double longest) {
  longest_ = longest;
  dt_ = std::min(dt_, longest_);
}

FireMix Fire::next(const FireSums& sums) {
  if (sums.power > 0.0) {
    if (++good_ > 5) {
      dt_ = std::min(1.1 * dt_, longest_);
      mix_ *= 0.99;
    }
    return {1.0 - mix_, mix_ * std::sqrt(sums.speed / sums.force)};
  }
  if (good_ > 0) dt_ = std::max(0.5 * dt_, 0.01 * longest_);
  mix_ = mixAtStart;
  good_ = 0;
  return {};
}

}  // namespace dovetail::dem
