#include "dovetail/cg/width_study.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::cg {

namespace {

void require(const WidthRange& range) {
  requirePositive(range.least, "least width");
  requirePositive(range.most, "largest width");
  if (!(range.least < range.most))
    throw InputError("the widths " + formatNumber(range.least) + " m to " + formatNumber(range.most) + " m",
                     "range of widths", "give the smaller one first");
  if (range.samples < 3)
    throw InputError(std::to_string(range.samples) + " samples", "range of widths", "give 3 at least");
}

/// Root mean square of velocities about their mean, weighted by mass, m/s; 0 where it is no more than rounding.
double spreadOf(const ParticleView& particles) {
  double mass = 0.0, about = 0.0, largest = 0.0;
  Vec3 momentum;
  for (std::size_t i = 0; i < particles.mass.size(); ++i) {
    mass += particles.mass[i];
    momentum += particles.mass[i] * particles.v[i];
    largest = std::max(largest, norm(particles.v[i]));
  }
  if (!(mass > 0.0)) return 0.0;
  for (std::size_t i = 0; i < particles.mass.size(); ++i)
    about += particles.mass[i] * squaredNorm(particles.v[i] - momentum / mass);
  const double spread = std::sqrt(about / mass);
  return spread > 1e-12 * largest ? spread : 0.0;
}

/// Relative changes from one width to the next.
struct Change {
  double density, velocity;
};
Change changeOf(const Fields& a, const Fields& b, double spread) {
  double change = 0.0, density = 0.0, velocity = 0.0, weight = 0.0;
  for (std::size_t p = 0; p < a.size(); ++p) {
    const double mean = 0.5 * (a.density[p] + b.density[p]), difference = b.density[p] - a.density[p];
    change += difference * difference;
    density += mean * mean;
    if (!(a.density[p] > 0.0 && b.density[p] > 0.0)) continue;  // there is no velocity
    weight += mean;
    velocity += mean * squaredNorm(b.velocity[p] - a.velocity[p]);
  }
  if (!(density > 0.0))
    throw InputError("no point is within reach of a particle", "points",
                     "place them among the particles, or take larger widths");
  return {std::sqrt(change / density), spread > 0.0 && weight > 0.0 ? std::sqrt(velocity / weight) / spread : 0.0};
}

}  // namespace

WidthStudy studyWidths(KernelShape shape, int dimension, std::span<const Vec3> points, const SnapshotView& snapshot,
                       const WidthRange& range) {
  require(range);
  const SnapshotView moving{.particles = {snapshot.particles.x, snapshot.particles.v, snapshot.particles.mass},
                            .space = snapshot.space};
  const double spread = spreadOf(moving.particles), step = std::log(range.most / range.least) / (range.samples - 1);
  const auto widthAt = [&](double k) { return range.least * std::exp(k * step); };
  WidthStudy study;
  std::map<double, double> samples;
  Fields before = sample({shape, dimension, widthAt(-0.5)}, points, moving);
  for (int k = 0; k < range.samples; ++k) {
    Fields after = sample({shape, dimension, widthAt(k + 0.5)}, points, moving);
    const Change change = changeOf(before, after, spread);
    study.density.push_back(change.density / step);
    study.velocity.push_back(change.velocity / step);
    const double width = k == 0 ? range.least : k + 1 == range.samples ? range.most : widthAt(k);
    samples[width] = std::hypot(study.density.back(), study.velocity.back());
    before = std::move(after);
  }
  study.curve = curveThrough(samples, range.least, range.most);
  return study;
}

}  // namespace dovetail::cg
