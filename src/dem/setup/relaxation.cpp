#include "relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dovetail/core/error.hpp"

namespace dovetail::dem {

namespace {

/// Calls visit(sphere, inward normal, overlap) for each wall that a sphere crosses, or comes closer to than reach ×
/// radius.
template <class Visit>
void forEachWallContact(const Packing& packing, double reach, Visit&& visit) {
  const auto& space = packing.space;
  for (int axis = 0; axis < 3; ++axis) {
    if (space.axes[static_cast<std::size_t>(axis)]) continue;
    Vec3 normal;
    normal[axis] = 1.0;
    for (std::size_t i = 0; i < packing.centre.size(); ++i) {
      const double radius = packing.radius[i], x = packing.centre[i][axis];
      const double low = radius - (x - space.box.lower[axis]), high = radius - (space.box.upper[axis] - x);
      if (low > -reach * radius) visit(i, normal, low);
      if (high > -reach * radius) visit(i, -normal, high);
    }
  }
}

template <class Visit>
void forEachPairContact(const Packing& packing, const geometry::SpherePairs& pairs, double reach,
                        Visit&& visit) {
  for (const auto& pair : pairs) {
    const auto i = static_cast<std::size_t>(pair[0]), j = static_cast<std::size_t>(pair[1]);
    const Vec3 d = packing.space.minimumImage(packing.centre[i] - packing.centre[j]);
    const double sum = packing.radius[i] + packing.radius[j], smaller = std::min(packing.radius[i], packing.radius[j]);
    const double limit = sum + reach * smaller, square = squaredNorm(d);
    if (square >= limit * limit) continue;
    const double distance = std::sqrt(square);
    visit(i, j, distance > 0.0 ? d / distance : Vec3{1.0, 0.0, 0.0}, sum - distance, smaller);
  }
}

}  // namespace

double meanRadius(const Packing& packing) {
  return std::accumulate(packing.radius.begin(), packing.radius.end(), 0.0) /
         static_cast<double>(packing.radius.size());
}

void Relaxation::keepPairs() {
  bool keep = positionAtBuild_.size() == packing_.centre.size() && spaceAtBuild_.box == packing_.space.box;
  // Growth uses the skin up like motion does.
  for (std::size_t i = 0; keep && i < positionAtBuild_.size(); ++i) {
    const double left = 0.5 * skin_ - (packing_.radius[i] - radiusAtBuild_[i]);
    keep = left >= 0.0 && squaredNorm(packing_.centre[i] - positionAtBuild_[i]) <= left * left;
  }
  if (keep) return;
  const double largest = *std::max_element(packing_.radius.begin(), packing_.radius.end());
  double smallestLength = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
    if (packing_.space.axes[static_cast<std::size_t>(k)])
      smallestLength = std::min(smallestLength, packing_.space.length(k));
  const double mean = meanRadius(packing_);
  skin_ = std::min(0.6 * mean, std::max(0.0, 0.4 * smallestLength - 2.0 * largest));
  grid_ = geometry::HierarchicalGrid(packing_.space);
  grid_.build(packing_.centre, packing_.radius, skin_);
  pairs_ = grid_.pairs();
  positionAtBuild_ = packing_.centre;
  radiusAtBuild_ = packing_.radius;
  spaceAtBuild_ = packing_.space;
}

void Relaxation::forces() {
  keepPairs();
  force_.assign(packing_.centre.size(), Vec3{});
  now_ = {};
  double sum = 0.0;
  const auto book = [&](double overlap, double smaller, double arm) {
    now_.largest = std::max(now_.largest, overlap / smaller);
    now_.squares += overlap * overlap;
    now_.virial += overlap * arm;
    ++now_.contacts;
    sum += overlap;
  };
  forEachPairContact(packing_, pairs_, 0.0, [&](auto i, auto j, const Vec3& n, double overlap, double smaller) {
    force_[i] += overlap * n;
    force_[j] -= overlap * n;
    book(overlap, smaller, packing_.radius[i] + packing_.radius[j] - overlap);
  });
  forEachWallContact(packing_, 0.0, [&](std::size_t i, const Vec3& n, double overlap) {
    if (!(overlap > 0.0)) return;
    force_[i] += overlap * n;
    book(overlap, packing_.radius[i], packing_.radius[i] - overlap);
  });
  residual_ = 0.0;
  for (const Vec3& f : force_) residual_ += norm(f);
  residual_ /= static_cast<double>(force_.size());
  contactForce_ = now_.contacts > 0 ? sum / static_cast<double>(now_.contacts) : 0.0;
}

Overlaps Relaxation::measure(double gap) {
  forces();
  Overlaps found = now_;
  found.contacts = 0;
  forEachPairContact(packing_, pairs_, gap, [&](auto, auto, const Vec3&, double, double) { ++found.contacts; });
  found.contacts *= 2;
  forEachWallContact(packing_, gap, [&](std::size_t, const Vec3&, double) { ++found.contacts; });
  return found;
}

std::int64_t Relaxation::run(double overlap, double balance, std::int64_t steps) {
  // FIRE with the parameters of Bitzek et al. Large spheres, which have many contacts, get a mass that goes with their
  // surface, so that one longest step is stable for all of them.
  constexpr double longest = 0.6, mixAtStart = 0.1;
  double dt = 0.1, mix = mixAtStart;
  int good = 0;
  const std::size_t n = packing_.centre.size();
  const double mean = meanRadius(packing_);
  velocity_.assign(n, Vec3{});
  forces();
  for (std::int64_t step = 0; step < steps; ++step) {
    if (now_.largest <= overlap || residual_ <= balance * contactForce_) return step;
    double power = 0.0, speed = 0.0, size = 0.0;
    for (std::size_t i = 0; i < n; ++i) power += dot(force_[i], velocity_[i]);
    if (power > 0.0) {
      if (++good > 5) {
        dt = std::min(1.1 * dt, longest);
        mix *= 0.99;
      }
    } else {
      velocity_.assign(n, Vec3{});
      if (good > 0) dt *= 0.5;
      mix = mixAtStart;
      good = 0;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double mass = std::max(1.0, packing_.radius[i] * packing_.radius[i] / (mean * mean));
      velocity_[i] += (dt / mass) * force_[i];
      speed += squaredNorm(velocity_[i]);
      size += squaredNorm(force_[i]);
    }
    const double turn = size > 0.0 ? mix * std::sqrt(speed / size) : 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      velocity_[i] = (1.0 - mix) * velocity_[i] + turn * force_[i];
      packing_.centre[i] += dt * velocity_[i];
    }
    forces();
  }
  return steps;
}

}  // namespace dovetail::dem
