#include "companions.hpp"

#include <petscsys.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <string>

#include "dovetail/core/failure.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/ranks/session.hpp"

namespace dovetail::ranks {

namespace {

bool lives(long process) { return kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH; }

LostError lossOf(std::size_t rank, long process) {
  return {"rank " + std::to_string(rank) + " has ended", "process " + std::to_string(process),
          "its own message, or that of mpirun, tells why"};
}

}  // namespace

MPI_Comm ownCommunicator() {
  static const MPI_Comm own = [] {
    MPI_Comm copy = MPI_COMM_NULL;
    require(MPI_Comm_dup(MPI_COMM_WORLD, &copy), "meeting");
    return copy;
  }();
  return own;
}

Companions& companions() {
  static Companions& all = *new Companions;
  return all;
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
  if (rank() > 0 || count() == 1) return;
  require(PetscRegisterFinalize([] {
            companions().endWatch();
            return PetscErrorCode{};
          }),
          "meeting");
  watch_ = std::thread([this] { watch(); });
}

void Companions::wait(MPI_Request& request, const char* doing) {
  waitUntil([&] {
    int done = 0;
    require(MPI_Test(&request, &done, MPI_STATUS_IGNORE), doing);
    return done != 0;
  });
}

std::optional<std::size_t> Companions::lost() const {
  for (std::size_t rank = 0; rank < processes_.size(); ++rank)
    if (processes_[rank] != 0 && !lives(processes_[rank])) return rank;
  return std::nullopt;
}

/// The first who asks does.
bool Companions::tells(Teller teller) {
  Teller first = Teller::nobody;
  return teller_.compare_exchange_strong(first, teller) || first == teller;
}

void Companions::requireAll() {
  const std::optional<std::size_t> rank = lost();
  if (rank && tells(Teller::waiter)) throw lossOf(*rank, processes_[*rank]);
}

bool Companions::sleepsFor(std::chrono::milliseconds time) {
  std::unique_lock lock(mutex_);
  return !ending_.wait_for(lock, time, [this] { return ended_; });
}

/// Who waits for the others sees a loss within 32 ms and may tell better; mpirun kills a second after it.
void Companions::watch() {
  std::optional<std::size_t> rank;
  while (!rank) {
    if (!sleepsFor(std::chrono::milliseconds(50))) return;
    rank = lost();
  }
  if (!sleepsFor(std::chrono::milliseconds(250)) || !tells(Teller::watch)) return;
  std::cout.flush();
  std::cerr << lossOf(*rank, processes_[*rank]).what() << std::endl;
  if (const std::string words = lastWords(); !words.empty()) std::cerr << words << std::endl;
  std::_Exit(1);
}

void Companions::endWatch() {
  {
    const std::scoped_lock lock(mutex_);
    ended_ = true;
  }
  ending_.notify_all();
  if (watch_.joinable()) watch_.join();
}

}  // namespace dovetail::ranks
