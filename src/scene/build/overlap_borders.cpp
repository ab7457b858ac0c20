// Where the two models of an overlap end.
#include <algorithm>

#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "parts.hpp"

namespace dovetail::scene {

void requireBorders(const Overlap& overlap) {
  const bool planes = overlap.solidBorder && overlap.particleBorder, boxes = overlap.solidBox && overlap.particleBox;
  const bool anyPlane = overlap.solidBorder || overlap.particleBorder, anyBox = overlap.solidBox || overlap.particleBox;
  if (planes == boxes || (anyPlane && anyBox))
    throw InputError(anyPlane && anyBox ? "the overlap lies between two planes and between two boxes"
                                        : "the overlap has not got two borders",
                     "", "give solid_border and particle_border, or solid_box and particle_box");
  if (planes && *overlap.solidBorder == *overlap.particleBorder)
    throw InputError("the two borders of an overlap coincide", "", "move them apart");
}

std::vector<double> overlapPlaces(const Overlap& overlap, std::span<const Vec3> points) {
  if (overlap.solidBox) return arlequin::boxCoordinate(points, *overlap.solidBox, *overlap.particleBox);
  std::vector<double> places;
  for (const Vec3& x : points)
    places.push_back(1.0 -
                     (x[overlap.axis] - *overlap.particleBorder) / (*overlap.solidBorder - *overlap.particleBorder));
  return places;
}

std::vector<double> overlapWeights(const Overlap& overlap, const fem::SolidMesh& mesh) {
  std::vector<double> place = overlapPlaces(overlap, mesh.X);
  for (double& s : place) s = s > 1.0 + 1e-9 ? arlequin::beyondOverlap : std::clamp(s, 0.0, 1.0);
  std::vector<double> weight = arlequin::nodalWeights(
      place, {.profile = static_cast<arlequin::WeightProfile>(overlap.profile), .floor = overlap.floor});
  arlequin::levelMidNodes(mesh, weight);
  return weight;
}

}  // namespace dovetail::scene
