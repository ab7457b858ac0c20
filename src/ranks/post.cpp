#include "dovetail/ranks/post.hpp"

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include "dovetail/core/error.hpp"
#include "dovetail/ranks/session.hpp"

namespace dovetail::ranks {

namespace {

constexpr int tag = 77;

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

}  // namespace

struct Post::Sent {
  std::vector<char> bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};

Post::Post() = default;
Post::~Post() = default;

void Post::send(int to, std::vector<char> bytes) {
  if (bytes.size() >= static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw NumericalError("a letter to rank " + std::to_string(to) + " has 2 GiB or more", "ranks",
                         "spread the work over more ranks");
  sent_.push_back(std::make_unique<Sent>(Sent{std::move(bytes)}));
  Sent& letter = *sent_.back();
  require(MPI_Isend(letter.bytes.data(), static_cast<int>(letter.bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD,
                    &letter.request),
          "sending");
}

void Post::settle() {
  for (const std::unique_ptr<Sent>& letter : sent_)
    waitUntil([&] {
      int done = 0;
      require(MPI_Test(&letter->request, &done, MPI_STATUS_IGNORE), "sending");
      return done != 0;
    });
  sent_.clear();
}

Post::Arrived Post::receive() {
  MPI_Message message = MPI_MESSAGE_NULL;
  MPI_Status status;
  waitUntil([&] {
    int there = 0;
    require(MPI_Improbe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &message, &status), "waiting for a letter");
    return there != 0;
  });
  int size = 0;
  require(MPI_Get_count(&status, MPI_BYTE, &size), "receiving");
  Arrived letter{status.MPI_SOURCE, std::vector<char>(static_cast<std::size_t>(size))};
  require(MPI_Mrecv(letter.bytes.data(), size, MPI_BYTE, &message, &status), "receiving");
  return letter;
}

}  // namespace dovetail::ranks
