#include <petscdmplex.h>
#include <scotch.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "dovetail/core/team.hpp"
#include "dovetail/linalg/partition.hpp"
#include "dovetail/ranks/session.hpp"
#include "dovetail/ranks/team_of_ranks.hpp"
#include "petsc_owned.hpp"

namespace dovetail::linalg {

namespace {

constexpr const char* doing = "cutting a mesh for ranks";

using Rank = std::uint16_t;

/// In one process: on many, DMPlex would want the edges and faces of the mesh, and PT-Scotch cuts as it happens.
std::vector<Rank> ownersOf(int dimension, std::size_t nodes, int each, std::span<const int> corners, int ranks) {
  setenv("SCOTCH_PTHREAD_NUMBER", "1", 0);  // several cut as it happens
  SCOTCH_randomReset();
  const std::size_t cells = corners.size() / static_cast<std::size_t>(each);
  const std::vector<double> nowhere(static_cast<std::size_t>(dimension) * nodes, 0.0);
  Owned<DM, DMDestroy> mesh;
  ranks::require(DMPlexCreateFromCellListPetsc(PETSC_COMM_SELF, dimension, static_cast<PetscInt>(cells),
                                               static_cast<PetscInt>(nodes), each, PETSC_FALSE, corners.data(),
                                               dimension, nowhere.data(), mesh.fresh()),
                 doing);
  Owned<PetscPartitioner, PetscPartitionerDestroy> partitioner;
  ranks::require(PetscPartitionerCreate(PETSC_COMM_SELF, partitioner.fresh()), doing);
  ranks::require(PetscPartitionerSetType(partitioner, PETSCPARTITIONERPTSCOTCH), doing);
  PetscInt count = 0, *offsets = nullptr, *neighbours = nullptr;
  ranks::require(DMPlexCreatePartitionerGraph(mesh, 0, &count, &offsets, &neighbours, nullptr), doing);
  Owned<PetscSection, PetscSectionDestroy> section;
  Owned<IS, ISDestroy> points;
  ranks::require(PetscSectionCreate(PETSC_COMM_SELF, section.fresh()), doing);
  const int code = PetscPartitionerPartition(partitioner, ranks, count, offsets, neighbours, nullptr, nullptr, section,
                                             points.fresh());
  PetscFree(offsets);
  PetscFree(neighbours);
  ranks::require(code, doing);
  const PetscInt* point = nullptr;
  ranks::require(ISGetIndices(points, &point), doing);
  std::vector<Rank> owner(cells, 0);
  for (int rank = 0; rank < ranks; ++rank) {
    PetscInt own = 0, first = 0;
    PetscSectionGetDof(section, rank, &own);
    PetscSectionGetOffset(section, rank, &first);
    for (PetscInt k = first; k < first + own; ++k) owner[static_cast<std::size_t>(point[k])] = static_cast<Rank>(rank);
  }
  ISRestoreIndices(points, &point);
  return owner;
}

}  // namespace

void meetRanks() { ranks::formTeam(); }

std::vector<int> partitionCells(int dimension, std::size_t nodes, int each, std::span<const int> corners) {
  const std::size_t cells = corners.size() / static_cast<std::size_t>(each);
  const int ranks = team().size();
  if (ranks == 1) return std::vector<int>(cells, 0);
  std::vector<char> said;
  together([&] {
    if (team().rank() > 0) return;
    const std::vector<Rank> owners = ownersOf(dimension, nodes, each, corners, ranks);
    const auto* const bytes = reinterpret_cast<const char*>(owners.data());
    said.assign(bytes, bytes + owners.size() * sizeof(Rank));
  });
  said = team().gather(std::move(said)).front();
  const auto* const heard = reinterpret_cast<const Rank*>(said.data());
  return {heard, heard + cells};
}

}  // namespace dovetail::linalg
