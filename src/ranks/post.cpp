#include "dovetail/ranks/post.hpp"

#include <mpi.h>

#include <limits>
#include <string>
#include <utility>

#include "companions.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/ranks/session.hpp"

namespace dovetail::ranks {

namespace {

constexpr int tag = 0;

}  // namespace

struct Post::Sent {
  std::vector<char> bytes;
  MPI_Request request = MPI_REQUEST_NULL;
};

Post::Post() { companions(); }
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
  for (const std::unique_ptr<Sent>& letter : sent_) companions().wait(letter->request, "sending");
  sent_.clear();
}

Post::Arrived Post::receive() {
  MPI_Message message = MPI_MESSAGE_NULL;
  MPI_Status status;
  companions().waitUntil([&] {
    int there = 0;
    require(MPI_Improbe(MPI_ANY_SOURCE, tag, ownCommunicator(), &there, &message, &status), "waiting for a letter");
    return there != 0;
  });
  int size = 0;
  require(MPI_Get_count(&status, MPI_BYTE, &size), "receiving");
  Arrived letter{status.MPI_SOURCE, std::vector<char>(static_cast<std::size_t>(size))};
  MPI_Request request = MPI_REQUEST_NULL;
  require(MPI_Imrecv(letter.bytes.data(), size, MPI_BYTE, &message, &request), "receiving");
  companions().wait(request, "receiving");
  return letter;
}

}  // namespace dovetail::ranks
