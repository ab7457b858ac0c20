// Elements that bend too softly or too stiffly in thin parts of solids.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "build/parts.hpp"
#include "build/time_functions.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_thickness.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

constexpr double slender = 5.0;     // length over thickness of what bends
constexpr double tolerated = 0.15;  // of the stiffness in bending

/// Whether anything but the elements keeps a face from moving along a direction, as in layers between plates, or bends
/// it, as a body that it is tied to.
bool isHeld(const coupling::SolidSide& side, const std::set<std::size_t>& masters, const fem::Face& face,
            const Vec3& along) {
  const fem::DofMap& dofs = side.mass->dofs();
  for (int k = 0; k < fem::cornersOf(face.shape); ++k)
    for (int c = 0; c < 3; ++c) {
      const auto node = static_cast<std::size_t>(face.node[static_cast<std::size_t>(k)]);
      const std::size_t dof = 3 * node + static_cast<std::size_t>(c);
      if (std::abs(along[c]) > 0.5 && dofs.role(dof) == fem::Role::free && !masters.contains(dof)) return false;
    }
  return true;
}

/// Components of nodes that other parts of the mesh are tied to, as 3 node + component.
std::set<std::size_t> mastersOf(const coupling::SolidSide& side) {
  std::set<std::size_t> masters;
  for (const fem::Tie& tie : side.model->constraints.ties)
    for (const fem::Tie::Master& master : tie.masters)
      masters.insert(3 * static_cast<std::size_t>(master.node) + static_cast<std::size_t>(master.component));
  return masters;
}

// ---- what bends

constexpr double square = 1e-3;

bool isAcross(const Vec3& direction, const Vec3& normal) {
  return std::abs(dot(direction, normal)) > square * norm(direction);
}
bool isAcross(const TimeVector& motion, const Vec3& normal) {
  for (std::size_t c = 0; c < 3; ++c)
    if ((motion[c].number != 0.0 || !isConstant(motion[c])) && std::abs(normal[static_cast<int>(c)]) > square)
      return true;
  return false;
}
bool isAcross(const Load& load, const fem::SolidMesh& mesh, const Vec3& normal) {
  const auto* const traction = std::get_if<TractionLoad>(&load.kind);
  if (const auto* const force = std::get_if<NodalLoad>(&load.kind)) return isAcross(force->force, normal);
  return (traction && isAcross(traction->traction, normal)) ||
         std::ranges::any_of(fem::faceSet(mesh, load.on), [&](const fem::Face& face) {
           const auto at = [&](std::size_t k) { return mesh.X[static_cast<std::size_t>(face.node[k])]; };
           return isAcross(cross(at(1) - at(0), at(2) - at(0)), normal);
         });
}

/// Whether it can be told that a part is stretched in its plane alone: something loads the solid, and nothing does so
/// along the normal of the part, or on its broad sides.
bool isOnlyStretched(const Scene& scene, const Solid& solid, const fem::SolidMesh& mesh, const Vec3& normal) {
  const auto couples = [&](const Coupling& one) { return one.solid == solid.name; };
  const auto moves = [](const Support& one) {
    return one.displacement || one.turn || !isConstant(one.velocity) || norm(constantOf(one.velocity)) > 0.0;
  };
  if (solid.loads.empty() && std::ranges::none_of(solid.supports, moves)) return false;
  if (std::ranges::any_of(scene.couplings, couples) || isAcross(solid.velocity, normal)) return false;
  if (solid.gravity && isAcross(scene.gravity, normal)) return false;
  return std::ranges::none_of(solid.loads, [&](const Load& one) { return isAcross(one, mesh, normal); }) &&
         solid.planes.empty() && std::ranges::none_of(solid.supports, [&](const Support& one) {
           return one.turn || isAcross(one.displacement.value_or(one.velocity), normal);
         });
}

/// Stiffness in bending over the right one. A brick's mean strain has 1 − 1/n² of it, the strain that is linear in it
/// the rest; with that goes a shear strain that no beam has, as large as the brick is long, and a volume strain. What
/// tetrahedra and mean dilatation make of that is fitted to beams of 1 to 4 layers and bricks of aspect ½ to 2 (within
/// a tenth).
double stiffnessOf(fem::ElementShape shape, const std::string& formulation, const fem::MeshThickness& place,
                   double nu) {
  const double n = std::max(1.0, place.layers), rest = 1.0 / (n * n);
  const double ratio = place.elementLength / place.thickness, squared = ratio * ratio;
  const double shear = 0.5 * (1.0 - nu) * squared;
  const double volume = 0.5 * ((1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)) - 1.0);
  if (shape == fem::ElementShape::tet4) return 1.0 + (1.65 + 2.5 * nu) * rest + (1.45 - 1.1 * nu) * squared;
  if (shape != fem::ElementShape::hex8) return 1.0;
  if (formulation == "standard") return 1.0 + shear + volume * rest;
  if (formulation == "mean-dilatation") return 1.0 - (0.42 + 0.35 * nu) * rest + shear;
  return formulation == "reduced" ? 1.0 - rest : 1.0;
}

/// Of what lies across a part. @param material  number of that of each element
double largestPoissonOf(const Solid& solid, const std::vector<std::size_t>& material,
                        const std::vector<std::size_t>& elements) {
  const std::vector<const SolidMaterial*> materials = materialsOf(solid);
  double largest = -1.0;
  for (const std::size_t e : elements) largest = std::max(largest, poissonRatioOf(*materials[material[e]]));
  return largest;
}

std::string layersText(double layers) {
  const double n = std::max(1.0, std::round(layers));
  return n == 1.0 ? "1 layer" : formatNumber(n) + " layers";
}

std::string sentence(const std::string& name, const Solid& solid, const fem::MeshThickness& place, double stiffness) {
  const bool tets = place.shape == fem::ElementShape::tet4, soft = stiffness < 1.0;
  std::string text = name + " has " + layersText(place.layers) + " of " +
                     (tets ? std::string("tet4") : "hex8 (\"" + solid.formulation + "\")") + ", " +
                     rounded(place.elementLength) + " m long, across parts " + rounded(place.thickness) +
                     " m thick and " + rounded(place.length) + " m long, which bend ";
  if (stiffness < 0.1)
    text += "many times too softly";
  else
    text += "about " + rounded(soft ? 1.0 / stiffness : stiffness) + " times too " + (soft ? "softly" : "stiffly");
  if (tets) return text + ": take tet10, or bricks with \"formulation\": \"enhanced\".";
  return text + ": write \"formulation\": \"enhanced\"" +
         (soft ? ", or take 4 layers or more." : ", take hex20, or elements no longer than half the thickness.");
}

}  // namespace

void lookAtThickness(const Built& built, const Scene& scene, std::size_t number, Lines& lines) {
  const Solid& solid = scene.solids[number];
  const fem::SolidMesh& mesh = built.meshes[number];
  const coupling::SolidSide& side = built.run->solid(number);
  const std::set<std::size_t> masters = mastersOf(side);
  const std::vector<std::size_t> material = materialByElement(solid, mesh);
  double all = 0.0, bad = 0.0;
  std::vector<std::pair<double, fem::MeshThickness>> found;
  for (const fem::MeshThickness& place : fem::measureThickness(mesh)) {
    all += place.area;
    if (place.length < slender * place.thickness || isHeld(side, masters, place.face, place.normal) ||
        isHeld(side, masters, place.opposite, place.normal) || isOnlyStretched(scene, solid, mesh, place.normal))
      continue;
    const double stiffness =
        stiffnessOf(place.shape, solid.formulation, place, largestPoissonOf(solid, material, place.elements));
    if (stiffness > 1.0 - tolerated && stiffness < 1.0 + tolerated) continue;
    bad += place.area;
    found.emplace_back(stiffness, place);
  }
  constexpr double fraction = 0.1;  // of the boundary: fillets and feet of ribs are not what bends
  if (found.empty() || bad < fraction * all) return;
  std::ranges::sort(found, {}, [](const auto& one) { return one.second.thickness; });
  const auto& [stiffness, place] = found[found.size() / 2];
  lines.push_back(sentence(quoted(solid.name), solid, place, stiffness));
}

Lines hourglassIn(const Built& built) {
  constexpr double fraction = 0.1;
  Lines lines;
  for (std::size_t s = 0; s < built.run->solids(); ++s) {
    const coupling::SolidSide& side = built.run->solid(s);
    double hourglass = 0.0, all = 0.0;
    for (const auto& term : side.model->terms)
      if (auto* const elements = dynamic_cast<fem::Solid*>(term.get())) {
        hourglass += elements->hourglassEnergy(side.nodes());
        all += elements->energy(side.nodes(), {.t = side.model->t});
      }
    if (hourglass > fraction * all && all > 0.0)
      lines.push_back("of the elastic energy of " + quoted(side.name) + " " +
                      formatNumber(std::round(100.0 * hourglass / all)) +
                      " % is in the hourglass stiffness of its elements, which is not the material's: take more layers "
                      "of elements where it bends, or \"formulation\": \"enhanced\"");
  }
  return lines;
}

}  // namespace dovetail::scene
