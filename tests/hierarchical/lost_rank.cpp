// A rank is killed while the first one is held within MPI, or computes: it still says so, with its last words.
#include <mpi.h>

#include <chrono>
#include <csignal>
#include <string>

#include "dovetail/core/failure.hpp"
#include "dovetail/ranks/session.hpp"
#include "dovetail/ranks/team_of_ranks.hpp"

int main(int, char** arguments) {
  using namespace dovetail;
  ranks::start();
  ranks::formTeam();
  std::signal(SIGTERM, SIG_IGN);  // as in a run, where it asks for a checkpoint
  setLastWords("the last checkpoint is here");
  if (ranks::rank() == 2) std::raise(SIGKILL);
  if (std::string(arguments[1]) == "barrier") MPI_Barrier(MPI_COMM_WORLD);
  for (const auto start = std::chrono::steady_clock::now();
       std::chrono::steady_clock::now() - start < std::chrono::seconds(30);)
    continue;
}
