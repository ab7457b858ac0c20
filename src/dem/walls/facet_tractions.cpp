#include "dovetail/dem/walls/facet_tractions.hpp"

#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/triangle.hpp"

namespace dovetail::dem {

void gatherTractions(FacetTractions& tractions, const TriangulatedWall& wall, const WallContacts& contacts, double dt) {
  tractions.time += requirePositive(dt, "time that contacts stand for");
  tractions.impulse.resize(wall.facets.size());
  for (std::size_t c = 0; c < contacts.size(); ++c)
    tractions.impulse[static_cast<std::size_t>(contacts.facet[c])] -= dt * contacts.force[c];
}

std::vector<Vec3> meanTractions(const FacetTractions& tractions, const TriangulatedWall& wall) {
  std::vector<Vec3> mean(wall.facets.size());
  for (std::size_t t = 0; t < tractions.impulse.size(); ++t) {
    const auto corner = [&](std::size_t k) { return wall.x[static_cast<std::size_t>(wall.facets[t][k])]; };
    const double area = 0.5 * norm(geometry::triangleAreaNormal(corner(0), corner(1), corner(2)));
    if (area > 0.0 && tractions.time > 0.0) mean[t] = tractions.impulse[t] / (area * tractions.time);
  }
  return mean;
}

}  // namespace dovetail::dem
