#include "dovetail/dem/pairs/contact_sample.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace dovetail::dem {

namespace {

template <class Visit>
void forEachArray(Visit&& visit) {
  visit(&ContactSample::first);
  visit(&ContactSample::second);
  visit(&ContactSample::from);
  visit(&ContactSample::to);
  visit(&ContactSample::point);
  visit(&ContactSample::normal);
  visit(&ContactSample::force);
  visit(&ContactSample::torqueFirst);
  visit(&ContactSample::torqueSecond);
}

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

PairsApart::PairsApart(std::size_t count) {
  for (std::size_t k = 0; k < count; ++k)
    for (const double x : {0.0, 1.0})
      addParticle(particles, {4.0 * static_cast<double>(k) + x, 0.0, 0.0}, {}, 1.0, Mass{1.0});
  list.setSkin(0.0);
  findPairs(particles, list);
}

void PairsApart::take(const Particles& all, const PairList& from, std::size_t first, int memory) {
  const std::size_t count = list.size();
  const auto copy = [&](auto& mine, const auto& values) {
    if (values.empty()) return;
    mine.resize(2 * count);
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t side = 0; side < 2; ++side)
        mine[2 * k + side] = values[static_cast<std::size_t>(from.pairs()[first + k][side])];
  };
  copy(particles.x, all.x);
  copy(particles.v, all.v);
  copy(particles.radius, all.radius);
  copy(particles.mass, all.mass);
  copy(particles.weight, all.weight);  // dashpots are made for the fraction of the mass
  copy(particles.omega, all.omega);
  copy(particles.material, all.material);
  particles.torque.assign(particles.omega.size(), {});
  particles.f.assign(2 * count, {});
  for (std::size_t k = 0; k < count; ++k) particles.x[2 * k + 1] -= from.shift(first + k);
  if (!from.factors().empty()) std::copy_n(from.factors().data() + first, count, list.writeFactors().begin());
  const std::span<double> numbers = list.prepareMemory(memory, 0, from.memoryKind());
  for (std::size_t c = 0; c < static_cast<std::size_t>(memory); ++c)
    for (std::size_t k = 0; k < count; ++k) numbers[c * count + k] = from.memory()[c * from.size() + first + k];
}

void appendPairs(const PairsApart& apart, const PairList& list, std::size_t first, ContactSample& sample) {
  const Particles& p = apart.particles;
  const bool spins = p.rotates();
  for (std::size_t k = 0; k < apart.list.size(); ++k) {
    const std::size_t i = 2 * k, j = i + 1;
    if (p.f[i] == Vec3{}) continue;
    const PairContact contact = pairContact(p, i, j);
    append(sample, list.pairs()[first + k][0], list.pairs()[first + k][1], p.x[i], p.x[j], p.x[i] + contact.armI,
           contact.normal, p.f[i], spins ? p.torque[i] : Vec3{}, spins ? p.torque[j] : Vec3{});
  }
}

void reserve(ContactSample& sample, std::size_t contacts) {
  forEachArray([&](auto ContactSample::*array) { (sample.*array).reserve(contacts); });
}

ContactSample joined(std::vector<ContactSample> parts) {
  if (parts.size() == 1) return std::move(parts[0]);
  std::vector<std::size_t> begin(parts.size() + 1, 0);
  for (std::size_t k = 0; k < parts.size(); ++k) begin[k + 1] = begin[k] + parts[k].size();
  ContactSample all;
  forEachArray([&](auto ContactSample::*array) { (all.*array).resize(begin.back()); });
  parallelFor(parts.size(), 1, [&](std::size_t part, std::size_t) {
    forEachArray([&](auto ContactSample::*array) {
      std::copy((parts[part].*array).begin(), (parts[part].*array).end(),
                (all.*array).begin() + static_cast<std::ptrdiff_t>(begin[part]));
    });
  });
  return all;
}

void requireMemory(const PairList& list, int memory) {
  if (list.memory().size() >= static_cast<std::size_t>(memory) * list.size()) return;
  throw InputError("the list has " + std::to_string(list.memory().size()) + " numbers of memory for " +
                       std::to_string(list.size()) + " pairs",
                   "sample of contacts", "call ContactLaws::pairs of the same law first");
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

void joinMembers(const Particles& particles, const Bodies& bodies, const Clumps& clumps,
                 const geometry::Periodicity& space, ContactSample& sample) {
  std::vector<Vec3> toCentre(particles.size());
  for (std::size_t m = 0; m < clumps.size(); ++m) {
    const auto i = static_cast<std::size_t>(clumps.particle[m]), b = static_cast<std::size_t>(clumps.body[m]);
    toCentre[i] = space.minimumImage(bodies.x[b] - particles.x[i]);
  }
  const auto moveEnd = [&](int particle, Vec3& end, const Vec3& force, Vec3& torque) {
    const Vec3& move = toCentre[static_cast<std::size_t>(particle)];
    end += move;
    torque -= cross(move, force);
  };
  parallelFor(sample.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      moveEnd(sample.first[c], sample.from[c], sample.force[c], sample.torqueFirst[c]);
      if (sample.second[c] >= 0) moveEnd(sample.second[c], sample.to[c], -sample.force[c], sample.torqueSecond[c]);
    }
  });
}

}  // namespace dovetail::dem
