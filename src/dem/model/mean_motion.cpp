// With which velocities forces do their work.
#include "dovetail/core/parallel.hpp"
#include "events.hpp"

namespace dovetail::dem {

MeanMotion meanMotion(const Model& m, const Step& step, bool withSpins) {
  const Particles& p = m.particles;
  MeanMotion mean{p.v, withSpins ? p.omega : std::vector<Vec3>()};
  const bool spins = withSpins && p.rotates();
  parallelFor(p.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double half = 0.5 * step.dt / p.weightOf(i);
      mean.v[i] += (half / p.mass[i]) * p.f[i];
      if (spins) mean.omega[i] += (half / momentOfInertia(p, static_cast<int>(i))) * p.torque[i];
    }
  });
  for (const auto& term : m.terms) term->meanMotion(m, step, mean.v, mean.omega);
  return mean;
}

}  // namespace dovetail::dem
