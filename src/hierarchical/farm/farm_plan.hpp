// Which rank answers for which point.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace dovetail::hierarchical {

/// Points of ranks with their times, as they were in the last step.
struct FarmLoads {
  std::vector<int> owner;       ///< rank of each point
  std::vector<double> seconds;  ///< that each took
  std::vector<int> threads;     ///< of each rank
};

/// Of a cell with a state of so many bytes, s: two letters and two hops of a slow network.
constexpr double priceOfMove(std::size_t bytes) { return 2e-4 + 2e-9 * static_cast<double>(bytes); }

struct FarmMove {
  std::size_t point;
  int to;
};

/// What a rank takes for its points: their sum over its threads, no less than the longest.
std::vector<double> timesOfRanks(const FarmLoads& loads);

/// Moves from the busiest rank to the idlest, or exchanges of a long point for a short one, as long as each shortens
/// the longer of their times by more than its price.
/// @param price  of a move, s
std::vector<FarmMove> worthwhileMoves(FarmLoads loads, double price);

/// Times of the points in the evaluations of one accepted step, s.
using RecordedStep = std::vector<std::vector<double>>;

/// What a farm of so many ranks with one thread each would have made of recorded steps.
struct Replay {
  double alone = 0.0;  ///< sum of all times, s
  double farm = 0.0;   ///< longest ranks and letters, s
  std::size_t moves = 0;
};
/// @param letter  of each evaluation and rank, s  @param price  of a move, s
Replay replay(std::span<const RecordedStep> steps, int ranks, double letter, double price);

}  // namespace dovetail::hierarchical
