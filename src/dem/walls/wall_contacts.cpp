#include "dovetail/dem/walls/wall_contacts.hpp"

#include <algorithm>
#include <utility>

#include "dovetail/dem/walls/facet_spin.hpp"
#include "wall_sweep.hpp"

namespace dovetail::dem {

void clear(WallContacts& contacts) { resize(contacts, 0); }

void resize(WallContacts& contacts, std::size_t count) {
  forArrays(contacts, contacts, [count](auto& own, const auto&) { own.resize(std::min(count, own.size())); });
  contacts.force.resize(count);
}

namespace {

void findContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                  const WallClearances* clearances, EdgeRule rule, WallContacts& contacts) {
  switch (rule) {
    case EdgeRule::projected:
      return projectWallContacts(particles, wall, candidates, clearances, contacts);
    case EdgeRule::paper:
      return paperWallContacts(particles, wall, candidates, clearances, contacts);
  }
}

}  // namespace

void findWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                      EdgeRule rule, WallContacts& contacts) {
  findContacts(particles, wall, candidates, nullptr, rule, contacts);
}

void findWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                      const WallClearances& clearances, EdgeRule rule, WallContacts& contacts) {
  findContacts(particles, wall, candidates, &clearances, rule, contacts);
}

namespace detail {

void readAs(const WallMemoryKind& kind, int memory, std::size_t contacts, WallMemoryKind& of,
            std::vector<double>& remembered) {
  const auto numbers = static_cast<std::size_t>(memory), springs = static_cast<std::size_t>(memory - kind.velocities);
  const WallMemoryKind before = std::exchange(of, kind);
  if (before == kind && remembered.size() == numbers * contacts) return;
  const std::size_t numbersBefore = springs + static_cast<std::size_t>(before.velocities);
  const bool stay =
      before.velocities >= 0 && before.springs == kind.springs && remembered.size() == numbersBefore * contacts;
  const std::vector<double> old = std::exchange(remembered, std::vector<double>(numbers * contacts, 0.0));
  for (std::size_t c = 0; stay && c < contacts; ++c)
    for (std::size_t m = 0; m < springs; ++m) remembered[c * numbers + m] = old[c * numbersBefore + m];
}

void forgetVelocities(std::vector<double>& memory, std::size_t contacts, int springs) {
  const auto numbers = contacts == 0 ? std::ptrdiff_t{0} : static_cast<std::ptrdiff_t>(memory.size() / contacts);
  for (auto one = memory.begin(); numbers > springs && one != memory.end(); one += numbers)
    std::fill(one + springs, one + numbers, 0.0);
}

void addEnded(EndedMemories& ended, const Particles& particles, int particle, const std::vector<double>& memory,
              std::size_t contact, std::size_t components, double fraction) {
  if (components == 0) return;
  const auto i = static_cast<std::size_t>(particle);
  ended.material.push_back(i < particles.material.size() ? particles.material[i] : std::uint8_t{0});
  const auto first = memory.begin() + static_cast<std::ptrdiff_t>(contact * components);
  ended.memory.insert(ended.memory.end(), first, first + static_cast<std::ptrdiff_t>(components));
  ended.fraction.push_back(fraction * particles.weightOf(i));
}

}  // namespace detail

double renumber(WallContacts& contacts, std::span<const int> newNumber) {
  WallSprings& springs = contacts.springs;
  WallSprings old = std::move(springs);
  springs = {};
  springs.memoryKind = old.memoryKind;
  const std::size_t count = old.particle.size(), components = count == 0 ? 0 : old.memory.size() / count;
  std::vector<std::pair<int, std::size_t>> kept;
  for (std::size_t c = 0; c < count; ++c)
    if (const int i = newNumber[static_cast<std::size_t>(old.particle[c])]; i >= 0) kept.emplace_back(i, c);
  std::sort(kept.begin(), kept.end());
  for (const auto& [i, c] : kept) {
    springs.particle.push_back(i);
    springs.normal.push_back(old.normal[c]);
    springs.fraction.push_back(old.fraction[c]);
    for (std::size_t m = 0; m < components; ++m) springs.memory.push_back(old.memory[c * components + m]);
  }
  return detail::energyOfLeavers(contacts, newNumber);
}

void addWallForces(const WallContacts& contacts, std::span<const Vec3> x, std::span<const geometry::Facet> facets,
                   std::span<Vec3> f) {
  const bool couples = contacts.couple.size() == contacts.size();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto& vertex = facets[static_cast<std::size_t>(contacts.facet[c])];
    for (std::size_t k = 0; k < 3; ++k)
      f[static_cast<std::size_t>(vertex[k])] -= contacts.weight[c][k] * contacts.force[c];
    if (!couples || contacts.couple[c] == Vec3{}) continue;
    const auto at = [&](std::size_t k) { return x[static_cast<std::size_t>(vertex[k])]; };
    const std::array<Vec3, 3> pair = FacetSpin(at(0), at(1), at(2)).forces(contacts.couple[c]);
    for (std::size_t k = 0; k < 3; ++k) f[static_cast<std::size_t>(vertex[k])] -= pair[k];
  }
}

}  // namespace dovetail::dem
