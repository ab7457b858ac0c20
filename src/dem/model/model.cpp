#include "dovetail/dem/model/model.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/particles/damping.hpp"
#include "dovetail/dem/setup/insertion.hpp"

namespace dovetail::dem::detail {

namespace {

std::string name(const Particles& particles, std::size_t i) {
  const auto id = particles.id.empty() ? static_cast<std::int64_t>(i) : particles.id[i];
  return "particle " + std::to_string(id);
}

std::string state(const Particles& particles, std::size_t i) {
  const auto text = [](const Vec3& v) {
    return "(" + formatNumber(v.x) + ", " + formatNumber(v.y) + ", " + formatNumber(v.z) + ")";
  };
  return "at " + text(particles.x[i]) + " m with " + text(particles.v[i]) + " m/s";
}

bool inside(const geometry::Box& box, const Vec3& x) {
  return x.x >= box.lower.x && x.y >= box.lower.y && x.z >= box.lower.z && x.x <= box.upper.x && x.y <= box.upper.y &&
         x.z <= box.upper.z;
}

void book(const Particles& particles, std::size_t i, const Vec3& gravity, Escaped& escaped) {
  ++escaped.count;
  escaped.mass += particles.mass[i];
  escaped.energy += particles.mass[i] * (0.5 * squaredNorm(particles.v[i]) - dot(gravity, particles.x[i]));
  if (particles.rotates())
    escaped.energy += 0.5 * momentOfInertia(particles, static_cast<int>(i)) * squaredNorm(particles.omega[i]);
}

}  // namespace

std::string when(double time, std::int64_t steps) {
  return "t = " + formatNumber(time) + " s, step " + std::to_string(steps);
}

double beginStep(Particles& particles, double dt, const Vec3& gravity, bool open) {
  return open ? turnStep(particles, dt, gravity) : startStep(particles, dt, gravity);
}

double smallestRadius(const Particles& particles) {
  return particles.size() == 0 ? 0.0 : *std::min_element(particles.radius.begin(), particles.radius.end());
}

void requireShortMoves(const Particles& particles, double dt, const std::string& when) {
  requireFinite(particles, when);
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (norm(particles.v[i]) * dt > particles.radius[i])
      throw NumericalError("it moved farther than its radius in one step, " + when + ", " + state(particles, i),
                           name(particles, i), "take a smaller time step, or look for what has thrown it");
}

void moveWalls(std::vector<PrimitiveWall>& walls, std::vector<MeshWall>& meshes, double time, double dt) {
  for (PrimitiveWall& wall : walls) {
    if (wall.motion) wall.motion(time, wall);
    drift(wall, dt);
  }
  for (MeshWall& mesh : meshes)
    if (mesh.motion) placeWall(mesh.motion(time), mesh.offset, mesh.wall);
}

std::vector<int> checkDomain(Particles& particles, PairList& list, const std::optional<Domain>& domain,
                             const Vec3& gravity, Escaped& escaped, const std::string& when) {
  if (!domain) return {};
  std::vector<int> out;
  for (std::size_t i = 0; i < particles.size(); ++i)
    if (!inside(domain->box, particles.x[i])) out.push_back(static_cast<int>(i));
  if (out.empty()) return {};
  const auto first = static_cast<std::size_t>(out.front());
  if (domain->policy == EscapePolicy::refuse)
    throw NumericalError("it has left the domain, " + when + ", " + state(particles, first) + " (" +
                             std::to_string(out.size()) + " in all)",
                         name(particles, first),
                         "take a smaller time step, a larger domain, or the policy that removes particles");
  for (const int i : out) book(particles, static_cast<std::size_t>(i), gravity, escaped);
  const std::vector<int> newNumber = removeParticles(particles, out);
  renumber(list, newNumber);
  findPairs(particles, list.skin, list);
  return newNumber;
}

void renumberWalls(std::vector<PrimitiveWall>& walls, std::vector<MeshWall>& meshes, std::span<const int> newNumber) {
  for (PrimitiveWall& wall : walls) renumber(wall, newNumber);
  for (MeshWall& mesh : meshes) {
    renumber(mesh.contacts, newNumber);
    mesh.candidates.builds = 0;
  }
}

double wallPower(const PrimitiveWall& wall) {
  return -dot(wall.force, wall.velocity) - dot(wall.torque, wall.angularVelocity);
}

double meshPower(const MeshWall& mesh) { return mesh.motion ? -forcePower(mesh.wall) : 0.0; }

void bookLosses(Energies& booked, const ContactWork& work, double dt) {
  booked.lost.dissipatedPower += dt * work.dissipatedPower;
  booked.lost.frictionPower += dt * work.frictionPower;
  booked.lost.rollingPower += dt * work.rollingPower;
  booked.lost.plasticPower += dt * work.plasticPower;
  booked.lost.fracturePower += dt * work.fracturePower;
}

void requireSame(const WallCounts& saved, const WallCounts& here, const std::filesystem::path& path) {
  if (saved.walls != here.walls || saved.meshes != here.meshes)
    throw InputError("the checkpoint has " + std::to_string(saved.walls) + " primitive and " +
                         std::to_string(saved.meshes) + " triangulated walls, the model " + std::to_string(here.walls) +
                         " and " + std::to_string(here.meshes),
                     path.string(), "set the model up as it was when the checkpoint was written");
  if (saved.memory != here.memory)
    throw InputError("contacts in the checkpoint remember " + std::to_string(saved.memory) +
                         " numbers, under this law " + std::to_string(here.memory),
                     path.string(), "read it with the law that wrote it");
}

void requireBelow(const ContactStep& limit, double dt) {
  if (dt <= limit.dt) return;
  const std::string partner = limit.partner < 0 ? "a wall" : "particle " + std::to_string(limit.partner);
  throw InputError(
      "dt = " + formatNumber(dt) + " s is beyond the stable " + formatNumber(limit.dt) +
          " s that the contact of particle " + std::to_string(limit.particle) + " with " + partner + " sets",
      "time step", "take a fifth of the limit or less, softer contacts, or scaleMasses for quasi-static scenes");
}

double applyDamping(Particles& particles, double viscousRate, double local) {
  double power = 0.0;
  if (viscousRate > 0.0) power += applyViscousDamping(particles, viscousRate);
  if (local > 0.0) power += applyLocalDamping(particles, local);
  return power;
}

}  // namespace dovetail::dem::detail
