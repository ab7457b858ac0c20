#include "dovetail/dem/pairs/contact_sample.hpp"

#include <string>

namespace dovetail::dem {

namespace {

void append(ContactSample& sample, int first, int second, const Vec3& from, const Vec3& to, const Vec3& point,
            const Vec3& normal, const Vec3& force, const Vec3& torqueFirst, const Vec3& torqueSecond) {
  sample.first.push_back(first);
  sample.second.push_back(second);
  sample.from.push_back(from);
  sample.to.push_back(to);
  sample.point.push_back(point);
  sample.normal.push_back(normal);
  sample.force.push_back(force);
  sample.torqueFirst.push_back(torqueFirst);
  sample.torqueSecond.push_back(torqueSecond);
}

/// @param arm from the particle's centre to the contact point on the wall, m
template <class Contacts>
void appendWall(const Particles& particles, const Contacts& contacts, std::size_t c, const Vec3& arm,
                ContactSample& sample) {
  if (contacts.force[c] == Vec3{}) return;
  const Vec3 from = particles.x[static_cast<std::size_t>(contacts.particle[c])], force = contacts.force[c];
  const bool torques = contacts.couple.size() == contacts.size();
  const Vec3 couple = torques ? contacts.couple[c] : Vec3{};
  append(sample, contacts.particle[c], -1, from, from + arm, from + arm, contacts.normal[c], force,
         torques ? cross(arm, force) + couple : Vec3{}, -couple);
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
  const bool spins = two.rotates();
  append(sample, pair[0], pair[1], two.x[0], two.x[1], two.x[0] + contact.armI, contact.normal, two.f[0],
         spins ? two.torque[0] : Vec3{}, spins ? two.torque[1] : Vec3{});
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
  for (std::size_t c = 0; c < contacts.size(); ++c)
    appendWall(particles, contacts, c, contactArm(particles, contacts, wall, c), sample);
}

void addWallContacts(const Particles& particles, const PrimitiveWall& wall, ContactSample& sample) {
  const PrimitiveContacts& contacts = wall.contacts;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double radius = particles.radius[static_cast<std::size_t>(contacts.particle[c])];
    appendWall(particles, contacts, c, (contacts.overlap[c] - radius) * contacts.normal[c], sample);
  }
}

void joinMembers(const Particles& particles, const Bodies& bodies, const Clumps& clumps, ContactSample& sample) {
  std::vector<Vec3> toCentre(particles.size());
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    const auto i = static_cast<std::size_t>(clumps.particle[m]), b = static_cast<std::size_t>(clumps.body[m]);
    toCentre[i] = bodies.x[b] - particles.x[i];
  }
  for (std::size_t c = 0; c < sample.size(); ++c) {
    const auto moveEnd = [&](int particle, Vec3& end, const Vec3& force, Vec3& torque) {
      const Vec3& move = toCentre[static_cast<std::size_t>(particle)];
      end += move;
      torque -= cross(move, force);
    };
    moveEnd(sample.first[c], sample.from[c], sample.force[c], sample.torqueFirst[c]);
    if (sample.second[c] >= 0) moveEnd(sample.second[c], sample.to[c], -sample.force[c], sample.torqueSecond[c]);
  }
}

}  // namespace dovetail::dem
