#include "projection.hpp"

#include <Eigen/LU>

namespace dovetail::rve {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void joinAlike(const Rve& cell, const std::vector<int>& group, Components& v, Components& spin) {
  double mass = 0.0, inertia = 0.0;
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  // and, third, the angular one
  for (const int q : group) {
    const std::size_t g = at(cell.frame.grain[at(q)]);
    mass += cell.mass[g];
    inertia += cell.inertia[g];
    momentum += Eigen::Vector3d(cell.mass[g] * v[0][g], cell.mass[g] * v[1][g], cell.inertia[g] * spin[2][g]);
  }
  for (const int q : group) {
    const std::size_t g = at(cell.frame.grain[at(q)]);
    v[0][g] = momentum[0] / mass;
    v[1][g] = momentum[1] / mass;
    spin[2][g] = momentum[2] / inertia;
  }
}

}  // namespace

Eigen::Matrix2d inverseOfAreas(const Eigen::Matrix2d& areas) {
  const double trace = areas.trace();
  if (areas.determinant() > 1e-12 * trace * trace) return areas.inverse();
  return areas / (trace * trace);
}

void project(const Rve& cell, Components& v, Components& spin) {
  const Frame& frame = cell.frame;
  if (frame.empty()) return;
  for (const int q : frame.those(Condition::displacement)) {
    const std::size_t g = at(frame.grain[at(q)]);
    v[0][g] = v[1][g] = spin[2][g] = 0.0;
  }
  for (const std::vector<int>& group : frame.alike)
    if (frame.on[at(group.front())] == Condition::periodic) joinAlike(cell, group, v, spin);
  const std::vector<int> free = frame.those(Condition::traction);
  if (free.empty()) return;
  Eigen::Matrix2d motion = Eigen::Matrix2d::Zero(), areas = Eigen::Matrix2d::Zero();
  for (const int q : free) {
    const std::size_t g = at(frame.grain[at(q)]);
    const Eigen::Vector2d area(frame.area[at(q)].x, frame.area[at(q)].y);
    motion += Eigen::Vector2d(v[0][g], v[1][g]) * area.transpose();
    areas += area * area.transpose() / cell.mass[g];
  }
  const Eigen::Matrix2d multiplier = motion * inverseOfAreas(areas);
  for (const int q : free) {
    const std::size_t g = at(frame.grain[at(q)]);
    const Eigen::Vector2d area(frame.area[at(q)].x, frame.area[at(q)].y);
    const Eigen::Vector2d taken = multiplier * area / cell.mass[g];
    v[0][g] -= taken[0];
    v[1][g] -= taken[1];
  }
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
