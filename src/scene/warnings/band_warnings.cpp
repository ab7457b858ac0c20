// Bands of materials that soften.
#include <algorithm>
#include <cmath>
#include <limits>

#include "build/parts.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

namespace {

constexpr double elementsPerBand = 5.0;

/// The steepest fall between points (a, stress) behind the first stress, Pa; 0 if there is none.
template <class Points, class Value>
double steepestFall(double first, const Points& points, Value&& value) {
  double a = 0.0, before = first, fall = 0.0;
  for (const auto& point : points) {
    fall = std::max(fall, (before - point.*value) / (point.plasticStrain - a));
    a = point.plasticStrain, before = point.*value;
  }
  return fall;
}

/// By how much the shear stress falls per plastic shear strain √3 a, Pa.
double fallOf(const J2Plastic& law) {
  return steepestFall(law.yieldStress, law.hardeningCurve, &YieldPoint::yieldStress) / 3.0;
}
double fallOf(const DruckerPrager& law) {
  const fem::DruckerPrager cone{law.youngsModulus, law.poissonRatio, 1.0, 1.0, law.frictionAngle, law.dilatancyAngle};
  return fem::coneConstants(cone).cohesive * steepestFall(law.cohesion, law.cohesionCurve, &CohesionPoint::cohesion) /
         std::sqrt(3.0);
}
template <class Law>
double fallOf(const Law&) {
  return 0.0;
}

/// Of a sheared layer of a material, with the gradient; infinite if it does not soften.
double widthOf(const SolidMaterial& material, double modulus) {
  const double fall = std::visit([](const auto& law) { return fallOf(law); }, material.law);
  const double shear = std::visit(
      [](const auto& law) {
        if constexpr (requires { law.poissonRatio; }) return 0.5 * law.youngsModulus / (1.0 + law.poissonRatio);
        return 0.0;
      },
      material.law);
  if (!(fall > 0.0 && fall < shear)) return std::numeric_limits<double>::infinity();
  return fem::bandWidth(modulus, shear * fall / (shear - fall), shear);
}

/// Mean of the middle edges of the elements of a material, m: a layer of bricks counts by its edges in the plane.
double elementLength(const fem::SolidMesh& mesh, const std::vector<std::size_t>& material, std::size_t number) {
  double sum = 0.0;
  std::size_t count = 0, e = 0;
  for (const fem::ElementGroup& group : mesh.groups) {
    const auto nodes = static_cast<std::size_t>(fem::nodesOf(group.shape));
    for (std::size_t first = 0; first < group.node.size(); first += nodes, ++e) {
      if (material[e] != number) continue;
      std::vector<double> edges;
      for (const auto& [a, b] : fem::edgesOf(group.shape))
        edges.push_back(norm(mesh.X[static_cast<std::size_t>(group.node[first + static_cast<std::size_t>(a)])] -
                             mesh.X[static_cast<std::size_t>(group.node[first + static_cast<std::size_t>(b)])]));
      std::ranges::sort(edges);
      sum += 0.5 * (edges[(edges.size() - 1) / 2] + edges[edges.size() / 2]);
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

/// With as many points as strains, which cannot form a band without bending.
bool locksInBands(const Solid& solid, const fem::SolidMesh& mesh) {
  return solid.formulation == "standard" && std::ranges::any_of(mesh.groups, [](const fem::ElementGroup& group) {
           return group.shape == fem::ElementShape::quad4 || group.shape == fem::ElementShape::hex8;
         });
}

}  // namespace

void lookAtBands(const Built& built, const Scene& scene, std::size_t number, Lines& lines) {
  const Solid& solid = scene.solids[number];
  const fem::SolidMesh& mesh = built.meshes[number];
  const std::vector<std::size_t> material = materialByElement(solid, mesh);
  const std::vector<const SolidMaterial*> materials = materialsOf(solid);
  const bool ofCells = std::ranges::any_of(materials, [](const SolidMaterial* one) { return hasCells(*one); });
  if (!solid.gradient && !ofCells) return;
  const auto* const onGrid = std::get_if<PointMesh>(&solid.mesh);
  double fewest = std::numeric_limits<double>::infinity(), width = 0.0, length = 0.0;
  for (std::size_t m = 0; solid.gradient && m < materials.size(); ++m) {
    const double own = widthOf(*materials[m], solid.gradient->modulus);
    const double h = onGrid ? onGrid->grid.spacing : elementLength(mesh, material, m);
    if (!(h > 0.0 && own / h < fewest)) continue;
    fewest = own / h, width = own, length = h;
  }
  if (fewest < elementsPerBand)
    lines.push_back(quoted(solid.name) + " gets bands about " + rounded(width) + " m wide, " + rounded(fewest) +
                    (onGrid ? " cells of its grid: take cells of " : " of its elements: take elements of ") +
                    rounded(width / elementsPerBand) + " m or less, or a gradient modulus of " +
                    rounded(solid.gradient->modulus * std::pow(elementsPerBand * length / width, 2)) + " N.");
  if (solid.gradient && !solid.ties.empty())
    lines.push_back(
        "The gradient of " + quoted(solid.name) +
        " ends at its ties: a band along them is half as wide as elsewhere. Join the nodes of its parts, or "
        "tie them where nothing softens.");
  const bool softens = !std::isinf(fewest) || (ofCells && (solid.gradient || fem::dimensionOf(mesh) == 2));
  if (softens && locksInBands(solid, mesh))
    lines.push_back(quoted(solid.name) + " has " + fem::name(mesh.groups.front().shape) +
                    " of the standard formulation, which are too stiff in bands: take " +
                    (fem::dimensionOf(mesh) == 2 ? "quad8 with \"formulation\": \"reduced\"."
                                                 : "\"formulation\": \"reduced\", or in plane strain quad8."));
}

}  // namespace dovetail::scene
