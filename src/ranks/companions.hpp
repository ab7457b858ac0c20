// The other ranks, while this one waits for them or computes.
#pragma once

#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace dovetail::ranks {

/// Made after start(), on all ranks at the same time. On rank 0 a thread looks after the others until PETSc ends:
/// mpirun ends all within a second of the death of one, which may find rank 0 in a long computation or held within MPI.
/// The thread then says who was lost, and the last words of the program (core/failure.hpp), and ends it with code 1.
class Companions {
public:
  Companions();
  Companions(const Companions&) = delete;
  Companions& operator=(const Companions&) = delete;

  /// Waits until done() says so. Open MPI would poll: sleeps that grow with the time waited, to a twentieth of it and
  /// 1 ms, leave the core to others.
  /// @throws LostError if a rank of this machine has ended; mpirun ends all where one of another has
  template <class Done>
  void waitUntil(Done&& done) {
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
  void wait(MPI_Request& request, const char* doing);

private:
  /// Whose it is to tell of a loss.
  enum class Teller : std::uint8_t { nobody, waiter, watch };

  void requireAll();
  void watch();
  void endWatch();
  bool sleepsFor(std::chrono::milliseconds time);
  std::optional<std::size_t> lost() const;
  bool tells(Teller teller);

  std::vector<long> processes_;  ///< of all ranks; 0 for this one and those that cannot be seen from here
  std::atomic<Teller> teller_{Teller::nobody};
  std::mutex mutex_;
  std::condition_variable ending_;
  bool ended_ = false;
  std::thread watch_;
};

/// Of the program, as long as it runs. The first call is made on all ranks at the same time.
Companions& companions();

/// Of all ranks, apart from those of the program and of PETSc.
MPI_Comm ownCommunicator();

}  // namespace dovetail::ranks
