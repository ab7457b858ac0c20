#include "dovetail/ranks/post.hpp"

#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <limits>
#include <string>
#include <thread>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/ranks/session.hpp"

namespace dovetail::ranks {

namespace {

constexpr int tag = 0;

/// Waits until done() says so. Open MPI would poll: sleeps that grow with the time waited, to a twentieth of it and
/// 1 ms, leave the core to others.
template <class Done>
void waitUntil(Done&& done) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  while (!done()) {
    const auto nap = (Clock::now() - start) / 20;
    std::this_thread::sleep_for(
        std::clamp<Clock::duration>(nap, std::chrono::microseconds(10), std::chrono::milliseconds(1)));
  }
}

bool lives(long process) { return kill(static_cast<pid_t>(process), 0) == 0 || errno != ESRCH; }

/// Letters are kept apart from those of the program.
MPI_Comm ownCommunicator() {
  static const MPI_Comm own = [] {
    MPI_Comm copy = MPI_COMM_NULL;
    require(MPI_Comm_dup(MPI_COMM_WORLD, &copy), "meeting");
    return copy;
  }();
  return own;
}

}  // namespace

template <class Done>
void Post::waitWithAll(Done&& done) const {
  int looks = 0;
  waitUntil([&] {
    if (++looks % 32 == 0) requireAll();
    return done();
  });
}

struct Post::Sent {
  std::vector<char> bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};

Post::Post() {
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
Post::~Post() = default;

void Post::send(int to, std::vector<char> bytes) {
  if (bytes.size() >= static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw NumericalError("a letter to rank " + std::to_string(to) + " has 2 GiB or more", "ranks",
                         "spread the work over more ranks");
  sent_.push_back(std::make_unique<Sent>(Sent{std::move(bytes)}));
  Sent& letter = *sent_.back();
  require(MPI_Isend(letter.bytes.data(), static_cast<int>(letter.bytes.size()), MPI_BYTE, to, tag, ownCommunicator(),
                    &letter.request),
          "sending");
}

void Post::settle() {
  for (const std::unique_ptr<Sent>& letter : sent_)
    waitWithAll([&] {
      int done = 0;
      require(MPI_Test(&letter->request, &done, MPI_STATUS_IGNORE), "sending");
      return done != 0;
    });
  sent_.clear();
}

Post::Arrived Post::receive() {
  MPI_Message message = MPI_MESSAGE_NULL;
  MPI_Status status;
  waitWithAll([&] {
    int there = 0;
    require(MPI_Improbe(MPI_ANY_SOURCE, tag, ownCommunicator(), &there, &message, &status), "waiting for a letter");
    return there != 0;
  });
  int size = 0;
  require(MPI_Get_count(&status, MPI_BYTE, &size), "receiving");
  Arrived letter{status.MPI_SOURCE, std::vector<char>(static_cast<std::size_t>(size))};
  MPI_Request request = MPI_REQUEST_NULL;
  require(MPI_Imrecv(letter.bytes.data(), size, MPI_BYTE, &message, &request), "receiving");
  waitWithAll([&] {
    int done = 0;
    require(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "receiving");
    return done != 0;
  });
  return letter;
}

void Post::requireAll() const {
  for (std::size_t rank = 0; rank < processes_.size(); ++rank)
    if (processes_[rank] != 0 && !lives(processes_[rank]))
      throw LostError("rank " + std::to_string(rank) + " has ended", "process " + std::to_string(processes_[rank]),
                      "its own message, or that of mpirun, tells why");
}

}  // namespace dovetail::ranks
