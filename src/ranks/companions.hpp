// The other ranks, while this one waits for them.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

namespace dovetail::ranks {

/// Made after start() on all ranks at the same time.
class Companions {
public:
  Companions();

  /// Waits until done() says so. Open MPI would poll: sleeps that grow with the time waited, to a twentieth of it and
  /// 1 ms, leave the core to others.
  /// @throws LostError if a rank of this machine has ended; mpirun ends all where one of another has
  template <class Done>
  void waitUntil(Done&& done) const {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    for (int looks = 1; !done(); ++looks) {
      if (looks % 32 == 0) requireAll();
      const auto nap = (Clock::now() - start) / 20;
      std::this_thread::sleep_for(
          std::clamp<Clock::duration>(nap, std::chrono::microseconds(10), std::chrono::milliseconds(1)));
    }
  }
  /// Until what was begun is done.
  void wait(MPI_Request& request, const char* doing) const;

private:
  void requireAll() const;

  std::vector<long> processes_;  ///< of all ranks; 0 for this one and those that cannot be seen from here
};

/// Of all ranks, apart from those of the program and of PETSc.
MPI_Comm ownCommunicator();

}  // namespace dovetail::ranks
