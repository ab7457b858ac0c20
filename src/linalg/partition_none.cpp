#include "dovetail/linalg/partition.hpp"

namespace dovetail::linalg {

void meetRanks() {}

/// A build without ranks has but one.
std::vector<int> partitionCells(int, std::size_t, int each, std::span<const int> corners) {
  return std::vector<int>(corners.size() / static_cast<std::size_t>(each), 0);
}

}  // namespace dovetail::linalg
