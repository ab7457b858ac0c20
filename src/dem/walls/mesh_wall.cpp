#include "dovetail/dem/walls/mesh_wall.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

namespace {

/// Where the wall is to be, with its vertices from there.
struct Place {
  RigidMotion pose;
  const std::vector<Vec3>* offset;
};

void requireBody(const WallOnBody& carrier, const Bodies* bodies) {
  if (!bodies || carrier.body < 0 || static_cast<std::size_t>(carrier.body) >= bodies->size())
    throw InputError("the body it is on does not exist", "triangulated wall", "take the result of addWallBody");
}

Place placeOf(const MeshWall& mesh, double time, const Bodies* bodies) {
  if (const auto* motion = std::get_if<PrescribedMotion>(&mesh.motion)) {
    if (!*motion) throw InputError("its motion is empty", "triangulated wall", "give a function, or leave it at rest");
    return {(*motion)(time), &mesh.offset};
  }
  if (const auto* servo = std::get_if<WallServo>(&mesh.motion)) return {servo->pose(), &mesh.offset};
  const auto& carrier = std::get<WallOnBody>(mesh.motion);
  requireBody(carrier, bodies);
  return {poseOf(*bodies, carrier), &carrier.offset};
}

/// A few vertices at every call, all of them in turn: who moves a wall moves most of it.
void requireAtRest(MeshWall& mesh) {
  constexpr std::size_t most = 64;
  const std::vector<Vec3>&now = mesh.wall.x, &then = mesh.candidates.vertexAtBuild;
  if (mesh.candidates.builds == 0 || now.size() != then.size()) return;
  for (std::size_t k = 0; k < std::min(most, now.size()); ++k) {
    const std::size_t vertex = mesh.lookedAt++ % now.size();
    if (!(now[vertex] == then[vertex]))
      throw InputError("vertex " + std::to_string(vertex) + " has moved, but the wall is defined to be at rest",
                       "triangulated wall", "set its motion, or MovedByOthers with how far they have moved it");
  }
}

double takeStep(MeshWall& mesh) {
  if (std::holds_alternative<AtRest>(mesh.motion)) requireAtRest(mesh);
  double step = std::exchange(mesh.step, 0.0);
  if (auto* others = std::get_if<MovedByOthers>(&mesh.motion)) {
    step = std::exchange(others->travel, MovedByOthers{}.travel);
    if (!(step >= 0.0) && mesh.candidates.builds > 0)
      throw InputError("the distance that its vertices have moved is not set", "triangulated wall moved by others",
                       "set MovedByOthers::travel at every step");
  }
  return step;
}

/// Whether a wall that has moved by `step` may have passed a particle.
void requireShortStep(const Particles& particles, const MeshWall& mesh, double step,
                      const geometry::Periodicity& periodicity) {
  if (mesh.candidates.builds == 0 || !(step > mesh.candidates.smallestRadius) || !std::isfinite(step)) return;
  WallCandidates around;
  findWallCandidates(particles, mesh.wall, std::max(step, mesh.candidates.margin), around, periodicity);
  for (const int i : around.particle)
    if (particles.radius[static_cast<std::size_t>(i)] < step)
      throw NumericalError("a wall has moved " + formatNumber(step) +
                               " m in one step near it, farther than its radius: it could have passed it",
                           "particle " + std::to_string(i), "take a smaller time step, or a slower wall");
}

/// Forces to zero where the last contacts were: no others were set.
void clearReactions(MeshWall& mesh) {
  if (mesh.candidates.builds == 0) return clearForces(mesh.wall);
  for (const int facet : mesh.contacts.facet)
    for (const int vertex : mesh.wall.facets[static_cast<std::size_t>(facet)])
      mesh.wall.f[static_cast<std::size_t>(vertex)] = {};
}

}  // namespace

void prescribe(MeshWall& mesh, PrescribedMotion motion, const Vec3& reference) {
  mesh.offset = vertexOffsets(mesh.wall, reference);
  mesh.motion = std::move(motion);
}

void prescribe(MeshWall& mesh, const WallServo& servo) {
  const RigidMotion now = servo.pose();
  mesh.offset = vertexOffsets(mesh.wall, now.x);
  if (servo.turns)
    for (Vec3& arm : mesh.offset) arm = rotateBack(now.turn, arm);
  mesh.motion = servo;
}

void kickWall(MeshWall& mesh, double dt) {
  auto* servo = std::get_if<WallServo>(&mesh.motion);
  if (!servo) return;
  takeContact(*servo, totalForce(mesh.wall), servo->turns ? totalMoment(mesh.wall, servo->point) : Vec3{},
              servo->point);
  kickServo(*servo, dt);
}

void moveWall(MeshWall& mesh, double time, double dt, const Bodies* bodies) {
  if (std::holds_alternative<MovedByOthers>(mesh.motion)) return;
  if (auto* servo = std::get_if<WallServo>(&mesh.motion)) driftServo(*servo, dt);
  mesh.belt = mesh.surfaceVelocity;
  if (std::holds_alternative<AtRest>(mesh.motion)) {
    if (!mesh.wall.v.empty() && !(mesh.wall.v.front() == mesh.belt && mesh.wall.v.back() == mesh.belt))
      std::fill(mesh.wall.v.begin(), mesh.wall.v.end(), mesh.belt);
    return;
  }
  const Place place = placeOf(mesh, time, bodies);
  if (const auto* carrier = std::get_if<WallOnBody>(&mesh.motion))
    mesh.wall.mass = bodies->mass[static_cast<std::size_t>(carrier->body)];
  mesh.step += placeWall(place.pose, *place.offset, mesh.wall);
  if (squaredNorm(mesh.surfaceVelocity) == 0.0) return;
  mesh.belt = rotate(place.pose.turn, mesh.surfaceVelocity);
  for (Vec3& v : mesh.wall.v) v += mesh.belt;
}

void findContacts(const Particles& particles, MeshWall& mesh, const Moves& moves,
                  const geometry::Periodicity& periodicity) {
  clearReactions(mesh);
  const bool rigid = !std::holds_alternative<MovedByOthers>(mesh.motion);
  if (rigid != mesh.wall.rigid) mesh.candidates.builds = 0;
  mesh.wall.rigid = rigid;
  Moves all = moves;
  all.wall = takeStep(mesh);
  requireShortStep(particles, mesh, all.wall, periodicity);
  updateWallCandidates(particles, mesh.wall, mesh.candidates, all, periodicity);
  findWallContacts(particles, mesh.wall, mesh.candidates, mesh.rule, mesh.contacts);
}

void gatherForces(MeshWall& mesh, Bodies* bodies) {
  addWallForces(mesh.contacts, mesh.wall);
  if (const auto* carrier = std::get_if<WallOnBody>(&mesh.motion)) {
    requireBody(*carrier, bodies);
    gatherForces(mesh.wall, *carrier, *bodies);
  }
}

double drivingPower(const MeshWall& mesh) {
  if (std::holds_alternative<WallOnBody>(mesh.motion) || std::holds_alternative<WallServo>(mesh.motion))
    return -dot(totalForce(mesh.wall), mesh.belt);
  if (std::holds_alternative<AtRest>(mesh.motion) && mesh.belt == Vec3{}) return 0.0;
  return -forcePower(mesh.wall);
}

}  // namespace dovetail::dem
