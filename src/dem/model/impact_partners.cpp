// What walls are to those who may hit them.
#include <algorithm>
#include <cmath>

#include "dovetail/dem/model/impact.hpp"
#include "dovetail/dem/model/walls.hpp"

namespace dovetail::dem {

namespace {

constexpr double lever = 3.0;  // of impacts off the centre of a body

}  // namespace

/// As low as it is below the particles.
void PrimitiveWallTerm::addPartners(const Model& m, std::vector<ImpactPartner>& partners) const {
  if (!present) return;
  const Vec3 round{wall.radius, wall.radius, wall.radius};
  geometry::Box box{wall.point - round, wall.point + round};
  if (wall.shape == PrimitiveWall::Shape::plane && m.particles.size() > 0) {
    const Vec3& x = m.particles.x.front();
    box.lower = box.upper = x - dot(x - wall.point, wall.axis) * wall.axis;
  }
  double farthest = 0.0;
  for (std::size_t i = 0; wall.servo && wall.servo->turns && i < m.particles.size(); ++i)
    farthest = std::max(farthest, wall.servo->leverOf(m.particles.x[i]));
  partners.push_back(
      {.name = "a wall",
       .material = wall.material,
       .inverseMass = wall.servo ? wall.servo->inverseMass(farthest) : 0.0,
       .speed = norm(wall.velocity) + norm(wall.surfaceVelocity) + norm(wall.angularVelocity) * wall.radius,
       .box = box,
       .of = &wall});
}

void MeshWallTerm::addPartners(const Model&, std::vector<ImpactPartner>& partners) const {
  if (!present) return;
  geometry::Box box{mesh.wall.x.front(), mesh.wall.x.front()};
  const auto* servo = std::get_if<WallServo>(&mesh.motion);
  double speed = 0.0, arm = 0.0;
  for (std::size_t v = 0; v < mesh.wall.x.size(); ++v) {
    speed = std::max(speed, norm(mesh.wall.v[v]));
    if (servo && servo->turns) arm = std::max(arm, servo->leverOf(mesh.wall.x[v]));
    for (int c = 0; c < 3; ++c) {
      box.lower[c] = std::min(box.lower[c], mesh.wall.x[v][c]);
      box.upper[c] = std::max(box.upper[c], mesh.wall.x[v][c]);
    }
  }
  const double yields = servo ? servo->inverseMass(arm) : std::isfinite(mesh.wall.mass) ? lever / mesh.wall.mass : 0.0;
  partners.push_back({.name = "a mesh wall",
                      .material = mesh.wall.material,
                      .inverseMass = yields,
                      .speed = speed,
                      .box = box,
                      .of = &mesh});
}

}  // namespace dovetail::dem
