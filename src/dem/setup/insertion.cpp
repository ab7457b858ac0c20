#include "dovetail/dem/setup/insertion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

namespace {

double largestRadius(const Sizes& sizes) {
  struct {
    double operator()(const GradingCurve& s) const { return 0.5 * s.diameter.back(); }
    double operator()(const UniformSizes& s) const { return s.largest; }
    double operator()(const NormalSizes& s) const { return s.largest; }
    double operator()(const LogNormalSizes& s) const { return s.largest; }
  } largest;
  return std::visit(largest, sizes);
}

double massOf(const Insertion& insertion) {
  const double r = insertion.nextRadius;
  return insertion.settings.density.value * (4.0 / 3.0) * std::numbers::pi * r * r * r;
}

/// The particles that reach into the region.
class Neighbourhood {
public:
  Neighbourhood(const Particles& particles, const geometry::Box& region) {
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const double r = particles.radius[i];
      bool near = true;
      for (int k = 0; k < 3; ++k)
        near = near && particles.x[i][k] + r >= region.lower[k] && particles.x[i][k] - r <= region.upper[k];
      if (near) {
        x_.push_back(particles.x[i]);
        radius_.push_back(r);
      }
    }
    old_ = x_.size();
    grid_.build(x_, radius_);
  }

  bool isFree(const Vec3& x, double radius) const {
    const Vec3 reach{radius, radius, radius};
    bool free = true;
    grid_.query(geometry::Box{x - reach, x + reach},
                [&](int i) { free = free && clear(static_cast<std::size_t>(i), x, radius); });
    for (std::size_t i = old_; free && i < x_.size(); ++i) free = clear(i, x, radius);
    return free;
  }
  void add(const Vec3& x, double radius) {
    x_.push_back(x);
    radius_.push_back(radius);
  }

private:
  bool clear(std::size_t i, const Vec3& x, double radius) const {
    const double sum = radius_[i] + radius;
    return squaredNorm(x_[i] - x) > sum * sum;
  }

  std::vector<Vec3> x_;
  std::vector<double> radius_;
  std::size_t old_ = 0;
  geometry::HierarchicalGrid grid_;
};

bool tryInsert(Insertion& insertion, Particles& particles, Neighbourhood& neighbours) {
  const InsertionSettings& s = insertion.settings;
  const double r = insertion.nextRadius;
  const Vec3 reach{r, r, r};
  for (int attempt = 0; attempt < s.tries; ++attempt) {
    const Vec3 x = insertion.random.point(s.region.lower + reach, s.region.upper - reach);
    if (!neighbours.isFree(x, r)) continue;
    addParticle(particles, x, s.velocity, r, s.density);
    neighbours.add(x, r);
    return true;
  }
  return false;
}

}  // namespace

Insertion makeInsertion(const InsertionSettings& settings) {
  validate(settings.sizes);
  requirePositive(settings.density.value, "density of inserted particles");
  if (!isFinite(settings.velocity))
    throw InputError("not a finite vector", "velocity of inserted particles", "give three finite numbers");
  requireNonNegative(settings.numberPerSecond, "number per second");
  requireNonNegative(settings.massPerSecond, "mass per second");
  if ((settings.numberPerSecond > 0.0) == (settings.massPerSecond > 0.0))
    throw InputError("there are two rates, or none", "insertion", "give numberPerSecond or massPerSecond");
  if (settings.tries < 1)
    throw InputError("there are " + std::to_string(settings.tries) + " tries", "insertion", "give 1 or more");
  const double diameter = 2.0 * largestRadius(settings.sizes);
  for (int k = 0; k < 3; ++k) {
    const double length = settings.region.upper[k] - settings.region.lower[k];
    if (!(std::isfinite(settings.region.lower[k]) && std::isfinite(length) && length >= diameter))
      throw InputError(
          "a sphere of diameter " + formatNumber(diameter) + " m does not fit along axis " + std::to_string(k),
          "region of insertion", "make the region larger, or the spheres smaller");
  }
  Insertion insertion{settings, RandomStream(settings.seed), 0.0};
  insertion.nextRadius = drawRadius(settings.sizes, insertion.random);
  return insertion;
}

int insertParticles(Insertion& insertion, Particles& particles, double dt) {
  requireNonNegative(dt, "step of an insertion");
  const bool byMass = insertion.settings.massPerSecond > 0.0;
  insertion.due += dt * (byMass ? insertion.settings.massPerSecond : insertion.settings.numberPerSecond);
  const auto price = [&] { return byMass ? massOf(insertion) : 1.0; };
  if (insertion.due < price()) return 0;
  Neighbourhood neighbours(particles, insertion.settings.region);
  int entered = 0;
  while (insertion.due >= price()) {
    const double mass = massOf(insertion);
    insertion.due -= price();
    if (tryInsert(insertion, particles, neighbours)) {
      ++entered;
      insertion.insertedMass += mass;
    } else {
      ++insertion.refused;
      insertion.refusedMass += mass;
    }
    insertion.nextRadius = drawRadius(insertion.settings.sizes, insertion.random);
  }
  insertion.inserted += entered;
  return entered;
}

}  // namespace dovetail::dem
