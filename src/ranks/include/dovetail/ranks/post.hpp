// Bytes from one rank to another. Who waits sleeps.
#pragma once

#include <memory>
#include <vector>

namespace dovetail::ranks {

/// Each rank has its own, made after start() on all ranks. Not for threads. Where another rank of this machine ends,
/// the first one that does not wait for a letter ends the program with code 1, with the words of setLastWords().
class Post {
public:
  struct Arrived {
    int from;
    std::vector<char> bytes;
  };

  Post();
  ~Post();
  Post(const Post&) = delete;
  Post& operator=(const Post&) = delete;

  /// Starts to send; what is sent from one rank to another arrives in order.
  /// @throws NumericalError for 2 GiB or more
  void send(int to, std::vector<char> bytes);
  /// Until all that was sent is on its way or has arrived. @throws as receive()
  void settle();
  /// The next letter, from any rank; waits for one.
  /// @throws LostError if a rank of this machine has ended; mpirun ends all where one of another has
  Arrived receive();

private:
  struct Sent;

  std::vector<std::unique_ptr<Sent>> sent_;
};

}  // namespace dovetail::ranks
