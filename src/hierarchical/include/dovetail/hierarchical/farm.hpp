// Cells of grains on the ranks of MPI: who answers for which is never seen in the digits.
#pragma once

#include <cstdint>
#include <vector>

#include "dovetail/fem/laws/point_field.hpp"

namespace dovetail::hierarchical {

/// To be called on all ranks of a program that mpirun has started, first of all, from its first thread: rank 0 goes on,
/// and cellField() shares its cells with the others; these evaluate cells until rank 0 ends, and are to end then too.
/// Alone, or without a launcher, it does nothing.
/// @return whether this rank has served, and all is over
/// @throws InputError on several ranks where the build has none (DOVETAIL_RANKS)
bool serveFarm();

/// The ranks that answer letters go on as this program does, from its beginning: all are one team() (core/team.hpp)
/// from then on, and cells stay in their processes. To be called where all come by that read the same input; ranks that
/// are in a team, or alone, do nothing. Others than the first write nothing on screen.
void formTeam();

/// That share cells, this one among them: 1 without serveFarm(). On more, fields of cells that the thread of
/// serveFarm() makes are asked and looked at by that thread only; those of others stay in this process.
int ranksOfFarm();

/// What a field's farm has done since the field was opened.
struct FarmReport {
  std::vector<std::size_t> points;  ///< of each rank now
  std::vector<double> busy;         ///< of each rank, with cells, s
  std::int64_t evaluations = 0;     ///< of all points
  std::int64_t moves = 0;           ///< of points to another rank
  double waited = 0.0;              ///< of rank 0, for answers of others, s
};

/// Null for fields whose points are all in this process.
const FarmReport* farmReport(const fem::PointField& field);

}  // namespace dovetail::hierarchical
