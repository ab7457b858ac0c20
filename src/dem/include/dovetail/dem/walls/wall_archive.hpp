// State of walls in a checkpoint, enough for an exact restart. Code, and what a run never changes (motions, materials,
// facets), is set up by the caller.
#pragma once

#include "dovetail/dem/walls/mesh_wall.hpp"
#include "dovetail/dem/walls/primitive_wall.hpp"

namespace dovetail::dem {

template <class Archive, class Wall>
void archiveWall(Archive& archive, Wall& w) {
  auto& c = w.contacts;
  auto& s = w.search;
  archive(w.point, w.axis, w.velocity, w.angularVelocity, w.surfaceVelocity, w.force, w.torque);
  archive(s.near, s.margin, s.builds, s.particleRevision, s.point, s.axis, s.radius, s.extent, s.smallestRadius,
          s.travel, s.lastPoint, s.lastAxis);
  if (w.servo) archive(*w.servo);
  archive(c.particle, c.normal, c.overlap, c.force, c.couple, c.memory, c.memoryKind, c.image, c.period, c.energy,
          c.sideEnergy);
}

template <class Archive, class Candidates>
void archiveCandidates(Archive& archive, Candidates& c) {
  archive(c.particle, c.offsets, c.facet, c.image, c.position, c.period, c.flat, c.lastFacet, c.margin, c.reach,
          c.reachAtBuild, c.builds, c.particleRevision, c.facetsAtBuild, c.vertexAtBuild, c.smallestRadius,
          c.particleTravel, c.wallTravel);
}

/// Of a triangulated wall.
template <class Archive, class Contacts>
void archiveContacts(Archive& archive, Contacts& c) {
  auto& s = c.springs;
  archive(s.particle, s.normal, s.memory, s.memoryKind, s.fraction);
  archive(c.particle, c.facet, c.weight, c.normal, c.overlap, c.engagement, c.energyFraction, c.force, c.couple,
          c.energy, c.sideEnergy, c.image, c.period);
}

template <class Archive, class Mesh>
void archiveMesh(Archive& archive, Mesh& m) {
  archive(m.wall.x, m.wall.v, m.wall.f, m.wall.rigid, m.wall.mass, m.step, m.belt, m.lookedAt);
  if (auto* servo = std::get_if<WallServo>(&m.motion)) archive(*servo);
  archiveContacts(archive, m.contacts);
  archiveCandidates(archive, m.candidates);
}

}  // namespace dovetail::dem
