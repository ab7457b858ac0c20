// A scene of particles, pairs and walls, and its step.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/core/profile.hpp"
#include "dovetail/dem/bonds/bonds.hpp"
#include "dovetail/dem/laws/common_laws.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"
#include "dovetail/dem/walls/rigid_wall.hpp"

namespace dovetail::dem {

/// A triangulated wall with its contacts, at rest or moved as a function of time.
struct MeshWall {
  TriangulatedWall wall;
  WallCandidates candidates;  ///< candidates.skin is the caller's to set
  WallContacts contacts;
  EdgeRule rule = EdgeRule::projected;
  PrescribedMotion motion;   ///< empty: at rest
  std::vector<Vec3> offset;  ///< with a motion: vertexOffsets
};

/// What happens to particles that leave the domain.
enum class EscapePolicy {
  refuse,  ///< NumericalError with the particle, where it is and how fast
  remove,  ///< it leaves the scene; counted, its mass and energy booked
};

/// Where particles may be. Looked at whenever the grid is asked for pairs.
struct Domain {
  geometry::Box box;  ///< m; centres beyond it have escaped
  EscapePolicy policy = EscapePolicy::refuse;
};

/// What has left the scene.
struct Escaped {
  std::int64_t count = 0;
  double mass = 0.0;    ///< kg
  double energy = 0.0;  ///< kinetic and gravity, J
};

/// Energy by channel, J. `balance` is constant but for the error of the integrator.
struct Energies {
  double kinetic = 0.0, gravity = 0.0, contacts = 0.0;
  ContactWork lost;  ///< its …Power members hold what has been lost so far, J; its energies are not used
  double damping = 0.0, walls = 0.0, escaped = 0.0;
  double stored() const { return kinetic + gravity + contacts; }
  /// stored + lost + damping + escaped − work done by moving walls
  double balance() const { return stored() + lost.lostPower() + damping + escaped - walls; }
};

/// Particles, walls, and what acts on them. All parts but particles and laws may be left empty.
template <class Law>
struct Model {
  Particles particles;
  PairList pairs;  ///< skin (and periodicity) are the caller's to set
  PreparedLaws<Law> laws;
  Vec3 gravity;  ///< m/s²
  std::vector<PrimitiveWall> walls;
  std::vector<MeshWall> meshes;
  Bonds bonds;  ///< between particles; they need particles that spin
  std::optional<Domain> domain;
  double viscousRate = 0.0;   ///< see applyViscousDamping, 1/s
  double localDamping = 0.0;  ///< see applyLocalDamping
  Booking booking = Booking::on;
  int sortEvery =
      16;  ///< particles are sorted at every so many builds of the list (0 = never); Particles::id names them

  double time = 0.0;  ///< s
  std::int64_t steps = 0;
  bool open = false;  ///< between advance and finish velocities lag by half a step
  ContactWork work;   ///< of the last step
  Energies booked;    ///< lost, damping, walls, escaped so far
  Escaped escaped;
  double smallestRadius = 0.0;  ///< m, as last looked up; moves beyond it are looked at one by one
  Profile* profile = nullptr;   ///< where the stages' times go, if wanted
};

namespace detail {

// The parts of a step that know no law.
double beginStep(Particles& particles, double dt, const Vec3& gravity, bool open);
/// @throws NumericalError naming what is not finite or has moved farther than its radius
void requireShortMoves(const Particles& particles, double dt, const std::string& when);
double smallestRadius(const Particles& particles);
void moveWalls(std::vector<PrimitiveWall>& walls, std::vector<MeshWall>& meshes, double time, double dt);
/// Returns old → new numbers if particles were sorted or removed, else nothing.
std::vector<int> checkDomain(Particles& particles, PairList& list, const std::optional<Domain>& domain,
                             const Vec3& gravity, Escaped& escaped, const std::string& when);
void renumberWalls(std::vector<PrimitiveWall>& walls, std::vector<MeshWall>& meshes, std::span<const int> newNumber);
/// Power that moving walls put into the particles, W.
double wallPower(const PrimitiveWall& wall);
double meshPower(const MeshWall& mesh);
std::string when(double time, std::int64_t steps);

/// Times a stage, if anybody asks.
template <class Work>
decltype(auto) timed(Profile* profile, const char* stage, Work&& work) {
  if (!profile) return work();
  const Profile::Stage timer(*profile, stage);
  return work();
}

template <class Law>
void checkMove(Model<Law>& m, double dt) {
  m.smallestRadius = smallestRadius(m.particles);
  requireShortMoves(m.particles, dt, when(m.time, m.steps));
}

template <class Law>
void renewPairs(Model<Law>& m, double moved) {
  const std::int64_t builds = m.pairs.builds;
  updatePairs(m.particles, m.pairs, moved);
  if (m.pairs.builds == builds) return;
  const auto gone = checkDomain(m.particles, m.pairs, m.domain, m.gravity, m.escaped, when(m.time, m.steps));
  if (!gone.empty()) {
    renumberWalls(m.walls, m.meshes, gone);
    renumber(m.bonds, gone);
  }
  if (m.sortEvery > 0 && m.pairs.builds % m.sortEvery == 1) {
    const auto sorted = sortParticles(m.particles, m.pairs);
    renumberWalls(m.walls, m.meshes, sorted);
    renumber(m.bonds, sorted);
  }
}

template <class Law>
ContactWork collideWithWalls(Model<Law>& m, double moved, double dt) {
  ContactWork work;
  for (PrimitiveWall& wall : m.walls) {
    findContacts(m.particles, wall, moved + norm(wall.velocity) * dt);
    work += collide(m.particles, wall, m.laws, dt);
    m.booked.walls += dt * wallPower(wall);
  }
  for (MeshWall& mesh : m.meshes) {
    clearForces(mesh.wall);
    mesh.wall.rigid = true;
    if (mesh.motion)
      updateWallCandidates(m.particles, mesh.wall, mesh.candidates);
    else
      updateWallCandidates(m.particles, mesh.wall, mesh.candidates, 0.0, moved);
    findWallContacts(m.particles, mesh.wall, mesh.candidates, mesh.rule, mesh.contacts);
    work += collideWithWall(m.particles, mesh.wall, mesh.contacts, m.laws, dt);
    addWallForces(mesh.contacts, mesh.wall);
    m.booked.walls += dt * meshPower(mesh);
  }
  return work;
}

void requireBelow(const ContactStep& limit, double dt);
void bookLosses(Energies& booked, const ContactWork& work, double dt);
double applyDamping(Particles& particles, double viscousRate, double local);

}  // namespace detail

/// One step of velocity Verlet up to the forces; the last half kick is left to the next advance or to finish:
///   half kick · half kick · drift · walls · pairs · contacts · bonds · damping
/// @throws NumericalError naming a particle that is not finite, moved farther than its own radius in this step (it
/// could
///         pass through walls and others unseen), or escaped, with the time
template <class Law>
void advance(Model<Law>& m, double dt) {
  using detail::timed;
  const double moved = timed(m.profile, "move", [&] { return detail::beginStep(m.particles, dt, m.gravity, m.open); });
  if (!(moved <= m.smallestRadius)) detail::checkMove(m, dt);
  m.open = true;
  m.time += dt;
  ++m.steps;
  detail::moveWalls(m.walls, m.meshes, m.time, dt);
  timed(m.profile, "find pairs", [&] { detail::renewPairs(m, moved); });
  m.work = timed(m.profile, "pairs", [&] { return collide(m.particles, m.pairs, m.laws, dt, m.booking); });
  if (!m.walls.empty() || !m.meshes.empty())
    timed(m.profile, "walls", [&] { m.work += detail::collideWithWalls(m, moved, dt); });
  if (m.bonds.size() > 0 || m.bonds.ended > 0.0)
    timed(m.profile, "bonds", [&] { m.work += exchangeBonds(m.particles, m.bonds, dt); });
  if (m.viscousRate > 0.0 || m.localDamping > 0.0)
    m.booked.damping += dt * detail::applyDamping(m.particles, m.viscousRate, m.localDamping);
  if (m.booking == Booking::on) detail::bookLosses(m.booked, m.work, dt);
}

/// The half kick that ends a step, so that positions and velocities belong to one time. Does nothing if there is none
/// to make.
template <class Law>
void finish(Model<Law>& m, double dt) {
  if (m.open) kick(m.particles, 0.5 * dt);
  m.open = false;
}

/// advance and finish, n times (finish once: the digits are the same).
template <class Law>
void run(Model<Law>& m, double dt, std::int64_t n) {
  for (std::int64_t i = 0; i < n; ++i) advance(m, dt);
  finish(m, dt);
}

/// The largest stable step with the contacts as they are now, and who sets it (see ContactDemand). A scene that is yet
/// to collide has none: take `leastOverlap` then, the overlap to be expected, m.
template <class Law>
ContactStep criticalStep(const Model<Law>& m, double leastOverlap = 0.0) {
  ContactDemand demand;
  addDemand(demand, m.particles, m.pairs, m.laws, leastOverlap);
  for (const PrimitiveWall& wall : m.walls)
    if (wall.contacts.size() > 0) addWallDemand(demand, m.particles, wall.contacts, m.laws, wall.material);
  for (const MeshWall& mesh : m.meshes)
    if (mesh.contacts.size() > 0) addWallDemand(demand, m.particles, mesh.contacts, m.laws, mesh.wall.material);
  return criticalStep(demand, m.particles);
}

/// @throws InputError naming the contact that sets the limit if dt is beyond it
template <class Law>
void requireStableStep(const Model<Law>& m, double dt, double leastOverlap = 0.0) {
  detail::requireBelow(criticalStep(m, leastOverlap), dt);
}

/// Energies now, J; contact energies and losses need booking. Gravity counts from the origin. Call after finish:
/// between advance and finish velocities lag by half a step, and so does the kinetic energy.
template <class Law>
Energies energies(const Model<Law>& m) {
  Energies e = m.booked;
  e.kinetic = kineticEnergy(m.particles);
  for (std::size_t i = 0; i < m.particles.size(); ++i)
    e.gravity -= m.particles.mass[i] * dot(m.gravity, m.particles.x[i]);
  e.contacts = m.work.storedEnergy();
  e.escaped = m.escaped.energy;
  return e;
}

}  // namespace dovetail::dem
