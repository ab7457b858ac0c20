// All ranks of MPI as one team.
#pragma once

namespace dovetail::ranks {

/// From now on team() is that of all ranks, which call this at the same time. Who waits sleeps.
/// Where another rank of this machine ends, the first one throws LostError if it waits for the others; it ends the
/// program with code 1, with the words of setLastWords(), if it does not.
void formTeam();

}  // namespace dovetail::ranks
