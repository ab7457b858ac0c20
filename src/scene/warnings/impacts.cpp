// How the impacts of a scene go at a step, and how deep.
#include "impacts.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "build/parts.hpp"
#include "build/sizes.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/impact.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"

namespace dovetail::scene {

namespace {

struct Smallest {
  double radius = 0.0, mass = 0.0;  ///< m, kg
  bool alone = true;                ///< it meets walls only
};

/// Of each contact material.
std::map<int, Smallest> smallestIn(const Scene& scene, const dem::Particles& p) {
  std::map<int, Smallest> smallest;
  const auto offer = [&](int row, double radius, double mass, bool alone) {
    const auto [found, isNew] = smallest.try_emplace(row, Smallest{radius, mass, alone});
    if (isNew) return;
    if (mass < found->second.mass) found->second.radius = radius, found->second.mass = mass;
    found->second.alone = false;
  };
  for (std::size_t i = 0; i < p.size(); ++i)
    offer(p.material.empty() ? 0 : p.material[i], p.radius[i], p.mass[i], p.size() == 1);
  for (const Insertion& in : scene.insertions) {
    const Entering grains = enteringOf(in);
    offer(contactRow(scene, in.contactMaterial), grains.smallest, grains.lightest, false);
  }
  return smallest;
}

/// Speed after over speed before of two that meet head on, pressed together by about a twentieth of the radius.
/// @param phase  fraction of a step's way that is between them at the start
double rebound(const std::shared_ptr<const dem::ContactLaws>& laws, const Smallest& one, std::array<int, 2> rows,
               double limit, double dt, double phase) {
  const double speed = 0.05 * one.radius * 2.0 / limit;
  dem::Model m;
  m.laws = laws;
  m.refusesUnstableSteps = false;
  m.booking = dem::Booking::off;
  dem::addParticle(m.particles, {}, {speed, 0, 0}, one.radius, dem::Mass{one.mass});
  dem::addParticle(m.particles, {2.0 * one.radius + phase * speed * dt, 0, 0}, {}, one.radius,
                   dem::Mass{one.alone ? 1e12 * one.mass : one.mass});
  if (laws->materials() > 1)
    m.particles.material = {static_cast<std::uint8_t>(rows[0]), static_cast<std::uint8_t>(rows[1])};
  const auto touches = [&] { return norm(m.particles.x[0] - m.particles.x[1]) < 2.0 * one.radius; };
  for (int step = 0; step < 4 || touches(); ++step) {
    dem::run(m, dt, 1);
    if (step > 100.0 * limit / dt) return 0.0;  // they stay together
  }
  return (m.particles.v[1].x - m.particles.v[0].x) / speed;
}

/// Restitution is that of repulsion and dashpots alone: sticky grains may stay together.
std::shared_ptr<const dem::ContactLaws> lawsWithoutPulls(const Scene& scene, const dem::Model& grains) {
  const auto pulls = [](const ContactLaw& law) { return law.adhesion || law.liquidBridge; };
  if (!(scene.contact && pulls(*scene.contact)) &&
      std::ranges::none_of(scene.contacts, [&](const PairLaw& pair) { return pulls(pair.law); }))
    return grains.laws;
  Scene repelling;
  repelling.contact = scene.contact;
  repelling.contacts = scene.contacts;
  if (repelling.contact) repelling.contact->adhesion.reset(), repelling.contact->liquidBridge.reset();
  for (PairLaw& pair : repelling.contacts) pair.law.adhesion.reset(), pair.law.liquidBridge.reset();
  return makeLaws(repelling);
}

}  // namespace

Rebound worstRebound(const Built& built, const Scene& scene, double dt) {
  const dem::Model& grains = built.run->grains;
  Rebound worst;
  if (!grains.laws || std::isinf(grains.laws->reach())) return worst;
  const double limit = briefestImpact(scene, grains.particles).limit;
  constexpr double fine = 2e-3;  // of an impact: what a step does to its rebound is of its order
  if (dt < fine * limit) return worst;
  const std::shared_ptr<const dem::ContactLaws> laws = lawsWithoutPulls(scene, grains);
  const auto look = [&](const ContactLaw& law, const Smallest& one, std::array<int, 2> rows) {
    if (!(law.restitution < 0.5)) return;
    for (int phase = 0; phase < 8; ++phase) {
      const Rebound found{rebound(laws, one, rows, limit, dt, 0.125 * phase), law.restitution};
      if (found.error() > worst.error()) worst = found;
    }
  };
  const auto smallest = smallestIn(scene, grains.particles);
  for (const auto& [row, one] : smallest) {
    if (scene.contact && scene.contacts.empty()) look(*scene.contact, one, {row, row});
    for (const PairLaw& pair : scene.contacts) {
      const int a = contactRow(scene, pair.first), b = contactRow(scene, pair.second);
      if (a == row || b == row) look(pair.law, one, {row, a == row ? b : a});
    }
  }
  return worst;
}

namespace {

constexpr double deep = 0.5;  // radii

std::string inRadii(double overlap) { return overlap < 1.99 ? rounded(overlap) + " radii" : "two radii and more"; }

void note(DeepGrains& found, const dem::Model& m, int grain, double overlap) {
  const std::int64_t id = m.particles.id[static_cast<std::size_t>(grain)];
  const auto place = std::ranges::lower_bound(found.ids, id);
  if (place == found.ids.end() || *place != id) found.ids.insert(place, id);
  if (overlap > found.overlap) found.overlap = overlap, found.worst = id, found.time = m.time;
}

/// Grains above each other as high as the scene, on the lowest one.
double columnOf(const Smallest& one, const Scene& scene, const dem::Particles& p) {
  const double g = norm(scene.gravity);
  if (g == 0.0 || p.size() == 0) return 0.0;
  const auto height = [&](const Vec3& x) { return -dot(x, scene.gravity) / g; };
  const auto [low, high] =
      std::ranges::minmax_element(p.x, [&](const Vec3& a, const Vec3& b) { return height(a) < height(b); });
  return (1.0 + (height(*high) - height(*low)) / (2.0 * one.radius)) * one.mass * g;
}

}  // namespace

void lookForDeepGrains(const dem::Model& m, DeepGrains& found) {
  const dem::Particles& p = m.particles;
  if (!m.laws || std::isinf(m.laws->reach())) return;
  for (std::size_t c = 0; c < m.pairs.size(); ++c) {
    const auto i = static_cast<std::size_t>(m.pairs.pairs()[c][0]), j = static_cast<std::size_t>(m.pairs.pairs()[c][1]);
    const double reach = p.radius[i] + p.radius[j], least = std::min(p.radius[i], p.radius[j]);
    const double near = reach - deep * least;
    const Vec3 d = p.x[i] - p.x[j] + m.pairs.shift(c);
    if (squaredNorm(d) < near * near && m.pairs.factor(c) > 0.0)
      note(found, m, m.pairs.pairs()[c][p.radius[i] <= p.radius[j] ? 0 : 1], (reach - norm(d)) / least);
  }
  dem::ContactSample walls;
  for (const auto& term : m.terms) term->addContacts(m, walls);
  for (std::size_t c = 0; c < walls.size(); ++c) {
    const double radius = p.radius[static_cast<std::size_t>(walls.first[c])];
    const double overlap = 1.0 - dot(walls.normal[c], walls.from[c] - walls.to[c]) / radius;
    if (overlap > deep) note(found, m, walls.first[c], overlap);
  }
}

std::string lineOf(const DeepGrains& found) {
  if (found.ids.empty()) return "";
  return (found.ids.size() == 1 ? "1 grain was" : std::to_string(found.ids.size()) + " grains were") +
         " seen in contacts deeper than half a radius, the deepest " + rounded(found.overlap) + " radii (grain " +
         std::to_string(found.worst) + " at t = " + formatNumber(found.time) +
         " s): take a stiffer law, or smaller speeds";
}

void lookAtSoftness(const Built& built, const Scene& scene, Lines& lines) {
  const dem::Model& grains = built.run->grains;
  if (!grains.laws || std::isinf(grains.laws->reach()) || (!scene.contact && scene.contacts.empty())) return;
  const dem::ImpactLimit impact = dem::impactLimit(grains, dem::demandOf(grains));
  if (impact.overlap > deep)
    lines.push_back("The springs are too soft for the speeds: " + impact.deepest + " overlaps by " +
                    inRadii(impact.overlap) +
                    ", and grains may pass through each other and through walls: take a law that is stiffer by " +
                    rounded(std::pow(impact.overlap / 0.05, 2.0)) + " times, or smaller speeds.");
  for (const auto& [row, one] : smallestIn(scene, grains.particles)) {
    const double spring = softestSpring(scene, row, one.radius);
    const double overlap = columnOf(one, scene, grains.particles) / (spring * one.radius);
    if (overlap > deep)
      lines.push_back(
          "The springs are too soft for the weight: grains under a column as high as the scene overlap by " +
          inRadii(overlap) + ": take a law that is stiffer by " + rounded(overlap / 0.01) + " times.");
  }
}

}  // namespace dovetail::scene
