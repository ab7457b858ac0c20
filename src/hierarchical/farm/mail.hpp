// Letters between the rank that runs the model and those that answer for cells.
#pragma once

#include <vector>

namespace dovetail::hierarchical {

struct Letter {
  int from;
  std::vector<char> bytes;
};

/// As rank 0 has it. Letters of two ranks to each other arrive in their order.
class Mail {
public:
  Mail() = default;
  virtual ~Mail() = default;
  Mail(const Mail&) = delete;
  Mail& operator=(const Mail&) = delete;

  /// With this one: ranks 1 … ranks() − 1 are workers.
  virtual int ranks() const = 0;
  virtual void send(int to, std::vector<char> bytes) = 0;
  /// Sleeps until all that was sent is on its way or has arrived.
  virtual void settle() = 0;
  /// Sleeps until there is one, of whom ever. @throws LostError if there will be none any more
  virtual Letter receive() = 0;
  /// Letters are out of step: from now on there are none.
  virtual void giveUp() {}
};

/// Null where there are no workers, and to threads other than that of serveFarm().
Mail* mailOfFarm();

}  // namespace dovetail::hierarchical
