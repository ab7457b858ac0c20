#include "relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/setup/fire.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t chunkSize = 4096;

std::size_t sphereOf(const Particles& particles, std::size_t i) { return static_cast<std::size_t>(particles.id[i]); }

/// Thick, as spheres go far while they are small; but no pair may meet through two images.
double skinFor(const Packing& packing) {
  double skin = 0.5 * meanRadius(packing);
  const double largest = *std::max_element(packing.radius.begin(), packing.radius.end());
  for (int k = 0; k < 3; ++k)
    if (packing.space.axes[static_cast<std::size_t>(k)])
      skin = std::min(skin, 0.49 * packing.space.length(k) - 1.96 * largest);
  return std::max(0.0, skin);
}

void addContact(Overlaps& found, double overlap, double smaller, double arm, double gap, int count) {
  if (overlap > -gap * smaller) found.held += count;
  if (!(overlap > 0.0)) return;
  found.largest = std::max(found.largest, overlap / smaller);
  found.sum += overlap;
  found.virial += overlap * arm;
  ++found.touching;
}

}  // namespace

Overlaps& Overlaps::operator+=(const Overlaps& b) {
  largest = std::max(largest, b.largest);
  sum += b.sum;
  virial += b.virial;
  touching += b.touching;
  held += b.held;
  return *this;
}

double meanRadius(const Packing& packing) {
  return std::accumulate(packing.radius.begin(), packing.radius.end(), 0.0) /
         static_cast<double>(packing.radius.size());
}

Relaxation::Relaxation(Packing& packing)
    : packing_(packing),
      surface_(packing.room.surface),
      laws_(makeContactLaws(ContactLaw<LinearSpringDashpot>{{.stiffness = 1.0}})) {
  for (std::size_t i = 0; i < packing.centre.size(); ++i)
    addParticle(particles_, packing.centre[i], {}, packing.radius[i], Mass{1.0});
  PairList none;
  sortParticles(particles_, none);
  take();
}

/// Large spheres, which have many contacts, get a mass that goes with their surface, so that one longest step is stable
/// for all of them.
void Relaxation::take() {
  const double mean = meanRadius(packing_);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const double radius = packing_.radius[sphereOf(particles_, i)];
    particles_.x[i] = packing_.centre[sphereOf(particles_, i)];
    particles_.radius[i] = radius;
    particles_.mass[i] = std::max(1.0, radius * radius / (mean * mean));
  }
  ++particles_.revision;  // lists know radii no better than numbers
  list_.setPeriodicity(packing_.space);
  list_.setSkin(skinFor(packing_));
  makeWalls();
  findForces(std::numeric_limits<double>::infinity());
}

void Relaxation::makeWalls() {
  walls_ = packing_.room.walls;
  if (packing_.room.volume > 0.0) return;
  for (int k = 0; k < 3; ++k) {
    if (packing_.space.axes[static_cast<std::size_t>(k)]) continue;
    Vec3 inwards;
    inwards[k] = 1.0;
    walls_.push_back(makePlane(packing_.space.box.lower, inwards));
    walls_.push_back(makePlane(packing_.space.box.upper, -inwards));
  }
}

void Relaxation::findForces(double moved) {
  updatePairs(particles_, list_, moved);
  clearForces(particles_);
  laws_->pairs(particles_, list_, 0.0, Booking::off);
  for (PrimitiveWall& wall : walls_) {
    findContacts(particles_, wall, {moved, Moves::unknown, list_.travel(), list_.builds()}, list_.periodicity());
    laws_->wall(particles_, wall, 0.0, Booking::off);
  }
  if (!surface_.isEmpty()) pushFromSurface();
}

/// As walls do, by springs of 1 N/m.
void Relaxation::pushFromSurface() {
  Particles& p = particles_;
  parallelFor(p.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      surface_.forEachNear(p.x[i], p.radius[i],
                           [&](double distance, const Vec3& inwards) { p.f[i] += (p.radius[i] - distance) * inwards; });
  });
}

Overlaps Relaxation::measure(double gap) const {
  const Particles& p = particles_;
  const geometry::Periodicity& space = packing_.space;
  Overlaps found = parallelSum(list_.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    Overlaps part;
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<std::size_t>(list_.pairs()[k][0]), j = static_cast<std::size_t>(list_.pairs()[k][1]);
      const double smaller = std::min(p.radius[i], p.radius[j]), sum = p.radius[i] + p.radius[j];
      const double squared = squaredNorm(space.minimumImage(p.x[i] - p.x[j])), limit = sum + gap * smaller;
      if (!(squared < limit * limit)) continue;
      const double distance = std::sqrt(squared);
      addContact(part, sum - distance, smaller, distance, gap, 2);
    }
    return part;
  });
  for (const PrimitiveWall& wall : walls_)
    for (std::size_t i = 0; i < p.size(); ++i) {
      const double height = distanceTo(wall, p.x[i]).distance;
      addContact(found, p.radius[i] - height, p.radius[i], height, gap, 1);
    }
  for (std::size_t i = 0; !surface_.isEmpty() && i < p.size(); ++i)
    surface_.forEachNear(p.x[i], (1.0 + gap) * p.radius[i], [&](double distance, const Vec3&) {
      addContact(found, p.radius[i] - distance, p.radius[i], distance, gap, 1);
    });
  return found;
}

double Relaxation::unbalanced(const Overlaps& now) const {
  if (now.touching == 0) return 0.0;
  const double residual = parallelSum(particles_.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t i = begin; i < end; ++i) sum += norm(particles_.f[i]);
    return sum;
  });
  return residual / static_cast<double>(particles_.size()) / (now.sum / static_cast<double>(now.touching));
}

std::int64_t Relaxation::run(double overlap, double balance, std::int64_t steps) {
  constexpr double longest = 0.6;  // s
  constexpr std::int64_t lookEvery = 8;
  Fire fire(longest);
  std::fill(particles_.v.begin(), particles_.v.end(), Vec3{});
  std::int64_t step = 0;
  for (; step < steps; ++step) {
    if (step % lookEvery == 0) {
      const Overlaps now = measure();
      if (now.largest <= overlap || unbalanced(now) <= balance) break;
    }
    const FireMix mix = fire.next(fireSums(particles_));
    steer(particles_, mix, fire.dt());
    findForces(turnStep(particles_, fire.dt(), {}));
  }
  for (std::size_t i = 0; i < particles_.size(); ++i) packing_.centre[sphereOf(particles_, i)] = particles_.x[i];
  return step;
}

}  // namespace dovetail::dem
