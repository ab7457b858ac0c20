#include "projection.hpp"

#include <Eigen/LU>

namespace dovetail::rve {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Nearest values of one component, in the norm of the masses, that the conditions allow.
void projectOn(const Frame& frame, const Freedom& freedom, const std::vector<double>& mass, std::vector<double>& v) {
  const auto grain = [&](int q) { return at(frame.grain[at(q)]); };
  for (const int q : freedom.held) v[grain(q)] = 0.0;
  const auto massOf = [&](const std::vector<int>& set) {
    double sum = 0.0;
    for (const int q : set) sum += mass[grain(q)];
    return sum;
  };
  for (const std::vector<int>& set : freedom.together) {
    double momentum = 0.0;
    for (const int q : set) momentum += mass[grain(q)] * v[grain(q)];
    for (const int q : set) v[grain(q)] = momentum / massOf(set);
  }
  if (freedom.balanced.empty()) return;
  Eigen::Vector2d motion = Eigen::Vector2d::Zero();
  Eigen::Matrix2d areas = Eigen::Matrix2d::Zero();
  for (const std::vector<int>& set : freedom.balanced) {
    const Eigen::Vector2d area = areaOf(frame, set);
    motion += v[grain(set.front())] * area;
    areas += area * area.transpose() / massOf(set);
  }
  const Eigen::Vector2d multiplier = inverseOfAreas(areas) * motion;
  for (const std::vector<int>& set : freedom.balanced) {
    const double taken = multiplier.dot(areaOf(frame, set)) / massOf(set);
    for (const int q : set) v[grain(q)] -= taken;
  }
}

/// The frame's grains, turned by an angle.
void turnFrame(const Frame& frame, Components& v, const Eigen::Vector2d& direction) {
  for (const int grain : frame.grain) {
    const std::size_t g = at(grain);
    const Eigen::Vector2d old(v[0][g], v[1][g]);
    v[0][g] = direction[0] * old[0] - direction[1] * old[1];
    v[1][g] = direction[1] * old[0] + direction[0] * old[1];
  }
}

}  // namespace

Eigen::Matrix2d inverseOfAreas(const Eigen::Matrix2d& areas) {
  const double trace = areas.trace();
  if (trace == 0.0) return areas;
  if (areas.determinant() > 1e-12 * trace * trace) return areas.inverse();
  return areas / (trace * trace);
}

Eigen::Vector2d areaOf(const Frame& frame, const std::vector<int>& set) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const int q : set) sum += Eigen::Vector2d(frame.area[at(q)].x, frame.area[at(q)].y);
  return sum;
}

Eigen::Vector2d alongOf(const Rve& cell) {
  if (!cell.frame.byComponent) return Eigen::Vector2d::UnitX();
  return cell.state.F.col(0).head<2>().normalized();
}

void project(const Rve& cell, Components& v, Components& spin) {
  const Frame& frame = cell.frame;
  if (frame.empty()) return;
  const Eigen::Vector2d along = alongOf(cell);
  if (frame.byComponent) turnFrame(frame, v, {along[0], -along[1]});
  for (std::size_t k = 0; k < 2; ++k) projectOn(frame, frame.freedom[k], cell.mass, v[k]);
  if (frame.byComponent) turnFrame(frame, v, along);
  projectOn(frame, frame.freedom[2], cell.inertia, spin[2]);
}

namespace {

void scale(Components& values, const std::vector<double>& mass, bool divide) {
  for (std::vector<double>& component : values)
    for (std::size_t i = 0; i < component.size(); ++i) component[i] *= divide ? 1.0 / mass[i] : mass[i];
}

}  // namespace

void freeForces(const Rve& cell, Components& force, Components& torque) {
  force = cell.state.force;
  torque = cell.state.torque;
  if (cell.frame.empty()) return;
  scale(force, cell.mass, true);
  scale(torque, cell.inertia, true);
  project(cell, force, torque);
  scale(force, cell.mass, false);
  scale(torque, cell.inertia, false);
}

}  // namespace dovetail::rve
