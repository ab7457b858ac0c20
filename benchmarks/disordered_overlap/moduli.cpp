#include "moduli.hpp"

#include <cmath>

#include "dovetail/dem/model/walls.hpp"

namespace dovetail::disordered_overlap {

namespace {

/// Slope of the displacements along `axis` against height, over the middle of the column, each grain by its mass.
double slope(const std::vector<Vec3>& before, const dem::Particles& now, int axis, double bottom, double top) {
  const double margin = 0.1 * (top - bottom);
  double m = 0.0, z = 0.0, u = 0.0, zz = 0.0, zu = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double h = before[i].z, moved = now.x[i][axis] - before[i][axis], mass = now.mass[i];
    if (h < bottom + margin || h > top - margin) continue;
    m += mass;
    z += mass * h;
    u += mass * moved;
    zz += mass * h * h;
    zu += mass * h * moved;
  }
  return (zu - z * u / m) / (zz - z * z / m);
}

/// Change of the force on the lid over that of the slope, both along the axis.
double stiffness(const dem::Model& column, int axis, double strain) {
  dem::Model m = column;
  const dem::PrimitiveWall& lid = dem::primitiveWall(m, lidOfPressed);
  const Vec3 force = lid.force;
  const double bottom = dem::primitiveWall(m, floorOfPressed).point.z, top = lid.point.z;
  Vec3 way;
  way[axis] = strain * (top - bottom);
  moveLid(m, way);
  return -(lid.force - force)[axis] / slope(column.particles.x, m.particles, axis, bottom, top);
}

}  // namespace

double Moduli::axialSpeed() const { return std::sqrt(axial / density); }
double Moduli::shearSpeed() const { return std::sqrt(shear / density); }

Moduli probe(const dem::Model& column, double strain) {
  const dem::PrimitiveWall& lid = dem::primitiveWall(column, lidOfPressed);
  const double floorHeight = dem::primitiveWall(column, floorOfPressed).point.z, width = widthOf(column),
               area = width * width;
  Moduli m{};
  m.pressure = lid.force.z / area;
  const double height = lid.point.z - floorHeight;
  m.density = bulkDensity(column.particles, width, floorHeight + 0.1 * height, floorHeight + 0.9 * height);
  m.axial = stiffness(column, 2, strain) / area;
  m.shear = stiffness(column, 0, strain) / area;
  return m;
}

Elastic solidOf(const Moduli& m) {
  double axial = m.axial, F = 1.0;
  for (int round = 0; round < 50; ++round) {
    F = std::sqrt(1.0 - 2.0 * m.pressure / (axial * F));
    axial = m.axial / (F * (0.5 * (F * F - 1.0) + F * F));
  }
  const double shear = (m.shear + m.pressure) / F, poisson = (axial - 2.0 * shear) / (2.0 * (axial - shear));
  return {m.density * F, 2.0 * shear * (1.0 + poisson), poisson};
}

}  // namespace dovetail::disordered_overlap
