#include "dovetail/surface/stepper.hpp"

#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"

namespace dovetail::surface {

void requireCoupledSolid(const fem::Model& solid) { fem::requireBrickSolid(solid, "surface coupling"); }

void kickTouched(const coupling::NodalLoad& load, fem::Nodes& nodes, double dt) {
  for (int node : load.touched) {
    const double scale = dt / nodes.mass[node];
    const unsigned held = nodes.fixed[node];
    const Vec3& f = load.force[node];
    if (!(held & fem::componentX)) nodes.v[node].x += scale * f.x;
    if (!(held & fem::componentY)) nodes.v[node].y += scale * f.y;
    if (!(held & fem::componentZ)) nodes.v[node].z += scale * f.z;
  }
}

void kickTouched(const coupling::NodalLoad& load, fem::ImplicitMotion& solid, double dt) {
  if (solid.mass().isDiagonal()) return kickTouched(load, solid.model().nodes, dt);
  if (!load.touched.empty()) solid.kick(load.force, dt);
}

double workOf(const coupling::NodalLoad& load, std::span<const Vec3> displacement, double scale) {
  double work = 0.0;
  for (int node : load.touched) work += dot(load.force[node], displacement[node]);
  return scale * work;
}

double splittingEnergy(const fem::Nodes& nodes, const coupling::NodalLoad& contact, double h) {
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.X.size(); ++i) {
    const unsigned held = nodes.fixed[i];
    for (int c = 0; c < 3; ++c) {
      if (held & (1u << c)) continue;
      const double elastic = nodes.f[i][c];
      sum += elastic * (contact.force[i][c] / 12.0 + elastic / 24.0) / nodes.mass[i];
    }
  }
  return -h * h * sum;
}

}  // namespace dovetail::surface
