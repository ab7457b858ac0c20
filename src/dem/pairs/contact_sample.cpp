#include "dovetail/dem/pairs/contact_sample.hpp"

#include <string>

namespace dovetail::dem {

namespace {

void append(ContactSample& sample, int first, int second, const Vec3& from, const Vec3& to, const Vec3& point,
            const Vec3& normal, const Vec3& force) {
  sample.first.push_back(first);
  sample.second.push_back(second);
  sample.from.push_back(from);
  sample.to.push_back(to);
  sample.point.push_back(point);
  sample.normal.push_back(normal);
  sample.force.push_back(force);
}

}  // namespace

namespace detail {

LonePair::LonePair() {
  for (const double x : {0.0, 1.0}) addParticle(particles, {x, 0.0, 0.0}, {}, 1.0, Mass{1.0});
  findPairs(particles, 0.0, list);
}

void LonePair::set(const Particles& all, const PairList& from, std::size_t pair, int memory) {
  const auto copy = [&](auto& mine, const auto& values) {
    if (values.empty()) return;
    mine.resize(2);
    for (std::size_t side = 0; side < 2; ++side) mine[side] = values[static_cast<std::size_t>(from.pairs[pair][side])];
  };
  copy(particles.x, all.x);
  copy(particles.v, all.v);
  copy(particles.radius, all.radius);
  copy(particles.mass, all.mass);
  copy(particles.omega, all.omega);
  copy(particles.material, all.material);
  particles.torque.assign(particles.omega.size(), {});
  particles.f.assign(2, {});
  particles.x[1] -= from.shift(pair);
  if (!from.scale.empty()) list.scale.assign(1, from.scale[pair]);
  list.memory.resize(static_cast<std::size_t>(memory));
  for (std::size_t c = 0; c < list.memory.size(); ++c) list.memory[c] = from.memory[c * from.size() + pair];
}

void appendPair(const LonePair& lone, const std::array<int, 2>& pair, ContactSample& sample) {
  const Particles& two = lone.particles;
  if (two.f[0] == Vec3{}) return;
  const PairContact contact = pairContact(two, 0, 1);
  append(sample, pair[0], pair[1], two.x[0], two.x[1], two.x[0] + contact.armI, contact.normal, two.f[0]);
}

void requireMemory(const PairList& list, int memory) {
  if (list.memory.size() >= static_cast<std::size_t>(memory) * list.size()) return;
  throw InputError("the list remembers " + std::to_string(list.memory.size()) + " numbers for " +
                       std::to_string(list.size()) + " pairs",
                   "sample of contacts", "call collide with the same law first");
}

}  // namespace detail

void addWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallContacts& contacts,
                     ContactSample& sample) {
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (contacts.force[c] == Vec3{}) continue;
    const Vec3 point = contactPoint(contacts, wall, c);
    append(sample, contacts.particle[c], -1, particles.x[static_cast<std::size_t>(contacts.particle[c])], point, point,
           contacts.normal[c], contacts.force[c]);
  }
}

void joinMembers(const Particles& particles, const Bodies& bodies, const Clumps& clumps, ContactSample& sample) {
  std::vector<Vec3> toCentre(particles.size());
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    const auto i = static_cast<std::size_t>(clumps.particle[m]), b = static_cast<std::size_t>(clumps.body[m]);
    toCentre[i] = bodies.x[b] - particles.x[i];
  }
  for (std::size_t c = 0; c < sample.size(); ++c) {
    sample.from[c] += toCentre[static_cast<std::size_t>(sample.first[c])];
    if (sample.second[c] >= 0) sample.to[c] += toCentre[static_cast<std::size_t>(sample.second[c])];
  }
}

}  // namespace dovetail::dem
