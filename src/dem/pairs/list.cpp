// When a list is made anew.
#include <cmath>
#include <limits>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pairs/pairs.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t grain = 4096;

/// Largest squared displacements since the search and since the pruning, m²; NaN if a position is not finite.
struct Travels {
  double search = 0.0, pruning = 0.0;
  static void raise(double& largest, double d2) {
    if (!(d2 <= largest)) largest = d2;
  }
  Travels& operator+=(const Travels& b) {
    if (!std::isnan(search)) raise(search, b.search);
    if (!std::isnan(pruning)) raise(pruning, b.pruning);
    return *this;
  }
};

Travels largestTravels(const Particles& particles, const PairList& list) {
  const bool pruned = !list.positionAtPruning.empty();
  return parallelSum(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    Travels part;
    for (std::size_t i = begin; i < end && !std::isnan(part.search); ++i) {
      Travels::raise(part.search, squaredNorm(particles.x[i] - list.positionAtBuild[i]));
      if (pruned) Travels::raise(part.pruning, squaredNorm(particles.x[i] - list.positionAtPruning[i]));
    }
    return part;
  });
}

void requireFinitePositions(const Particles& particles) {
  const double worst = parallelSum(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i)
      sum += 0.0 * (particles.x[i].x + particles.x[i].y + particles.x[i].z);  // 0, or NaN
    return sum;
  });
  if (!(worst == 0.0)) requireFinite(particles.x, "particle", "position", "search for pairs");
}

}  // namespace

bool PairList::fits(const Particles& particles) const {
  return builds > 0 && particleRevision == particles.revision && wraps == particles.wraps &&
         positionAtBuild.size() == particles.size();
}

double detail::skinOf(const Particles& particles, PairList& list) {
  if (!list.skin) {
    const double sum = parallelSum(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
      double part = 0.0;
      for (std::size_t i = begin; i < end; ++i) part += 2.0 * particles.radius[i];
      return part;
    });
    if (particles.size() == 0) return 0.0;
    list.skin = PairList::defaultSkin * sum / static_cast<double>(particles.size());
  }
  return requireNonNegative(*list.skin, "skin of the pair list");
}

void findPairs(Particles& particles, std::optional<double> skin, PairList& list) {
  list.skin = skin;
  const double reach = detail::skinOf(particles, list);
  requireFinitePositions(particles);
  wrapPositions(particles, list.periodicity);
  geometry::HierarchicalGrid grid(list.periodicity);  // not kept: it takes as much memory as the list
  grid.build(particles.x, particles.radius, reach + list.reach);
  detail::takeFound(particles, grid, reach, list);
}

// Comparisons are written so that a NaN asks for a new list, which then names the culprit.
bool updatePairs(Particles& particles, PairList& list) {
  return updatePairs(particles, list, std::numeric_limits<double>::infinity());
}

bool updatePairs(Particles& particles, PairList& list, double step) {
  if (!list.fits(particles) || !list.skin) {
    findPairs(particles, list.skin, list);
    return true;
  }
  const double half = 0.5 * *list.skin, innerHalf = 0.5 * list.innerSkin;
  const bool pruned = list.innerSkin < *list.skin;
  list.travel += step;
  list.innerTravel += step;
  ++list.updatesSincePruning;
  if (list.travel <= half && (!pruned || list.innerTravel <= innerHalf)) return false;
  const Travels travels = largestTravels(particles, list);
  list.travel = std::sqrt(travels.search);
  list.innerTravel = std::sqrt(travels.pruning);
  if (!(list.travel <= half)) {
    findPairs(particles, list.skin, list);
    return true;
  }
  if (!pruned || list.innerTravel <= innerHalf) return false;
  detail::prunePairs(particles, list);
  return true;
}

void wrapPositions(Particles& particles, const geometry::Periodicity& periodicity) {
  if (!periodicity.any()) return;
  const std::size_t moved = parallelSum(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      Vec3& x = particles.x[i];
      for (int k = 0; k < 3; ++k) {
        if (!periodicity.axes[static_cast<std::size_t>(k)]) continue;
        const double length = periodicity.length(k);
        const double periods = std::floor((x[k] - periodicity.box.lower[k]) / length);
        if (periods == 0.0) continue;
        x[k] -= length * periods;
        ++count;
      }
    }
    return count;
  });
  if (moved > 0) ++particles.wraps;
}

}  // namespace dovetail::dem
