#include "transfer.hpp"

#include "dovetail/core/parallel.hpp"
#include "scatter.hpp"

namespace dovetail::mpm::detail {

namespace {

constexpr std::size_t pointChunk = 512;

/// The part that turns by the arms of nodes as they are now, which keeps the angular momentum; the part that stretches
/// by the arms that they had when the grid was laid out, with which lone points stay in bounds.
void findMoment(const GridRows& rows, std::size_t p, std::span<const Vec3> u, std::span<const Vec3> v, const Vec3& x0,
                const Vec3& moved, double* moment) {
  std::array<double, 9> now{}, then{};
  const std::size_t begin = rows.perPoint * static_cast<std::size_t>(rows.cell[p]);
  for (std::size_t a = 0; a < rows.perPoint; ++a) {
    const auto n = static_cast<std::size_t>(rows.node[begin + a]);
    const std::uint8_t flip = rows.flip[begin + a];
    const double weight = rows.weight[rows.perPoint * p + a];
    const Vec3 velocity = weight * flipped(v[n], flip), arm0 = rows.reached[begin + a] - x0,
               arm = arm0 + flipped(u[n], flip) - moved;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        now[static_cast<std::size_t>(3 * i + j)] += velocity[i] * arm[j];
        then[static_cast<std::size_t>(3 * i + j)] += velocity[i] * arm0[j];
      }
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      moment[3 * i + j] = 0.5 * (then[3 * i + j] + then[3 * j + i]) + 0.5 * (now[3 * i + j] - now[3 * j + i]);
}

}  // namespace

void leaveGrid(const GridRows& rows, std::span<const Vec3> u, std::span<const Vec3> v, std::span<const Vec3> v0,
               double keep, Carried& points) {
  const bool affine = !points.moment.empty();
  parallelFor(rows.points(), pointChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 moved = valueAt(rows, p, u), now = valueAt(rows, p, v);
      if (affine) findMoment(rows, p, u, v, points.x[p], moved, &points.moment[9 * p]);
      points.v[p] = affine ? now : now + keep * (points.v[p] - valueAt(rows, p, v0));
      points.x[p] += moved;
    }
  });
}

std::vector<double> massesOf(const GridRows& rows, const Carried& points) {
  std::vector<double> mass(rows.nodes(), 0.0);
  addToNodes<double>(
      rows, mass, [&](std::size_t p, std::size_t a) { return points.mass[p] * rows.weight[rows.perPoint * p + a]; },
      [](double value, std::uint8_t) { return value; });
  return mass;
}

std::vector<Vec3> velocitiesOf(const GridRows& rows, const GridOptions& grid, const Carried& points,
                               std::span<const double> mass) {
  const double moment = secondMoment(grid.shape) * grid.spacing * grid.spacing;
  std::vector<Vec3> v(rows.nodes());
  addToNodes<Vec3>(
      rows, v,
      [&](std::size_t p, std::size_t a) {
        Vec3 own = points.v[p];
        const std::size_t entry = rows.perPoint * static_cast<std::size_t>(rows.cell[p]) + a;
        if (!points.moment.empty())
          own += 1.0 / moment * times(&points.moment[9 * p], rows.reached[entry] - points.x[p]);
        return points.mass[p] * rows.weight[rows.perPoint * p + a] * own;
      },
      flipped);
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
