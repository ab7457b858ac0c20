// Where in the mesh of an overlap a particle is, and its weight there.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "dovetail/arlequin/overlap.hpp"
#include "dovetail/fem/mesh/element_locator.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::arlequin {

struct FoundParticle {
  fem::CellPlace place;  ///< element −1: nowhere
  Vec3 x;                ///< m, the image that was found
  double weight = 1.0;
};

inline void addMember(Overlap& overlap, int particle, fem::CellPlace place, const Vec3& x, double weight) {
  overlap.particle.push_back(particle);
  overlap.place.push_back(std::move(place));
  overlap.x.push_back(x);
  overlap.weight.push_back(weight);
}

inline void sortUnique(std::vector<int>& numbers) {
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

/// Elements that hold members, of any weight.
inline void findElements(Overlap& overlap) {
  for (const fem::CellPlace& place : overlap.place)
    if (place.element >= 0) overlap.elements.push_back(place.element);
  sortUnique(overlap.elements);
}

class OverlapLocator {
public:
  /// @param position  of the nodes, m   @param nodalWeight  w per node; both must live as long as this
  OverlapLocator(const fem::SolidMesh& mesh, std::span<const Vec3> position, std::span<const double> nodalWeight,
                 const geometry::Periodicity& space)
      : mesh_(mesh), weight_(nodalWeight), space_(space), cells_(mesh.groups, position) {}

  /// A particle, or an image of it, within the mesh or nearer to it than its radius where the mesh has a weight above
  /// 0. A centre that touches a face from outside, up to round-off, is not near. Any number of threads may ask.
  FoundParticle find(const Vec3& x, double radius) const;

  /// Whether a point, or an image of it, is within the mesh, and its weight there.
  std::optional<double> weightWithin(const Vec3& x) const;

private:
  const fem::SolidMesh& mesh_;
  std::span<const double> weight_;
  geometry::Periodicity space_;
  fem::ElementLocator cells_;
};

}  // namespace dovetail::arlequin
