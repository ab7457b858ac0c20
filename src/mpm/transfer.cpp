#include "transfer.hpp"

#include "dovetail/core/parallel.hpp"
#include "scatter.hpp"

namespace dovetail::mpm::detail {

namespace {

constexpr std::size_t pointChunk = 512;

/// Of nodes as the points of a cell see them.
struct Motion {
  OfReached<Vec3> u, v, v0;
};

Vec3 meanOf(const OfReached<Vec3>& values, const double* weight, std::size_t count) {
  Vec3 sum;
  for (std::size_t a = 0; a < count; ++a) sum += weight[a] * values[a];
  return sum;
}

/// The part that turns by the arms of nodes as they are now, which keeps the angular momentum; the part that stretches
/// by the arms that they had when the grid was laid out, with which lone points stay in bounds.
void findMoment(const GridRows& rows, std::size_t p, const Motion& nodes, const Vec3& x0, const Vec3& moved,
                double* moment) {
  std::array<double, 9> now{}, then{};
  const Vec3* const reached = &rows.reached[rows.perPoint * static_cast<std::size_t>(rows.cell[p])];
  const double* const weight = &rows.weight[rows.perPoint * p];
  for (std::size_t a = 0; a < rows.perPoint; ++a) {
    const Vec3 velocity = weight[a] * nodes.v[a], arm0 = reached[a] - x0, arm = arm0 + nodes.u[a] - moved;
    addOuter<3>(velocity, arm, now.data());
    addOuter<3>(velocity, arm0, then.data());
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      moment[3 * i + j] = 0.5 * (then[3 * i + j] + then[3 * j + i]) + 0.5 * (now[3 * i + j] - now[3 * j + i]);
}

}  // namespace

void leaveGrid(const GridRows& rows, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const Vec3> v0,
               double keep, Carried& points) {
  const bool affine = !points.moment.empty();
  eachCell(rows, [&](std::size_t c) {
    Motion nodes;
    look(rows, c, u, nodes.u);
    look(rows, c, v, nodes.v);
    if (!affine) look(rows, c, v0, nodes.v0);
    eachPointOf(rows, c, [&](std::size_t p) {
      const auto at = [&](const OfReached<Vec3>& values) {
        return meanOf(values, &rows.weight[rows.perPoint * p], rows.perPoint);
      };
      const Vec3 moved = at(nodes.u), now = at(nodes.v);
      if (affine) findMoment(rows, p, nodes, points.x[p], moved, &points.moment[9 * p]);
      points.v[p] = affine ? now : now + keep * (points.v[p] - at(nodes.v0));
      points.x[p] += moved;
    });
  });
}

std::vector<double> massesOf(const GridRows& rows, const Carried& points) {
  std::vector<double> mass(rows.nodes(), 0.0);
  addToNodes<double>(rows, mass, [&](std::size_t p, OfReached<double>& sums) {
    for (std::size_t a = 0; a < rows.perPoint; ++a) sums[a] += points.mass[p] * rows.weight[rows.perPoint * p + a];
  });
  return mass;
}

std::vector<Vec3> velocitiesOf(const GridRows& rows, const GridOptions& grid, const Carried& points,
                               std::span<const double> mass) {
  const double moment = secondMoment(grid.shape) * grid.spacing * grid.spacing;
  std::vector<Vec3> v(rows.nodes());
  addToNodes<Vec3>(rows, v, [&](std::size_t p, OfReached<Vec3>& sums) {
    const double* const weight = &rows.weight[rows.perPoint * p];
    const Vec3* const reached = &rows.reached[rows.perPoint * static_cast<std::size_t>(rows.cell[p])];
    for (std::size_t a = 0; a < rows.perPoint; ++a) {
      Vec3 own = points.v[p];
      if (!points.moment.empty()) addProduct<3>(&points.moment[9 * p], 1.0 / moment * (reached[a] - points.x[p]), own);
      sums[a] += points.mass[p] * weight[a] * own;
    }
  });
  for (std::size_t n = 0; n < v.size(); ++n)
    for (int c = 0; c < 3; ++c) v[n][c] = rows.fixed[n] >> c & 1 || !(mass[n] > 0.0) ? 0.0 : v[n][c] / mass[n];
  return v;
}

double kineticEnergy(const GridOptions& grid, const Carried& points) {
  const double moment = secondMoment(grid.shape) * grid.spacing * grid.spacing;
  return parallelSum(points.x.size(), pointChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t p = begin; p < end; ++p) {
      double own = squaredNorm(points.v[p]);
      if (!points.moment.empty())
        for (std::size_t k = 9 * p; k < 9 * p + 9; ++k) own += points.moment[k] * points.moment[k] / moment;
      sum += 0.5 * points.mass[p] * own;
    }
    return sum;
  });
}

}  // namespace dovetail::mpm::detail
