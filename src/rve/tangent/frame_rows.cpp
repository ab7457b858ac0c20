#include "frame_rows.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>

#include "motion/projection.hpp"

namespace dovetail::rve {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <class Item>
bool has(const std::vector<Item>& items, const Item& item) {
  return std::ranges::find(items, item) != items.end();
}

/// Whether all components have it: then no equation is needed.
template <class Item>
bool allHave(const Frame& frame, std::vector<Item> Freedom::*items, const Item& item) {
  return std::ranges::all_of(frame.freedom, [&](const Freedom& freedom) { return has(freedom.*items, item); });
}

/// One equation for each direction that areas have.
void addBalance(const Frame& frame, const Freedom& freedom, const Eigen::Vector3d& direction,
                std::vector<FrameRow>& rows) {
  Eigen::Matrix2d areas = Eigen::Matrix2d::Zero();
  double largest = 0.0;
  for (const std::vector<int>& set : freedom.balanced) {
    const Eigen::Vector2d area = areaOf(frame, set);
    areas += area * area.transpose();
    largest = std::max(largest, area.norm());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(areas);
  for (int k = 0; k < 2; ++k) {
    if (!(solver.eigenvalues()[k] > 1e-12 * areas.trace())) continue;
    FrameRow row;
    for (const std::vector<int>& set : freedom.balanced)
      row.emplace_back(frame.grain[at(set.front())],
                       solver.eigenvectors().col(k).dot(areaOf(frame, set)) / largest * direction);
    rows.push_back(std::move(row));
  }
}

}  // namespace

FrameRows rowsOf(const Rve& cell) {
  const Frame& frame = cell.frame;
  const auto grain = [&](int q) { return frame.grain[at(q)]; };
  FrameRows found;
  found.leader.resize(cell.size());
  std::iota(found.leader.begin(), found.leader.end(), 0);
  const Eigen::Vector2d along = alongOf(cell);
  const double arm = 0.5 * meanDiameter(cell);
  const std::array<Eigen::Vector3d, 3> directions{Eigen::Vector3d(along[0], along[1], 0.0),
                                                  Eigen::Vector3d(-along[1], along[0], 0.0),
                                                  Eigen::Vector3d(0.0, 0.0, arm)};
  for (std::size_t c = 0; c < 3; ++c) {
    const Freedom& freedom = frame.freedom[c];
    for (const int q : freedom.held)
      if (allHave(frame, &Freedom::held, q))
        found.leader[at(grain(q))] = -1;
      else
        found.rows.push_back({{grain(q), directions[c]}});
    for (const std::vector<int>& set : freedom.together) {
      const bool all = allHave(frame, &Freedom::together, set);
      for (std::size_t k = 1; k < set.size(); ++k)
        if (all)
          found.leader[at(grain(set[k]))] = grain(set.front());
        else
          found.rows.push_back({{grain(set[k]), directions[c]}, {grain(set.front()), -directions[c]}});
    }
    if (!freedom.balanced.empty()) addBalance(frame, freedom, directions[c], found.rows);
  }
  return found;
}

}  // namespace dovetail::rve
