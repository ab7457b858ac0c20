// Processes that run the same program on the same input and share its work.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/core/failure.hpp"

namespace dovetail {

/// Every call is made by all ranks, in the same order. This one is a rank on its own.
class Team {
public:
  Team() = default;
  virtual ~Team() = default;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  /// Of all ranks, entry by entry: the same digits on each of them.
  virtual void sum(std::span<double>) {}
  /// What each of them gives, in their order.
  virtual std::vector<std::vector<char>> gather(std::vector<char> own);
  /// @param letters  one to each rank @return what each of them has for this one, in their order
  virtual std::vector<std::vector<char>> exchange(std::vector<std::vector<char>> letters) { return letters; }

  /// Of all ranks.
  double sum(double own);
  double largest(double own);
  /// Waits for all.
  void meet() { largest(0.0); }
};

/// Of this process: a rank on its own until there is another. Not for threads.
Team& team();
void setTeam(std::unique_ptr<Team> team);

/// Throws on all ranks what the first of those has to say that failed, with its number; nothing if none did.
void agree(Failure failure, const std::string& text);

/// Does what may fail on some of the ranks alone. @throws on all what it throws on the first of them
template <class Act>
void together(Act&& act) {
  if (team().size() == 1) return act();
  Failure failure = Failure::none;
  std::string text;
  try {
    act();
  } catch (...) {
    std::tie(failure, text) = failureNow();
  }
  agree(failure, text);
}

}  // namespace dovetail
