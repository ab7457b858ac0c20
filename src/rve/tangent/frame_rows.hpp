// Conditions of a frame as equations of the network.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// Σ c · (w_x, w_y, turn) = 0 over grains, each with its c.
using FrameRow = std::vector<std::pair<int, Eigen::Vector3d>>;

struct FrameRows {
  /// Of every grain: the one with which it moves and turns; −1 if it does neither.
  std::vector<int> leader;
  /// What is left: coefficients of displacements are at most 1, those of turns lengths, m.
  std::vector<FrameRow> rows;
};

FrameRows rowsOf(const Rve& cell);

}  // namespace dovetail::rve
