// Steps of a cell.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "contact_list.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/cell.hpp"
#include "projection.hpp"
#include "sweep.hpp"

namespace dovetail::rve {

namespace {

/// Sums of successive items in four lanes, in an order of its own.
template <class Term>
double laneSum(std::size_t n, const Term& term) {
  double lane[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (std::size_t l = 0; l < 4; ++l) lane[l] += term(i + l);
  for (; i < n; ++i) lane[0] += term(i);
  return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

double kick(std::vector<double>& v, const std::vector<double>& force, const std::vector<double>& mass, double dt,
            double damping) {
  double* const to = v.data();
  const double* const f = force.data();
  const double* const m = mass.data();
  if (damping == 0.0) {
    for (std::size_t i = 0; i < v.size(); ++i) to[i] += dt * f[i] / m[i];
    return 0.0;
  }
  return laneSum(v.size(), [&](std::size_t i) {
    const double before = to[i], against = damping * std::abs(f[i]);
    // Without branches: signs are guessed wrong too often.
    const double drag = against * (static_cast<double>(before > 0.0) - static_cast<double>(before < 0.0));
    to[i] = before + dt * (f[i] - drag) / m[i];
    return 0.5 * dt * drag * (before + to[i]);
  });
}

double largestSpeed2(const CellState& s) {
  double lane[4] = {};
  const std::size_t n = s.v[0].size();
  const double* const x = s.v[0].data();
  const double* const y = s.v[1].data();
  const double* const z = s.v[2].empty() ? nullptr : s.v[2].data();
  const auto see = [&](std::size_t i, double& most) {
    const double speed2 = x[i] * x[i] + y[i] * y[i] + (z ? z[i] * z[i] : 0.0);
    most = most < speed2 ? speed2 : most;
  };
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4)
    for (std::size_t l = 0; l < 4; ++l) see(i + l, lane[l]);
  for (; i < n; ++i) see(i, lane[0]);
  return std::max(std::max(lane[0], lane[1]), std::max(lane[2], lane[3]));
}

void drift(CellState& s, double dt) {
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < s.x[k].size(); ++i) s.x[k][i] += dt * s.v[k][i];
}

Vec3 product(const Eigen::Matrix3d& G, const Vec3& a) {
  return {G(0, 0) * a.x + G(0, 1) * a.y + G(0, 2) * a.z, G(1, 0) * a.x + G(1, 1) * a.y + G(1, 2) * a.z,
          G(2, 0) * a.x + G(2, 1) * a.y + G(2, 2) * a.z};
}

void carry(CellState& s, const Eigen::Matrix3d& G) {
  const std::size_t n = s.x[0].size();
  double* const x = s.x[0].data();
  double* const y = s.x[1].data();
  if (s.x[2].empty()) {
    const double a = G(0, 0), b = G(0, 1), c = G(1, 0), d = G(1, 1);
    for (std::size_t i = 0; i < n; ++i) {
      const double xi = x[i], yi = y[i];
      x[i] = a * xi + b * yi;
      y[i] = c * xi + d * yi;
    }
  } else {
    double* const z = s.x[2].data();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 moved = product(G, {x[i], y[i], z[i]});
      x[i] = moved.x;
      y[i] = moved.y;
      z[i] = moved.z;
    }
  }
  for (Vec3& period : s.lattice.period) period = product(G, period);
  s.F = G * s.F;
}

void requireAnswer(const Cell& cell) {
  if (cell.state.dyad.allFinite()) return;
  throw NumericalError("forces are not finite", "cell of grains", "take shorter steps");
}

void requirePlane(const Cell& cell, const Eigen::Matrix3d& G) {
  if (cell.shape == Shape::sphere) return;
  if (G(2, 2) == 1.0 && G(0, 2) == 0.0 && G(1, 2) == 0.0 && G(2, 0) == 0.0 && G(2, 1) == 0.0) return;
  throw InputError("discs are deformed out of their plane", "cell of grains",
                   "let the third row and column of the deformation be 0, 0, 1");
}

/// All motion of a step; the springs feel it.
void move(Cell& cell, double dt, const Eigen::Matrix3d& G) {
  CellState& s = cell.state;
  const bool deforms = G != Eigen::Matrix3d::Identity();
  Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
  drift(s, dt);
  if (deforms) {
    if (!(G.determinant() > 0.0))
      throw NumericalError("the determinant of the step's deformation is " + formatNumber(G.determinant()),
                           "cell of grains", "take smaller steps, and deformations that turn nothing inside out");
    requirePlane(cell, G);
    // Cayley's: a turn has no rate of strain.
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    L = (2.0 / dt) * (G - one) * (G + one).inverse();
    s.book.work += 0.5 * dt * s.dyad.cwiseProduct(0.5 * (L + L.transpose())).sum();
    carry(s, G);
  }
  const Eigen::Matrix3d D = 0.5 * (L + L.transpose());
  s.room -= dt * (2.0 * std::sqrt(largestSpeed2(s)) + D.norm() * listReach(cell));
  if (!(s.room > 0.0)) renew(cell);
  sweep(cell, dt, L);
  requireAnswer(cell);
  if (deforms) s.book.work += 0.5 * dt * s.dyad.cwiseProduct(D).sum();
}

}  // namespace

void step(Cell& cell, double dt, const Eigen::Matrix3d& G, double damping) {
  CellState& s = cell.state;
  for (std::size_t k = 0; k < 3; ++k) {
    s.book.damping += kick(s.v[k], s.force[k], cell.mass, dt, damping);
    s.book.damping += kick(s.spin[k], s.torque[k], cell.inertia, dt, damping);
  }
  project(cell, s.v, s.spin);
  move(cell, dt, G);
}

void deform(Cell& cell, const Eigen::Matrix3d& G) {
  Components v = std::move(cell.state.v), spin = std::move(cell.state.spin);
  for (std::size_t k = 0; k < 3; ++k) {
    cell.state.v[k].assign(v[k].size(), 0.0);
    cell.state.spin[k].assign(spin[k].size(), 0.0);
  }
  move(cell, 1.0, G);
  cell.state.v = std::move(v);
  cell.state.spin = std::move(spin);
}

Eigen::Matrix3d relativeDeformation(const Cell& cell, const Eigen::Matrix3d& F) {
  Eigen::Matrix3d G = F * cell.state.F.inverse();
  if (cell.shape == Shape::sphere) return G;
  requirePlane(cell, F);
  G.row(2) << 0.0, 0.0, 1.0;
  G.col(2) << 0.0, 0.0, 1.0;
  return G;
}

void displace(Cell& cell, Components w, Components theta) {
  Components v = std::move(cell.state.v), spin = std::move(cell.state.spin);
  cell.state.v = std::move(w);
  cell.state.spin = std::move(theta);
  move(cell, 1.0, Eigen::Matrix3d::Identity());
  cell.state.v = std::move(v);
  cell.state.spin = std::move(spin);
}

void stop(Cell& cell) {
  cell.state.book.damping += kineticEnergy(cell);
  for (Components* field : {&cell.state.v, &cell.state.spin})
    for (std::vector<double>& component : *field) std::fill(component.begin(), component.end(), 0.0);
}

void save(const Cell& cell, CellState& kept) { kept = cell.state; }

void restore(Cell& cell, const CellState& kept) {
  if (kept.x[0].size() != cell.size())
    throw InputError(
        "the state is of " + std::to_string(kept.x[0].size()) + " grains, the cell has " + std::to_string(cell.size()),
        "cell of grains", "give back what this cell has saved");
  cell.state = kept;
}

}  // namespace dovetail::rve
