// Steps of a cell.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "cell/own_state.hpp"
#include "contacts/contact_list.hpp"
#include "contacts/sweep.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/lane_sum.hpp"
#include "dovetail/core/vector_code.hpp"
#include "dovetail/rve/rve.hpp"
#include "projection.hpp"

namespace dovetail::rve {

namespace {

using Lanes = double[lanes];

/// Calls body(first, count) for eight items at a time and then for the rest: loops over count become vectors, and sums
/// in lanes have an order of their own.
template <class Body>
void inLanes(std::size_t n, const Body& body) {
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) body(i, std::integral_constant<std::size_t, lanes>{});
  if (i < n) body(i, n - i);
}

double kick(std::vector<double>& v, const std::vector<double>& force, const std::vector<double>& mass, double dt,
            double damping) {
  double* const __restrict to = v.data();
  const double* const __restrict f = force.data();
  const double* const __restrict m = mass.data();
  LaneSum taken;
  inLanes(v.size(), [&](std::size_t i, auto count) {
    for (std::size_t l = 0; l < count; ++l) {
      const double before = to[i + l], push = f[i + l], against = damping * std::abs(push);
      // Without branches: signs are guessed wrong too often.
      const double drag = against * (static_cast<double>(before > 0.0) - static_cast<double>(before < 0.0));
      const double after = before + dt * (push - drag) / m[i + l];
      taken.lane[l] += 0.5 * dt * drag * (before + after);
      to[i + l] = after;
    }
  });
  return taken.total();
}

/// x ← G (x + v dt). Returns the largest |v|², NaN if one is not finite.
template <int dimension>
double advance(CellState& s, double dt, const Eigen::Matrix3d& G) {
  double* x[dimension];
  const double* v[dimension];
  double g[dimension][dimension];
  for (int k = 0; k < dimension; ++k) {
    x[k] = s.x[static_cast<std::size_t>(k)].data();
    v[k] = s.v[static_cast<std::size_t>(k)].data();
    for (int l = 0; l < dimension; ++l) g[k][l] = G(k, l);
  }
  Lanes most = {};
  LaneSum sum2;
  inLanes(s.x[0].size(), [&](std::size_t i, auto count) {
    double moved[dimension][lanes];
    Lanes speed2 = {};
    for (int k = 0; k < dimension; ++k)
      for (std::size_t l = 0; l < count; ++l) {
        const double speed = v[k][i + l];
        moved[k][l] = x[k][i + l] + dt * speed;
        speed2[l] += speed * speed;
      }
    for (int k = 0; k < dimension; ++k)
      for (std::size_t l = 0; l < count; ++l) {
        double sum = g[k][0] * moved[0][l];
        for (int j = 1; j < dimension; ++j) sum += g[k][j] * moved[j][l];
        x[k][i + l] = sum;
      }
    for (std::size_t l = 0; l < count; ++l) {
      most[l] = most[l] < speed2[l] ? speed2[l] : most[l];
      sum2.lane[l] += speed2[l];
    }
  });
  const double fastest2 = *std::max_element(most, most + lanes);
  return std::isfinite(sum2.total()) ? fastest2 : std::nan("");
}

Vec3 product(const Eigen::Matrix3d& G, const Vec3& a) {
  return {G(0, 0) * a.x + G(0, 1) * a.y + G(0, 2) * a.z, G(1, 0) * a.x + G(1, 1) * a.y + G(1, 2) * a.z,
          G(2, 0) * a.x + G(2, 1) * a.y + G(2, 2) * a.z};
}

[[noreturn]] void throwNotFinite(const Components& v) {
  for (std::size_t i = 0; i < v[0].size(); ++i)
    for (const std::vector<double>& component : v)
      if (!component.empty() && !std::isfinite(component[i] * component[i]))
        throw NumericalError("the velocity is " + formatNumber(component[i]) + " m/s",
                             "grain " + std::to_string(i) + " of a cell", "take shorter steps");
  throw NumericalError("velocities are not finite", "cell of grains", "take shorter steps");
}

void requirePlane(const Rve& cell, const Eigen::Matrix3d& G) {
  if (cell.shape == Shape::sphere) return;
  if (G(2, 2) == 1.0 && G(0, 2) == 0.0 && G(1, 2) == 0.0 && G(2, 0) == 0.0 && G(2, 1) == 0.0) return;
  throw InputError("discs are deformed out of their plane", "cell of grains",
                   "let the third row and column of the deformation be 0, 0, 1");
}

/// All motion of a step; the springs feel it.
void move(Rve& cell, double dt, const Eigen::Matrix3d& G) {
  CellState& s = cell.state;
  const bool deforms = G != Eigen::Matrix3d::Identity();
  Eigen::Matrix3d L = Eigen::Matrix3d::Zero();
  if (deforms) {
    if (!(G.determinant() > 0.0))
      throw NumericalError("the determinant of the step's deformation is " + formatNumber(G.determinant()),
                           "cell of grains", "take smaller steps, and deformations that turn nothing inside out");
    requirePlane(cell, G);
    // Cayley's: a turn has no rate of strain.
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    if (!((G + one).determinant() > 0.1))
      throw NumericalError("a step rotates the cell by nearly 180 degrees", "cell of grains",
                           "rotate it in smaller steps");
    L = (2.0 / dt) * (G - one) * (G + one).inverse();
    s.ledger.work += 0.5 * dt * s.virial.cwiseProduct(0.5 * (L + L.transpose())).sum();
    for (Vec3& period : s.lattice.period) period = product(G, period);
    s.F = G * s.F;
  }
  double fastest2 = 0.0;
  withVectors([&] { fastest2 = cell.shape == Shape::disc ? advance<2>(s, dt, G) : advance<3>(s, dt, G); });
  if (!std::isfinite(fastest2)) throwNotFinite(s.v);
  const Eigen::Matrix3d D = 0.5 * (L + L.transpose());
  s.remainingSkin -= dt * (2.0 * std::sqrt(fastest2) + D.norm() * listReach(cell));
  if (!(s.remainingSkin > 0.0)) updateNeighbourList(cell);
  sweep(cell, dt, L);
  requireFiniteForces(cell);
  if (deforms) s.ledger.work += 0.5 * dt * s.virial.cwiseProduct(D).sum();
}

/// Kicks all grains; returns what damping has taken, J.
double kickAll(Rve& cell, const Components& force, const Components& torque, double dt, double damping) {
  CellState& s = cell.state;
  double taken = 0.0;
  withVectors([&] {
    for (std::size_t k = 0; k < 3; ++k) {
      taken += kick(s.v[k], force[k], cell.mass, dt, damping);
      taken += kick(s.spin[k], torque[k], cell.inertia, dt, damping);
    }
  });
  return taken;
}

double workOf(const Components& force, const Components& v, double dt) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < force[k].size(); ++i) sum += dt * force[k][i] * v[k][i];
  return sum;
}

/// The same within the space of the frame: reactions are not damped, and hold what damping does to their conditions.
double kickFramed(Rve& cell, double dt, double damping) {
  CellState& s = cell.state;
  Components force, torque;
  freeForces(cell, force, torque);
  const auto halfWork = [&] { return workOf(force, s.v, 0.5 * dt) + workOf(torque, s.spin, 0.5 * dt); };
  double taken = halfWork() + kineticEnergy(cell);
  kickAll(cell, force, torque, dt, damping);
  project(cell, s.v, s.spin);
  taken += halfWork() - kineticEnergy(cell);
  return taken;
}

}  // namespace

void step(Rve& cell, double dt, const Eigen::Matrix3d& G, double damping) {
  CellState& s = cell.state;
  if (!(dt > 0.0 && dt <= s.criticalStep))
    throw InputError(
        "a step of " + formatNumber(dt) + " s where the critical one is " + formatNumber(s.criticalStep) + " s",
        "cell of grains", "take a fraction below 1 of CellState::criticalStep");
  requireFraction(damping, "damping", "cell of grains", true);
  s.ledger.damping +=
      cell.frame.empty() ? kickAll(cell, s.force, s.torque, dt, damping) : kickFramed(cell, dt, damping);
  move(cell, dt, G);
}

void deform(Rve& cell, const Eigen::Matrix3d& G) {
  Components v = std::move(cell.state.v), spin = std::move(cell.state.spin);
  for (std::size_t k = 0; k < 3; ++k) {
    cell.state.v[k].assign(v[k].size(), 0.0);
    cell.state.spin[k].assign(spin[k].size(), 0.0);
  }
  move(cell, 1.0, G);
  cell.state.v = std::move(v);
  cell.state.spin = std::move(spin);
}

Eigen::Matrix3d relativeDeformation(const Rve& cell, const Eigen::Matrix3d& F) {
  Eigen::Matrix3d G = F * cell.state.F.inverse();
  if (cell.shape == Shape::sphere) return G;
  requirePlane(cell, F);
  G.row(2) << 0.0, 0.0, 1.0;
  G.col(2) << 0.0, 0.0, 1.0;
  return G;
}

namespace {

void requireLike(const Components& field, const Components& own, const char* what) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (field[k].size() != own[k].size())
      throw InputError("component " + std::to_string(k) + " has " + std::to_string(field[k].size()) + " numbers for " +
                           std::to_string(own[k].size()),
                       what, "give one a grain of the components that CellState has");
    const auto bad = std::ranges::find_if(field[k], [](double value) { return !std::isfinite(value); });
    if (bad != field[k].end())
      throw InputError("the one of grain " + std::to_string(bad - field[k].begin()) + " is " + formatNumber(*bad), what,
                       "give finite numbers");
  }
}

}  // namespace

void displace(Rve& cell, Components w, Components theta) {
  requireLike(w, cell.state.v, "displacements of a cell's grains");
  requireLike(theta, cell.state.spin, "turns of a cell's grains");
  Components v = std::move(cell.state.v), spin = std::move(cell.state.spin);
  cell.state.v = std::move(w);
  cell.state.spin = std::move(theta);
  move(cell, 1.0, Eigen::Matrix3d::Identity());
  cell.state.v = std::move(v);
  cell.state.spin = std::move(spin);
}

void stop(Rve& cell) {
  cell.state.ledger.damping += kineticEnergy(cell);
  for (Components* field : {&cell.state.v, &cell.state.spin})
    for (std::vector<double>& component : *field) std::fill(component.begin(), component.end(), 0.0);
}

void save(const Rve& cell, CellState& kept) { kept = cell.state; }

void restore(Rve& cell, const CellState& kept) {
  requireOwn(cell, kept);
  cell.state = kept;
}

}  // namespace dovetail::rve
