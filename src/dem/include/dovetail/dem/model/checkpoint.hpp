// Checkpoints of a model: a run goes on from one as if it had never stopped, to the last bit.
#pragma once

#include <filesystem>

#include "dovetail/core/archive.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem {

template <class Archive, class P>
void archiveParticles(Archive& archive, P& p) {
  archive(p.x, p.v, p.f, p.radius, p.mass, p.omega, p.torque, p.material, p.id);
}

/// All of a list but what follows from it.
template <class Archive, class List>
void archivePairs(Archive& archive, List& l) {
  archive(l.skin, l.pairs, l.builds, l.revision, l.innerSkin, l.candidates, l.innerTravel, l.positionAtPruning,
          l.updatesSincePruning, l.images, l.scale, l.memory, l.turns, l.ended, l.endedMaterials, l.positionAtBuild,
          l.travel);
}

template <class Archive, class Wall>
void archiveWall(Archive& archive, Wall& w) {
  auto& c = w.contacts;
  archive(w.point, w.axis, w.velocity, w.angularVelocity, w.force, w.torque, w.near, w.travel, w.particlesAtSearch,
          w.searched, c.particle, c.normal, c.overlap, c.engagement, c.force, c.couple, c.memory);
}

template <class Archive, class Mesh>
void archiveMesh(Archive& archive, Mesh& m) {
  auto& s = m.contacts.springs;
  auto& c = m.candidates;
  archive(m.wall.x, m.wall.v, m.wall.f, s.particle, s.facet, s.normal, s.memory, c.particle, c.offsets, c.facet, c.flat,
          c.lastFacet, c.builds, c.lateBuilds, c.particleAtBuild, c.particleTravel, c.vertexAtBuild, c.facetsAtBuild,
          c.vertexTravel, c.updatesSinceBuild, c.nextScan);
}

template <class Archive, class M>
void archiveModel(Archive& archive, M& m) {
  archiveParticles(archive, m.particles);
  archivePairs(archive, m.pairs);
  for (auto& wall : m.walls) archiveWall(archive, wall);
  for (auto& mesh : m.meshes) archiveMesh(archive, mesh);
  archive(m.bonds.bonds, m.bonds.ended, m.bonds.particles);
  archive(m.time, m.steps, m.open, m.work, m.booked, m.escaped, m.smallestRadius);
}

namespace detail {
inline constexpr const char* checkpointKind = "dem model 1";
struct WallCounts {
  std::uint64_t walls, meshes, memory;
};
/// @throws InputError if they differ
void requireSame(const WallCounts& saved, const WallCounts& here, const std::filesystem::path& path);
template <class Law>
WallCounts countsOf(const Model<Law>& m) {
  return {m.walls.size(), m.meshes.size(), static_cast<std::uint64_t>(Law::memory)};
}
}  // namespace detail

/// @throws InputError if the file cannot be written; what was there before is then still there
template <class Law>
void writeCheckpoint(const std::filesystem::path& path, const Model<Law>& model) {
  ByteWriter writer;
  writer(detail::countsOf(model));
  archiveModel(writer, model);
  writeChecked(path, detail::checkpointKind, writer.bytes());
}

/// Reads a state into a model that is set up as the one that was saved: laws, gravity, walls, domain and damping are
/// the caller's.
/// @throws InputError if the file is foreign, cut off or changed, or the model has other walls or a law with other
///         memories; the model is then as it was
template <class Law>
void readCheckpoint(const std::filesystem::path& path, Model<Law>& model) {
  ByteReader reader(readChecked(path, detail::checkpointKind));
  detail::WallCounts saved{};
  reader(saved);
  detail::requireSame(saved, detail::countsOf(model), path);
  Model<Law> restored = model;
  archiveModel(reader, restored);
  restoreChunks(restored.particles, restored.pairs);
  model = std::move(restored);
}

}  // namespace dovetail::dem
