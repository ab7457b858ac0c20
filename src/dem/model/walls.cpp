#include "dovetail/dem/model/walls.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "../bodies/carried_walls.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/pairs/contact_sample.hpp"
#include "dovetail/dem/setup/insertion.hpp"
#include "dovetail/dem/walls/wall_archive.hpp"
#include "dovetail/dem/walls/wall_checks.hpp"
#include "dovetail/dem/walls/wall_seams.hpp"
#include "events.hpp"

namespace dovetail::dem {

namespace {

/// Rows of the table of laws; 1: a single law serves all materials.
int materialsOf(const Model& m) { return m.laws ? m.laws->materials() : 1; }

bool carried(const MeshWall& mesh) { return std::holds_alternative<WallOnBody>(mesh.motion); }

template <class WallTerm>
auto& numbered(auto& m, std::size_t i, const char* kind) {
  const auto found = m.terms.template all<WallTerm>();
  if (i >= found.size())
    throw InputError("there is no " + std::string(kind) + " " + std::to_string(i), "walls of the model",
                     "the model has " + std::to_string(found.size()));
  return *found[i];
}

}  // namespace

Moves movesOf(const Model& m, const Step& step) {
  return {step.moved, Moves::unknown, m.pairs.travel(), m.pairs.builds()};
}

namespace {
/// Lists that were made for these particles, as a damaged checkpoint may not have them.
void requireNumbers(std::span<const int> list, std::size_t end, const char* what) {
  for (const int number : list)
    if (number < 0 || static_cast<std::size_t>(number) >= end)
      throw InputError(std::string("there is no ").append(what).append(" ") + std::to_string(number),
                       "list of what is near a wall", "take an older checkpoint");
}
}  // namespace

void PrimitiveWallTerm::check(const Model& m) const {
  requireLaws(m);
  validate(wall, materialsOf(m), m.pairs.periodicity());
  if (wall.search.particleRevision == m.particles.revision)
    requireNumbers(wall.search.near, m.particles.size(), "particle");
  requireRows(wall.contacts, {m.particles.size(), 0});
}

void PrimitiveWallTerm::surround(Surroundings& around) {
  if (present) around.walls.push_back(&wall);
}
void MeshWallTerm::surround(Surroundings& around) {
  if (present) around.meshes.push_back(&mesh.wall);
}

namespace {
constexpr const char* loadOfTime = "a load of time";

std::string codeOf(const WallServo& servo) { return servo.loadAt ? loadOfTime : ""; }

/// Of contacts from the axis of one that turns, m.
template <class PointOf>
double largestLever(const WallServo& servo, std::size_t contacts, const PointOf& pointOf) {
  double lever = 0.0;
  for (std::size_t c = 0; servo.turns && c < contacts; ++c) lever = std::max(lever, servo.leverOf(pointOf(c)));
  return lever;
}
}  // namespace

std::string PrimitiveWallTerm::code() const {
  if (wall.motion) return "a motion";
  return wall.servo ? codeOf(*wall.servo) : "";
}

double PrimitiveWallTerm::move(Model& m, const Step& step) {
  if (!present && wall.servo) return 0.0;
  kickWall(wall, 0.5 * (step.closing + step.dt));
  if (wall.servo) setLoad(*wall.servo, step.time);
  if (wall.motion) {
    const double power = drivingPower(wall);
    const Vec3 point = wall.point, axis = wall.axis;
    wall.motion(step.time, wall);
    // The half kick that begins the step has been booked with the velocity of the step before. A motion that places the
    // wall as well gives velocities at instants, which are those of the half kicks on both sides.
    if (wall.point == point && wall.axis == axis) m.booked.walls += 0.5 * step.dt * (drivingPower(wall) - power);
  }
  drift(wall, step.dt);
  return 0.0;
}

double PrimitiveWallTerm::renumber(std::span<const int> newNumber, const Particles&) {
  const double gone = dem::renumber(wall, newNumber);
  stored -= gone;
  return gone;
}

void PrimitiveWallTerm::addForces(Model& m, const Step& step) {
  if (!present) return;
  wall.reach = m.pairs.reach();
  findContacts(m.particles, wall, movesOf(m, step), m.pairs.periodicity());
  const ContactWork work = m.laws->wall(m.particles, wall, step.dt, m.booking);
  stored = work.storedEnergy();
  m.work += work;
  m.rate.walls += drivingPower(wall);
}

void PrimitiveWallTerm::close(Model&, double dt) {
  if (present) kickWall(wall, 0.5 * dt);
}

void PrimitiveWallTerm::addDemand(const Model& m, ContactDemand& demand) const {
  if (!m.laws || wall.contacts.size() == 0) return;
  const std::size_t first = demand.links.size();
  m.laws->addDemand(demand, m.particles, wall);
  if (!wall.servo) return;
  const PrimitiveContacts& c = wall.contacts;
  const double lever = largestLever(*wall.servo, c.size(), [&](std::size_t k) {
    return m.particles.x[static_cast<std::size_t>(c.particle[k])] + c.shift(k);
  });
  demand.standOn(first, &*wall.servo, wall.servo->inverseMass(lever));
}

namespace {
void addServo(Energies& e, const WallServo& servo) {
  e.kinetic += servo.kineticEnergy();
  e.damping += servo.lost;
  e.external += servo.work;
}
}  // namespace

void PrimitiveWallTerm::addEnergies(const Model&, Energies& e) const {
  if (wall.servo) addServo(e, *wall.servo);
}

namespace {

/// What describes a wall, and is the caller's where the model is set up already.
template <class Archive, class Wall>
void describe(Archive& a, Wall& w) {
  bool servo = w.servo.has_value();
  a(w.shape, w.radius, w.inside, w.material, w.skin, servo);
  if constexpr (Archive::reads)
    if (servo && !w.servo) w.servo.emplace();
}
template <class Archive, class Mesh>
void describeMesh(Archive& a, Mesh& m) {
  bool servo = std::holds_alternative<WallServo>(m.motion), carried = std::holds_alternative<WallOnBody>(m.motion);
  a(m.wall.facets, m.wall.oneSided, m.wall.material, m.rule, m.offset, m.surfaceVelocity, m.candidates.skin, servo,
    carried);
  if constexpr (Archive::reads) {
    if (servo && !std::holds_alternative<WallServo>(m.motion)) m.motion = WallServo{};
    if (carried && !std::holds_alternative<WallOnBody>(m.motion)) m.motion = WallOnBody{};
  }
  if (auto* carrier = std::get_if<WallOnBody>(&m.motion)) a(carrier->body, carrier->offset);
}

}  // namespace

void PrimitiveWallTerm::addOutside(const Model&, Momenta& force, Momenta&) const {
  force.linear -= wall.force;
  force.angular -= wall.torque + cross(wall.point, wall.force);
}

void PrimitiveWallTerm::addContacts(const Model& m, ContactSample& sample) const {
  addWallContacts(m.particles, wall, sample);
}

void PrimitiveWallTerm::save(ByteWriter& writer) const {
  describe(writer, wall);
  archiveWall(writer, wall);
  writer(stored);
}
void PrimitiveWallTerm::load(ByteReader& reader) {
  describe(reader, wall);
  archiveWall(reader, wall);
  requireWhole(wall.contacts);
  reader(stored);
}

void MeshWallTerm::check(const Model& m) const {
  requireLaws(m);
  validate(mesh, materialsOf(m));
  requireNumbers(mesh.candidates.facet, mesh.wall.facets.size(), "facet");
  const bool current = mesh.candidates.particleRevision == m.particles.revision;
  if (current) requireNumbers(mesh.candidates.particle, m.particles.size(), "particle");
  requireRows(mesh.contacts, {m.particles.size(), mesh.wall.facets.size()}, current);
  if (const auto* carrier = std::get_if<WallOnBody>(&mesh.motion)) checkCarrier(m, *carrier, mesh.wall.x.size());
}

std::string MeshWallTerm::code() const {
  if (std::holds_alternative<PrescribedMotion>(mesh.motion)) return "a motion";
  if (const auto* servo = std::get_if<WallServo>(&mesh.motion)) return codeOf(*servo);
  return std::holds_alternative<MovedByOthers>(mesh.motion) ? "somebody who moves it" : "";
}

double MeshWallTerm::move(Model&, const Step& step) {
  if (carried(mesh)) return 0.0;  // its body moves it
  if (!present && std::holds_alternative<WallServo>(mesh.motion)) return 0.0;
  kickWall(mesh, 0.5 * (step.closing + step.dt));
  if (auto* servo = std::get_if<WallServo>(&mesh.motion)) setLoad(*servo, step.time);
  moveWall(mesh, step.time, step.dt);
  return 0.0;
}

double MeshWallTerm::renumber(std::span<const int> newNumber, const Particles&) {
  const double gone = dem::renumber(mesh.contacts, newNumber);
  stored -= gone;
  return gone;
}

void MeshWallTerm::findFacetContacts(Model& m, const Step& step, std::vector<WallAtSeam>& seams) {
  if (!present) return;
  if (step.timeless && carried(mesh)) moveWall(mesh, m.time, 0.0, &bodiesOf(m));
  mesh.candidates.reach = m.pairs.reach();
  findContacts(m.particles, mesh, movesOf(m, step), m.pairs.periodicity());
  if (mesh.rule == EdgeRule::projected)
    seams.push_back({&mesh.wall, &mesh.candidates, &mesh.contacts, {m.laws.get(), mesh.wall.material}});
}

void MeshWallTerm::takeFacetContacts(Model& m, const Step&, std::vector<AnsweredContacts>& walls) {
  if (present) walls.push_back({&mesh.contacts, {m.laws.get(), mesh.wall.material}});
}

void MeshWallTerm::addForces(Model& m, const Step& step) {
  if (!present) return;
  const ContactWork work = m.laws->wall(m.particles, mesh.wall, mesh.contacts, step.dt, m.booking);
  stored = work.storedEnergy();
  m.work += work;
  addWallForces(mesh.contacts, mesh.wall);
  m.rate.walls += drivingPower(mesh);
}

void MeshWallTerm::close(Model& m, double dt) {
  if (carried(mesh) || (!present && std::holds_alternative<WallServo>(mesh.motion))) return;
  kickWall(mesh, 0.5 * dt);
  moveWall(mesh, m.time, 0.0);
}

void MeshWallTerm::addDemand(const Model& m, ContactDemand& demand) const {
  if (!m.laws || mesh.contacts.size() == 0 || carried(mesh)) return;
  const std::size_t first = demand.links.size();
  m.laws->addDemand(demand, m.particles, mesh.wall, mesh.contacts);
  const auto* const servo = std::get_if<WallServo>(&mesh.motion);
  if (!servo) return;
  const double lever = largestLever(*servo, mesh.contacts.size(),
                                    [&](std::size_t c) { return contactPoint(mesh.contacts, mesh.wall, c); });
  demand.standOn(first, servo, servo->inverseMass(lever));
}

void MeshWallTerm::addEnergies(const Model&, Energies& e) const {
  if (const auto* servo = std::get_if<WallServo>(&mesh.motion)) addServo(e, *servo);
}

void MeshWallTerm::addContacts(const Model& m, ContactSample& sample) const {
  addWallContacts(m.particles, mesh.wall, mesh.contacts, sample);
}

/// A wall on a body gives to the body what it takes from the particles.
void MeshWallTerm::addOutside(const Model&, Momenta& force, Momenta&) const {
  if (carried(mesh)) return;
  const WallContacts& contacts = mesh.contacts;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Vec3 point = contactPoint(contacts, mesh.wall, c);
    force.add(contacts.image.empty() ? point : point - contacts.shift(c), contacts.force[c]);
    if (c < contacts.couple.size()) force.angular += contacts.couple[c];
  }
}

void MeshWallTerm::save(ByteWriter& writer) const {
  describeMesh(writer, mesh);
  writer(fingerprint(mesh));
  archiveMesh(writer, mesh);
  writer(stored);
}
void MeshWallTerm::load(ByteReader& reader) {
  const bool described = !mesh.wall.facets.empty();
  const auto here = described ? fingerprint(mesh) : decltype(fingerprint(mesh)){};
  describeMesh(reader, mesh);
  auto saved = here;
  reader(saved);
  if (described && !(saved == here))
    throw InputError("the triangulated wall is another one than that of the checkpoint", "checkpoint",
                     "set the model up as it was when the checkpoint was written");
  archiveMesh(reader, mesh);
  requireWhole(mesh.contacts);
  mesh.wall.topology = geometry::makeTopology(mesh.wall.facets, static_cast<int>(mesh.wall.x.size()));
  reader(stored);
}

MeshWall& addFreeWall(Model& m, TriangulatedWall wall, Density density, const Vec3& v, const Vec3& omega) {
  const MassProperties properties = solidInside(wall.x, wall.facets, density);
  return addFreeWall(m, std::move(wall), properties, v, omega);
}
MeshWall& addFreeWall(Model& m, TriangulatedWall wall, const MassProperties& properties, const Vec3& v,
                      const Vec3& omega) {
  MeshWall mesh;
  mesh.motion = addWallBody(bodies(m).bodies, wall, properties, v, omega);
  mesh.wall = std::move(wall);
  return addWall(m, std::move(mesh));
}

namespace {

/// @param wall one of those that terms of this kind hold as their `part`
template <class WallTerm, class Wall>
void removeTerm(Model& m, const Wall& wall, Wall WallTerm::*part) {
  const auto found = m.terms.all<WallTerm>();
  const auto term = std::find_if(found.begin(), found.end(), [&](const auto* t) { return &(t->*part) == &wall; });
  if (term == found.end())
    throw InputError("the wall is not one of the model's", "removeWall", "give the wall that addWall returned");
  m.booked.left += (*term)->stored;
  m.work.elasticEnergy -= (*term)->stored;
  m.terms.remove(**term);
}

}  // namespace

void removeWall(Model& m, const PrimitiveWall& wall) { removeTerm(m, wall, &PrimitiveWallTerm::wall); }
void removeWall(Model& m, const MeshWall& mesh) { removeTerm(m, mesh, &MeshWallTerm::mesh); }

void setPresent(PrimitiveWallTerm& term, bool present) {
  if (term.present == present) return;
  term.present = present;
  term.stored = 0.0;
  term.wall.contacts = {};
  term.wall.search = {};
  term.wall.force = term.wall.torque = {};
  if (term.wall.servo) term.wall.servo->speed = term.wall.servo->contact = 0.0;
}

void setPresent(MeshWallTerm& term, bool present) {
  if (term.present == present) return;
  term.present = present;
  term.stored = 0.0;
  MeshWall& mesh = term.mesh;
  mesh.contacts = {};
  const std::optional<double> skin = mesh.candidates.skin;
  mesh.candidates = {};
  mesh.candidates.skin = skin;
  mesh.step = 0.0;
  clearForces(mesh.wall);
  if (auto* servo = std::get_if<WallServo>(&mesh.motion)) servo->speed = servo->contact = 0.0;
}

PrimitiveWall& primitiveWall(Model& m, std::size_t i) {
  return numbered<PrimitiveWallTerm>(m, i, "primitive wall").wall;
}
const PrimitiveWall& primitiveWall(const Model& m, std::size_t i) {
  return numbered<PrimitiveWallTerm>(m, i, "primitive wall").wall;
}
MeshWall& meshWall(Model& m, std::size_t i) { return numbered<MeshWallTerm>(m, i, "mesh wall").mesh; }
const MeshWall& meshWall(const Model& m, std::size_t i) { return numbered<MeshWallTerm>(m, i, "mesh wall").mesh; }

}  // namespace dovetail::dem
