// Who started the program.
#pragma once

#include <cstdlib>

namespace dovetail::hierarchical {

/// Processes that a launcher of MPI (mpirun, srun) has started with this one, by what it has put into the environment;
/// 1 without.
inline int ranksLaunched() {
  for (const char* const set : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* const ranks = std::getenv(set)) return std::atoi(ranks);
  const char* const tasks = std::getenv("PMIX_RANK") != nullptr ? std::getenv("SLURM_NTASKS") : nullptr;
  return tasks != nullptr ? std::atoi(tasks) : 1;
}

}  // namespace dovetail::hierarchical
