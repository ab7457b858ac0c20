// Steps of a cell.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "cell/own_state.hpp"
#include "contacts/contact_list.hpp"
#include "contacts/sweep.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/rve.hpp"
#include "grains.hpp"
#include "polar.hpp"
#include "projection.hpp"

namespace dovetail::rve {

namespace {

Vec3 product(const Eigen::Matrix3d& G, const Vec3& a) {
  return {G(0, 0) * a.x + G(0, 1) * a.y + G(0, 2) * a.z, G(1, 0) * a.x + G(1, 1) * a.y + G(1, 2) * a.z,
          G(2, 0) * a.x + G(2, 1) * a.y + G(2, 2) * a.z};
}

/// @throws NumericalError naming a grain that would go further than the cell is wide: images could not tell where it is
void requireSlow(const Rve& cell, double dt, double fastest2) {
  const std::array<double, 3> widths = cell.state.lattice.widths();
  const double most = *std::min_element(widths.begin(), widths.begin() + cell.dimension()) / dt;
  if (fastest2 <= most * most) return;
  const Components& v = cell.state.v;
  for (std::size_t i = 0; i < v[0].size(); ++i)
    for (const std::vector<double>& component : v)
      if (!component.empty() && !(component[i] * component[i] <= most * most / 3.0))
        throw NumericalError("the velocity is " + formatNumber(component[i]) + " m/s",
                             "grain " + std::to_string(i) + " of a cell", "take shorter steps");
  throw NumericalError("velocities are not finite", "cell of grains", "take shorter steps");
}

void requirePlane(const Rve& cell, const Eigen::Matrix3d& G) {
  if (cell.shape == Shape::sphere || isPlane(G)) return;
  throw InputError("discs are deformed out of their plane", "cell of grains",
                   "let the third row and column of the deformation be 0, 0, 1");
}

/// @throws NumericalError if G turns the cell inside out, InputError if it takes discs out of their plane
Polar polarOf(const Rve& cell, const Eigen::Matrix3d& G) {
  if (!(G.determinant() > 0.0))
    throw NumericalError("the determinant of the step's deformation is " + formatNumber(G.determinant()),
                         "cell of grains", "take smaller steps, and deformations that turn nothing inside out");
  requirePlane(cell, G);
  return polar(G);
}

/// All motion of a step; the springs feel it. What turns, turns with all that has a direction: the turn strains
/// nothing.
/// @return the turn
Eigen::Matrix3d move(Rve& cell, double dt, const Eigen::Matrix3d& G) {
  CellState& s = cell.state;
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const bool deforms = G != one;
  MeanMotion motion;
  if (deforms) {
    const Polar parts = polarOf(cell, G);
    motion.turn = parts.turn;
    const Eigen::Matrix3d rate = (2.0 / dt) * (parts.stretch - one) * (parts.stretch + one).inverse();
    s.ledger.work += 0.5 * dt * s.virial.cwiseProduct(rate).sum();
    const Eigen::Matrix3d turned = motion.turn * rate * motion.turn.transpose();
    motion.rate = 0.5 * (turned + turned.transpose());
    for (Vec3& period : s.lattice.period) period = product(G, period);
    s.F = G * s.F;
  }
  const double fastest2 = advance(s, dt, G);
  if (!(dt * std::sqrt(fastest2) < cell.skin)) requireSlow(cell, dt, fastest2);
  if (motion.turn != one)
    for (Components* field : {&s.v, &s.spin}) turn(*field, motion.turn);
  s.remainingSkin -= dt * (2.0 * std::sqrt(fastest2) + motion.rate.norm() * listReach(cell));
  if (!(s.remainingSkin > 0.0)) updateNeighbourList(cell);
  sweep(cell, dt, motion);
  requireFiniteForces(cell);
  if (deforms) s.ledger.work += 0.5 * dt * s.virial.cwiseProduct(motion.rate).sum();
  return motion.turn;
}

/// Kicks all grains; returns what damping has taken, J.
double kickAll(Rve& cell, const Components& force, const Components& torque, double dt, double damping) {
  return kick(cell.state.v, force, cell.mass, dt, damping) + kick(cell.state.spin, torque, cell.inertia, dt, damping);
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
  const Eigen::Matrix3d turned = move(cell, 1.0, G);
  cell.state.v = std::move(v);
  cell.state.spin = std::move(spin);
  for (Components* field : {&cell.state.v, &cell.state.spin}) turn(*field, turned);
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
