#include "dovetail/dem/model/snapshot.hpp"

#include <numbers>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"

namespace dovetail::dem {

namespace {

double volumeOf(const Particles& particles, std::size_t i) {
  const double r = particles.radius[i];
  return particles.weightOf(i) * 4.0 / 3.0 * std::numbers::pi * r * r * r;
}

void addParticle(Snapshot& snapshot, const Vec3& x, const Vec3& v, double mass, double volume) {
  snapshot.x.push_back(x);
  snapshot.v.push_back(v);
  snapshot.mass.push_back(mass);
  snapshot.volume.push_back(volume);
}

void addFreeParticles(const Particles& particles, Snapshot& snapshot) {
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!particles.isMember(i))
      addParticle(snapshot, particles.x[i], particles.v[i], particles.weightOf(i) * particles.mass[i],
                  volumeOf(particles, i));
}

/// Members lie by body.
void addClumps(const Particles& particles, const BodyTerm& term, Snapshot& snapshot) {
  const Clumps& clumps = term.clumps;
  for (std::size_t m = 0; m < clumps.size();) {
    const auto b = static_cast<std::size_t>(clumps.body[m]);
    double volume = 0.0;
    for (; m < clumps.size() && clumps.body[m] == static_cast<int>(b); ++m)
      volume += volumeOf(particles, static_cast<std::size_t>(clumps.particle[m]));
    addParticle(snapshot, term.bodies.x[b], term.bodies.v[b], term.bodies.mass[b], volume);
  }
}

void addBonds(const BondSample& bonds, ContactSample& sample) {
  const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  append(sample.first, bonds.first);
  append(sample.second, bonds.second);
  append(sample.from, bonds.from);
  append(sample.to, bonds.to);
  append(sample.force, bonds.force);
  append(sample.torqueFirst, bonds.torqueFirst);
  append(sample.torqueSecond, bonds.torqueSecond);
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    sample.point.push_back(0.5 * (bonds.from[b] + bonds.to[b]));
    sample.normal.push_back(normalized(bonds.from[b] - bonds.to[b]));
  }
}

}  // namespace

Snapshot takeSnapshot(const Model& m) {
  if (m.open != 0.0)
    throw InputError("velocities lag behind positions", "snapshot of a model", "call close(model) before");
  ContactSample contacts = sampleContacts(m);
  Snapshot snapshot;
  snapshot.time = m.time;
  snapshot.space = m.pairs.periodicity();
  const auto rigid = m.terms.all<BodyTerm>();
  addFreeParticles(m.particles, snapshot);
  for (const BondTerm* term : m.terms.all<BondTerm>())
    addBonds(sampleBonds(m.particles, term->bonds, snapshot.space), contacts);
  for (const BodyTerm* term : rigid) {
    addClumps(m.particles, *term, snapshot);
    joinMembers(m.particles, term->bodies, term->clumps, snapshot.space, contacts);
  }
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (contacts.second[c] < 0) {
      snapshot.wallPoint.push_back(contacts.to[c]);
      snapshot.wallForce.push_back(contacts.force[c]);
    }
  snapshot.from = std::move(contacts.from);
  snapshot.to = std::move(contacts.to);
  snapshot.force = std::move(contacts.force);
  return snapshot;
}

}  // namespace dovetail::dem
