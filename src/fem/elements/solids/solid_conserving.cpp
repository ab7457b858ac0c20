// Energy-momentum steps of the formulations that have no conserving stress of their own.
#include <algorithm>

#include "elements/kernels/conserving_pairs.hpp"
#include "solid_base.hpp"

namespace dovetail::fem::detail {

namespace {

struct alignas(laneBytes) Move {
  std::array<Lane, 3 * maxCellNodes> mean, change;  ///< positions ½(x₀ + x₁); u₁ − u₀ beside the first node, m
};

Move moveOf(const SolidCells& cells, const BatchTask& task) {
  Move move;
  for (std::size_t a = 0; a < cells.nodes; ++a)
    for (std::size_t lane = 0; lane < laneCount; ++lane) {
      const auto node = static_cast<std::size_t>(cells.batchNode[cells.nodes * task.batch + a][lane]);
      const auto first = static_cast<std::size_t>(cells.batchNode[cells.nodes * task.batch][lane]);
      const Vec3 shift = task.u[first] - task.start[first], whole = task.u[node] - task.start[node];
      const Vec3 change = whole - shift, mean = cells.X[node] + task.start[node] + 0.5 * whole;
      for (int i = 0; i < 3; ++i) {
        move.mean[3 * a + static_cast<std::size_t>(i)][static_cast<int>(lane)] = mean[i];
        move.change[3 * a + static_cast<std::size_t>(i)][static_cast<int>(lane)] = change[i];
      }
    }
  return move;
}

/// Whether the distances from the first node change their vectors by less than shortMove.
bool shortIn(const Move& move, std::size_t nodes, int lane) {
  for (std::size_t a = 3; a < 3 * nodes; a += 3) {
    double length = 0.0, change = 0.0;
    for (std::size_t i = a; i < a + 3; ++i) {
      const double x = move.mean[i][lane] - move.mean[i - a][lane], u = move.change[i][lane] - move.change[i - a][lane];
      length += x * x;
      change += u * u;
    }
    if (!(change < shortMove * shortMove * length)) return false;
  }
  return true;
}

/// W₁ − W₀ − f̄·Δu by quadrature on the path and by the energies, J.
struct alignas(laneBytes) LackingWork {
  Lane onPath, ofEnergies;
};

}  // namespace

void SolidBase::setPath(std::span<const Vec3> u0, std::span<const Vec3> u1) {
  constexpr double places[3] = {0.11270166537925831148, 0.5, 0.88729833462074168852};
  for (std::size_t p = 0; p < 3; ++p) {
    path_[p].resize(u0.size());
    for (std::size_t n = 0; n < u0.size(); ++n) path_[p][n] = u0[n] + places[p] * (u1[n] - u0[n]);
  }
}

void SolidBase::balancedForces(const BatchTask& task, BatchResult& result) {
  const std::size_t n = cells_.nodes;
  const Move move = moveOf(cells_, task);
  const auto forcesAt = [&](const Vec3* u, bool withEnergy, BatchResult& there) {
    forces({task.batch, u, nullptr, task.dt, withEnergy, false}, there);
  };
  forcesAt(path_[1].data(), false, result);
  std::array<bool, laneCount> isShort{};
  for (int lane = 0; lane < laneCount; ++lane) isShort[static_cast<std::size_t>(lane)] = shortIn(move, n, lane);
  LackingWork lack{};
  BatchResult a, b;
  if (std::ranges::find(isShort, true) != isShort.end()) {
    forcesAt(path_[0].data(), false, a);
    forcesAt(path_[2].data(), false, b);
    for (std::size_t k = 0; k < 3 * n; ++k)
      lack.onPath += 5.0 / 18.0 * ((a.f[k] - result.f[k]) + (b.f[k] - result.f[k])) * move.change[k];
  }
  if (std::ranges::find(isShort, false) != isShort.end()) {
    forcesAt(task.start, true, a);
    forcesAt(task.u, true, b);
    lack.ofEnergies = b.energy - a.energy;
    for (std::size_t k = 0; k < 3 * n; ++k) lack.ofEnergies -= result.f[k] * move.change[k];
  }
  for (std::size_t lane = 0; lane < laneCount; ++lane)
    if (lane >= cells_.inUse(task.batch))
      lack.onPath[static_cast<int>(lane)] = 0.0;
    else if (!isShort[lane])
      lack.onPath[static_cast<int>(lane)] = lack.ofEnergies[static_cast<int>(lane)];
  addPairForces(n, move.mean.data(), move.change.data(), lack.onPath, result.f.data());
}

}  // namespace dovetail::fem::detail
