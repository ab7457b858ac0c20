#include "farm_plan.hpp"

#include <algorithm>

namespace dovetail::hierarchical {

namespace {

struct Rank {
  double sum = 0.0, longest = 0.0, second = 0.0;
  int threads = 1;
  double time() const { return std::max(sum / threads, longest); }
  void take(double seconds) {
    sum += seconds;
    second = std::max(second, std::min(longest, seconds));
    longest = std::max(longest, seconds);
  }
  /// With a point that comes for one that goes.
  double timeWith(double comes, double goes) const {
    return std::max({(sum + comes - goes) / threads, comes, goes == longest ? second : longest});
  }
};

std::vector<Rank> ranksOf(const FarmLoads& loads) {
  std::vector<Rank> ranks(loads.threads.size());
  for (std::size_t r = 0; r < ranks.size(); ++r) ranks[r].threads = std::max(loads.threads[r], 1);
  for (std::size_t p = 0; p < loads.owner.size(); ++p) {
    ranks[static_cast<std::size_t>(loads.owner[p])].take(loads.seconds[p]);
  }
  return ranks;
}

/// A point for nothing, or for another.
struct Exchange {
  std::size_t given = 0, taken = 0;
  bool takes = false;
  double time = 0.0;  ///< of the longer of the two afterwards
};

/// The best of those between two ranks.
Exchange bestExchange(const FarmLoads& loads, const std::vector<Rank>& ranks, int from, int to) {
  std::vector<std::size_t> theirs;  // of the idle one, shortest first
  for (std::size_t p = 0; p < loads.owner.size(); ++p)
    if (loads.owner[p] == to) theirs.push_back(p);
  std::ranges::stable_sort(theirs, {}, [&](std::size_t p) { return loads.seconds[p]; });
  const Rank &a = ranks[static_cast<std::size_t>(from)], &b = ranks[static_cast<std::size_t>(to)];
  Exchange best{.time = a.time()};
  const auto consider = [&](std::size_t given, std::size_t taken, bool takes) {
    const double out = loads.seconds[given], in = takes ? loads.seconds[taken] : 0.0;
    const double time = std::max(a.timeWith(in, out), b.timeWith(out, in));
    if (time < best.time) best = {given, taken, takes, time};
  };
  // At the best difference both are done at the same time.
  const double wanted = (a.sum * b.threads - b.sum * a.threads) / (a.threads + b.threads);
  for (std::size_t p = 0; p < loads.owner.size(); ++p) {
    if (loads.owner[p] != from) continue;
    consider(p, p, false);
    const auto above = std::ranges::lower_bound(theirs, loads.seconds[p] - wanted, {},
                                                [&](std::size_t q) { return loads.seconds[q]; });
    if (above != theirs.end()) consider(p, *above, true);
    if (above != theirs.begin()) consider(p, *(above - 1), true);
  }
  return best;
}

}  // namespace

std::vector<double> timesOfRanks(const FarmLoads& loads) {
  std::vector<double> times;
  for (const Rank& rank : ranksOf(loads)) times.push_back(rank.time());
  return times;
}

std::vector<FarmMove> worthwhileMoves(FarmLoads loads, double price) {
  std::vector<FarmMove> moves;
  const auto move = [&](std::size_t point, int to) {
    loads.owner[point] = to;
    moves.push_back({point, to});
  };
  while (moves.size() < 2 * loads.owner.size()) {
    const std::vector<Rank> ranks = ranksOf(loads);
    const auto [idle, busy] = std::ranges::minmax_element(ranks, {}, &Rank::time);
    const int from = static_cast<int>(busy - ranks.begin()), to = static_cast<int>(idle - ranks.begin());
    if (from == to) break;
    const Exchange best = bestExchange(loads, ranks, from, to);
    if (!(busy->time() - best.time > price * (best.takes ? 2.0 : 1.0))) break;
    move(best.given, to);
    if (best.takes) move(best.taken, from);
  }
  return moves;
}

Replay replay(std::span<const RecordedStep> steps, int ranks, double letter, double price) {
  Replay result;
  FarmLoads loads{{}, {}, std::vector<int>(static_cast<std::size_t>(ranks), 1)};
  for (const RecordedStep& step : steps) {
    if (step.empty()) continue;
    const std::size_t points = step.front().size();
    for (std::size_t p = loads.owner.size(); p < points; ++p)
      loads.owner.push_back(static_cast<int>(p % static_cast<std::size_t>(ranks)));
    std::vector<double> sums(points, 0.0);
    for (const std::vector<double>& seconds : step) {
      loads.seconds = seconds;
      result.farm += std::ranges::max(timesOfRanks(loads)) + letter * (ranks - 1);
      for (std::size_t p = 0; p < points; ++p) {
        result.alone += seconds[p];
        sums[p] += seconds[p];
      }
    }
    loads.seconds = sums;
    for (const FarmMove& move : worthwhileMoves(loads, price)) {
      loads.owner[move.point] = move.to;
      result.farm += price;
      ++result.moves;
    }
  }
  return result;
}

}  // namespace dovetail::hierarchical
