#include "dovetail/dem/pairs.hpp"

#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/pair_collide.hpp"

namespace dovetail::dem {

namespace {

constexpr std::size_t grain = 1024;

/// Springs of pairs that are in both lists; both are sorted.
void keepStretch(const std::vector<std::array<int, 2>>& oldPairs, const std::vector<Vec3>& oldStretch, PairList& list) {
  std::vector<Vec3> stretch(list.pairs.size());
  std::size_t p = 0;
  for (std::size_t o = 0; o < oldPairs.size(); ++o) {
    while (p < list.pairs.size() && list.pairs[p] < oldPairs[o]) ++p;
    if (p < list.pairs.size() && list.pairs[p] == oldPairs[o])
      stretch[p] = oldStretch[o];
    else
      list.endedStretch += squaredNorm(oldStretch[o]);
  }
  list.stretch = std::move(stretch);
}

void makeIncidence(std::size_t particles, PairList& list) {
  list.offsets.assign(particles + 1, 0);
  for (const auto& pair : list.pairs)
    for (const int i : pair) ++list.offsets[static_cast<std::size_t>(i) + 1];
  for (std::size_t i = 0; i < particles; ++i) list.offsets[i + 1] += list.offsets[i];
  list.incident.resize(2 * list.pairs.size());
  std::vector<int> next(list.offsets.begin(), list.offsets.end() - 1);
  for (std::size_t p = 0; p < list.pairs.size(); ++p)
    for (const int i : list.pairs[p])
      list.incident[static_cast<std::size_t>(next[static_cast<std::size_t>(i)]++)] = static_cast<int>(p);
}

void addTo(Particles& particles, const PairList& list, std::size_t p, bool first, bool withTorque) {
  const auto i = static_cast<std::size_t>(list.pairs[p][0]), j = static_cast<std::size_t>(list.pairs[p][1]);
  if (first)
    particles.f[i] += list.force[p];
  else
    particles.f[j] -= list.force[p];
  if (!withTorque) return;
  const PairContact contact = pairContact(particles, i, j);
  if (first)
    particles.torque[i] += cross(contact.armI, list.force[p]);
  else
    particles.torque[j] -= cross(contact.armJ, list.force[p]);
}

}  // namespace

void findPairs(const Particles& particles, double skin, PairList& list) {
  list.skin = requireNonNegative(skin, "skin of the pair list");
  requireFinite(particles.x, "particle", "position", "search for pairs");
  const bool springs = !list.stretch.empty();
  const auto oldPairs = springs ? list.pairs : std::vector<std::array<int, 2>>{};
  list.grid.build(particles.x, particles.radius, skin);
  list.grid.pairs(list.pairs);
  if (springs) keepStretch(oldPairs, list.stretch, list);
  makeIncidence(particles.size(), list);
  list.positionAtBuild = particles.x;
  list.scale.clear();
  ++list.builds;
}

bool updatePairs(const Particles& particles, PairList& list) {
  if (list.builds > 0 && list.positionAtBuild.size() == particles.size()) {
    const double limit = 0.25 * list.skin * list.skin;
    bool near = true;
    // Written so that a NaN asks for a new list, which then names the culprit.
    for (std::size_t i = 0; near && i < particles.size(); ++i)
      near = squaredNorm(particles.x[i] - list.positionAtBuild[i]) <= limit;
    if (near) return false;
  }
  findPairs(particles, list.skin, list);
  return true;
}

namespace detail {

void addPairForces(Particles& particles, const PairList& list, bool withTorque) {
  if (threads() == 1) {
    for (std::size_t p = 0; p < list.pairs.size(); ++p)
      for (const bool first : {true, false}) addTo(particles, list, p, first, withTorque);
    return;
  }
  parallelFor(particles.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int k = list.offsets[i]; k < list.offsets[i + 1]; ++k) {
        const auto p = static_cast<std::size_t>(list.incident[static_cast<std::size_t>(k)]);
        addTo(particles, list, p, list.pairs[p][0] == static_cast<int>(i), withTorque);
      }
  });
}

}  // namespace detail

}  // namespace dovetail::dem
