#include "dovetail/dem/contact_sample.hpp"

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

void appendPairs(const Particles& particles, const PairList& list, std::size_t first, std::size_t n,
                 const ContactBlock& block, ContactSample& sample) {
  for (std::size_t l = 0; l < n; ++l) {
    const Vec3 force = block.velocity.at(l);
    if (force == Vec3{}) continue;
    const auto& pair = list.pairs[first + l];
    const auto i = static_cast<std::size_t>(pair[0]), j = static_cast<std::size_t>(pair[1]);
    const Vec3 shift = list.shift(first + l);
    const PairContact contact = pairContact(particles, i, j, shift);
    append(sample, pair[0], pair[1], particles.x[i], particles.x[j] - shift, particles.x[i] + contact.armI,
           contact.normal, force);
  }
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

}  // namespace dovetail::dem
