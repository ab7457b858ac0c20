// Values at the quadrature points of solids, and their means over elements.
#pragma once

#include <string>
#include <vector>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/scene/build.hpp"

namespace dovetail::mpm {
class PointSolid;
}  // namespace dovetail::mpm

namespace dovetail::scene {

/// Values side by side, per point or cell.
struct MeshField {
  std::string name;
  std::vector<double> values;
  int components = 1;
  bool perCell = true;
};

/// All points of the elements of a model, or its material points, as they are now.
struct Points {
  struct Part {
    std::string name;              ///< of the term
    const fem::PointField* field;  ///< null for elements with a law
    fem::Solid::Sample sample;     ///< of material points: as the forces have asked last, elements −1
  };
  std::vector<Part> parts;

  std::size_t size() const {
    std::size_t count = 0;
    for (const Part& part : parts) count += part.sample.element.size();
    return count;
  }
};
Points pointsOf(const fem::Model& model);

// Of material points: m, m/s (of the grid there), and half the edge of what a point stands for now, m.
std::vector<Vec3> displacementsOf(const mpm::PointSolid& body, const fem::Nodes& nodes);
std::vector<Vec3> velocitiesOf(const mpm::PointSolid& body, const fem::Nodes& nodes);
std::vector<double> radiiOf(const mpm::PointSolid& body, const PointMesh& mesh);

/// Calls act(part, p) for every point, p its number in the part.
template <class Act>
void forEachPoint(const Points& points, Act&& act) {
  for (const Points::Part& part : points.parts)
    for (std::size_t p = 0; p < part.sample.element.size(); ++p) act(part, p);
}

/// "stress", nine numbers (Cauchy, row-major, Pa, > 0 in tension).
MeshField stressAt(const Points& points);
/// "von_mises" and "pressure" (−tr σ/3, > 0 in compression), Pa, of stresses.
std::vector<MeshField> invariantsOf(const MeshField& stress);

/// "strain", the logarithmic one by its principal stretches, nine numbers; "volume_strain" ln det F; "shear_strain"
/// √(2 e : e) with e its deviator, in simple shear the angle for small ones; "turn", axis times angle (rad, 0 to π) of
/// R in F = R U.
std::vector<MeshField> strainsAt(const Points& points);

/// What the material remembers: "plastic_strain" (accumulated, √⅔ times its rate's norm) and "plastic_volume" (det Fₚ)
/// of laws that flow; "history", all numbers, of others that remember something. 0 at points of other laws.
std::vector<MeshField> historyAt(const Points& points, const Solid& solid);

/// "deformation_gradient" F, nine numbers, row-major.
MeshField deformationAt(const Points& points);

enum class Volumes { reference, present };
/// Means of the points of each element of the mesh, by their volumes; zero for elements that are not modelled.
MeshField meansOf(const Points& points, const MeshField& field, std::size_t elements, Volumes volumes);

}  // namespace dovetail::scene
