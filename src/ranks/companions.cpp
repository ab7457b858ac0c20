#include "companions.hpp"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string>

#include "dovetail/core/lost_error.hpp"
#include "dovetail/ranks/session.hpp"

namespace dovetail::ranks {

namespace {

bool lives(long process) { return kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH; }

}  // namespace

MPI_Comm ownCommunicator() {
  static const MPI_Comm own = [] {
    MPI_Comm copy = MPI_COMM_NULL;
    require(MPI_Comm_dup(MPI_COMM_WORLD, &copy), "meeting");
    return copy;
  }();
  return own;
}

Companions::Companions() {
  struct Place {
    std::array<char, 64> machine{};
    long process = 0;
  };
  Place own;
  gethostname(own.machine.data(), own.machine.size() - 1);
  own.process = getpid();
  std::vector<Place> all(static_cast<std::size_t>(count()));
  require(MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, ownCommunicator()), "meeting");
  for (const Place& place : all)
    processes_.push_back(
        place.machine == own.machine && place.process != own.process && lives(place.process) ? place.process : 0);
}

void Companions::wait(MPI_Request& request, const char* doing) const {
  waitUntil([&] {
    int done = 0;
    require(MPI_Test(&request, &done, MPI_STATUS_IGNORE), doing);
    return done != 0;
  });
}

void Companions::requireAll() const {
  for (std::size_t rank = 0; rank < processes_.size(); ++rank)
    if (processes_[rank] != 0 && !lives(processes_[rank]))
      throw LostError("rank " + std::to_string(rank) + " has ended", "process " + std::to_string(processes_[rank]),
                      "its own message, or that of mpirun, tells why");
}

}  // namespace dovetail::ranks
