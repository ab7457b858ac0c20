// When a list is made anew.
#include <cmath>

#include "../particles/sort_particles.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "list_update.hpp"

namespace dovetail::dem {

namespace {

using detail::PairParts;

constexpr std::size_t particleChunk = 4096;

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

Travels largestTravels(const Particles& particles, const PairParts& list) {
  const bool pruned = list.pruned();
  return parallelSum(particles.size(), particleChunk, [&](std::size_t begin, std::size_t end) {
    Travels part;
    for (std::size_t i = begin; i < end && !std::isnan(part.search); ++i) {
      Travels::raise(part.search, squaredNorm(particles.x[i] - list.positionAtBuild[i]));
      if (pruned) Travels::raise(part.pruning, squaredNorm(particles.x[i] - list.positionAtPruning[i]));
    }
    return part;
  });
}

void requireFinitePositions(const Particles& particles) {
  const double worst = parallelSum(particles.size(), particleChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i)
      sum += 0.0 * (particles.x[i].x + particles.x[i].y + particles.x[i].z);  // 0, or NaN
    return sum;
  });
  if (!(worst == 0.0)) requireFinite(particles.x, "particle", "position", "search for pairs");
}

/// The skin that is set, or the default, which is set then.
double skinOf(const Particles& particles, PairParts& list) {
  if (list.skin) return *list.skin;
  if (particles.size() == 0) return 0.0;
  const double sum = parallelSum(particles.size(), particleChunk, [&](std::size_t begin, std::size_t end) {
    double part = 0.0;
    for (std::size_t i = begin; i < end; ++i) part += 2.0 * particles.radius[i];
    return part;
  });
  list.skin = PairList::defaultSkin * sum / static_cast<double>(particles.size());
  return requireNonNegative(*list.skin, "skin of the pair list");
}

bool isNumberedAs(const PairParts& list, const Particles& particles) {
  return list.builds > 0 && list.particleRevision == particles.revision && list.wraps == particles.wraps &&
         list.positionAtBuild.size() == particles.size();
}

}  // namespace

bool PairList::fits(const Particles& particles) const { return isNumberedAs(parts_, particles) && !parts_.outdated; }

bool PairList::maySearch(const Particles& particles, double step) const {
  return !fits(particles) || !parts_.skin || !(parts_.travel + step <= 0.5 * *parts_.skin);
}

void findPairs(Particles& particles, PairList& of) {
  PairParts& list = detail::partsOf(of);
  const double skin = skinOf(particles, list);
  requireFinitePositions(particles);
  wrapPositions(particles, list.periodicity);
  geometry::HierarchicalGrid grid(list.periodicity);  // not kept: it takes as much memory as the list
  grid.build(particles.x, particles.radius, skin + list.reach);
  detail::takeFound(particles, grid, skin, list);
}

// Comparisons are written so that a NaN asks for a new list, which then names the culprit.
bool updatePairs(Particles& particles, PairList& of, double step) {
  PairParts& list = detail::partsOf(of);
  const auto search = [&] {
    findPairs(particles, of);
    return true;
  };
  if (!of.fits(particles) || !list.skin || std::isinf(list.travel)) return search();
  const double half = 0.5 * *list.skin, innerHalf = 0.5 * list.innerSkin;
  list.travel += step;
  list.innerTravel += step;
  ++list.updatesSincePruning;
  const auto pruningLasts = [&] { return !list.pruned() || list.innerTravel <= innerHalf; };
  if (list.travel <= half && pruningLasts()) return false;
  const Travels travels = largestTravels(particles, list);
  list.travel = std::sqrt(travels.search);
  list.innerTravel = std::sqrt(travels.pruning);
  if (!(list.travel <= half)) return search();
  if (pruningLasts()) return false;
  detail::prunePairs(particles, list);
  return true;
}

std::vector<int> sortParticles(Particles& particles, PairList& of) {
  if (particles.size() == 0) return {};
  PairParts& list = detail::partsOf(of);
  const bool listed = isNumberedAs(list, particles);
  const double skin = listed ? skinOf(particles, list) : 0.0;
  wrapPositions(particles, list.periodicity);
  geometry::HierarchicalGrid grid(list.periodicity);
  grid.build(particles.x, particles.radius, skin + list.reach);
  const std::vector<int> newNumber = detail::numbersAlongCurve(particles, grid.order());
  if (listed) renumber(of, newNumber, particles);
  renumber(particles, newNumber);
  if (!listed) return newNumber;
  grid.renumber(newNumber);
  detail::takeFound(particles, grid, skin, list);
  return newNumber;
}

void wrapPositions(Particles& particles, const geometry::Periodicity& periodicity) {
  if (!periodicity.any()) return;
  const std::size_t moved = parallelSum(particles.size(), particleChunk, [&](std::size_t begin, std::size_t end) {
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
