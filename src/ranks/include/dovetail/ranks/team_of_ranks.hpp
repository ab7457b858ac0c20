// All ranks of MPI as one team.
#pragma once

namespace dovetail::ranks {

/// From now on team() is that of all ranks, which call this at the same time. Who waits sleeps.
void formTeam();

}  // namespace dovetail::ranks
