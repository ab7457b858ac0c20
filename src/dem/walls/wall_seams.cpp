#include "dovetail/dem/walls/wall_seams.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include "dovetail/dem/walls/edge_contact_solver.hpp"
#include "dovetail/dem/walls/wall_collide.hpp"
#include "met_facets.hpp"

namespace dovetail::dem {

namespace {

/// A row of what contacts remember goes to another wall, behind those of the same particle there.
void moveSpring(WallSprings& from, std::size_t row, WallSprings& to) {
  const std::size_t components = from.memory.size() / from.particle.size();
  const auto at = std::upper_bound(to.particle.begin(), to.particle.end(), from.particle[row]) - to.particle.begin();
  const auto pass = [&](auto& source, auto& target, std::size_t width) {
    const auto begin = source.begin() + static_cast<std::ptrdiff_t>(row * width),
               end = begin + static_cast<std::ptrdiff_t>(width);
    target.insert(target.begin() + at * static_cast<std::ptrdiff_t>(width), begin, end);
    source.erase(begin, end);
  };
  pass(from.memory, to.memory, components);
  pass(from.normal, to.normal, 1);
  pass(from.fraction, to.fraction, 1);
  pass(from.particle, to.particle, 1);
}

bool isAbsent(const WallAtSeam& wall, int particle) {
  return !wall.absent.empty() && wall.absent[static_cast<std::size_t>(particle)] != 0;
}

/// Those that have contacts with more than one wall, ascending.
std::vector<int> touchSeveral(std::span<const WallAtSeam> walls) {
  std::vector<int> touching, own, several, all;
  for (const WallAtSeam& w : walls) {
    own.clear();
    for (const int i : w.contacts->particle)
      if ((own.empty() || own.back() != i) && !isAbsent(w, i)) own.push_back(i);
    std::set_intersection(touching.begin(), touching.end(), own.begin(), own.end(), std::back_inserter(several));
    all.clear();
    std::set_union(touching.begin(), touching.end(), own.begin(), own.end(), std::back_inserter(all));
    touching.swap(all);
  }
  std::sort(several.begin(), several.end());
  several.erase(std::unique(several.begin(), several.end()), several.end());
  return several;
}

void keepContacts(const WallContacts& contacts, int particle, WallContacts& kept) {
  const auto at = std::lower_bound(contacts.particle.begin(), contacts.particle.end(), particle);
  for (auto c = static_cast<std::size_t>(at - contacts.particle.begin());
       c < contacts.size() && contacts.particle[c] == particle; ++c)
    appendContact(kept, contacts, c);
}

/// Contacts of one particle with all walls together, each wall's into its own list.
void meetTogether(const Particles& particles, std::span<const WallAtSeam> walls, int particle,
                  std::vector<WallContacts>& fresh) {
  std::vector<Encounter> encounters;
  std::vector<std::size_t> number, first;
  for (std::size_t w = 0; w < walls.size(); ++w) {
    if (isAbsent(walls[w], particle)) {
      keepContacts(*walls[w].contacts, particle, fresh[w]);
      continue;
    }
    const std::vector<int>& listed = walls[w].candidates->particle;
    const auto at = std::lower_bound(listed.begin(), listed.end(), particle);
    if (at == listed.end() || *at != particle) continue;
    encounters.push_back(
        encounter(particles, *walls[w].candidates, walls[w].clearances, static_cast<std::size_t>(at - listed.begin())));
    number.push_back(w);
    first.push_back(fresh[w].size());
  }
  std::vector<MetWall> met;
  for (std::size_t k = 0; k < encounters.size(); ++k)
    met.push_back({encounters[k], walls[number[k]].wall, &fresh[number[k]]});
  projectParticle(met);
  for (std::size_t k = 0; k < met.size(); ++k)
    if (const double reach = walls[number[k]].candidates->reach; reach > 0.0)
      appendBeyondTouch(encounters[k], *met[k].wall, reach, couplingBlend, first[k], fresh[number[k]]);
}

/// Puts in what has been found for these particles, in place of what was there.
void replace(WallContacts& contacts, std::span<const int> particles, const WallContacts& fresh) {
  WallContacts joined;
  std::size_t next = 0;
  const auto takeUpTo = [&](int particle) {
    for (; next < fresh.size() && fresh.particle[next] < particle; ++next) appendContact(joined, fresh, next);
  };
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    takeUpTo(contacts.particle[c]);
    if (!std::binary_search(particles.begin(), particles.end(), contacts.particle[c]))
      appendContact(joined, contacts, c);
  }
  takeUpTo(std::numeric_limits<int>::max());
  forArrays(contacts, joined, [](auto& to, const auto& from) { to.assign(from.begin(), from.end()); });
  contacts.force.assign(contacts.size(), Vec3{});
}

/// Whether one of the particle's rows in a list sorted by particle is at the place that a normal tells.
bool has(const std::vector<int>& particle, const std::vector<Vec3>& normal, int i, const Vec3& n) {
  const auto [begin, end] = std::equal_range(particle.begin(), particle.end(), i);
  for (auto at = begin; at != end; ++at)
    if (dot(normal[static_cast<std::size_t>(at - particle.begin())], n) > detail::samePlace) return true;
  return false;
}

/// What contacts of `from` remember of a particle that go on as contacts of `to`.
void handOver(WallContacts& from, WallContacts& to, int i) {
  WallSprings& old = from.springs;
  if (to.springs.particle.empty()) to.springs.memoryKind = old.memoryKind;
  if (to.springs.memoryKind != old.memoryKind) return;
  const auto [begin, end] = std::equal_range(old.particle.begin(), old.particle.end(), i);
  const auto first = static_cast<std::size_t>(begin - old.particle.begin());
  for (auto o = static_cast<std::size_t>(end - old.particle.begin()); o-- > first;) {
    const Vec3 n = old.normal[o];
    if (!has(from.particle, from.normal, i, n) && has(to.particle, to.normal, i, n) &&
        !has(to.springs.particle, to.springs.normal, i, n))
      moveSpring(old, o, to.springs);
  }
}

void handOver(const AnsweredContacts& from, const AnsweredContacts& to) {
  std::vector<int> both;
  const std::vector<int>&remembered = from.contacts->springs.particle, &touching = to.contacts->particle;
  std::set_intersection(remembered.begin(), remembered.end(), touching.begin(), touching.end(),
                        std::back_inserter(both));
  if (both.empty() || !sameAnswer(from.answer, to.answer)) return;
  both.erase(std::unique(both.begin(), both.end()), both.end());
  for (const int i : both) handOver(*from.contacts, *to.contacts, i);
}

void joinAlike(const Particles& particles, std::span<const WallAtSeam> walls) {
  const std::vector<int> several = touchSeveral(walls);
  if (several.empty()) return;
  std::vector<WallContacts> fresh(walls.size());
  for (const int particle : several) meetTogether(particles, walls, particle, fresh);
  for (std::size_t w = 0; w < walls.size(); ++w) replace(*walls[w].contacts, several, fresh[w]);
}

}  // namespace

void joinAtSeams(const Particles& particles, std::span<const WallAtSeam> walls) {
  if (walls.size() < 2) return;
  std::vector<WallAtSeam> rest(walls.begin(), walls.end());
  while (rest.size() > 1) {
    const WallAnswer first = rest.front().answer;
    const auto alike = std::stable_partition(rest.begin(), rest.end(),
                                             [&](const WallAtSeam& w) { return !sameAnswer(w.answer, first); });
    joinAlike(particles, {alike, rest.end()});
    rest.erase(alike, rest.end());
  }
}

void passMemories(std::span<const AnsweredContacts> walls) {
  for (const AnsweredContacts& from : walls)
    for (const AnsweredContacts& to : walls)
      if (from.contacts != to.contacts) handOver(from, to);
}

}  // namespace dovetail::dem
