// Materials of solids of a scene.
#include "dovetail/fem/laws/material_probe.hpp"
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/laws/viscosity.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

auto make(const StVenantKirchhoff& law, double density) {
  return fem::pointMaterial(fem::StVenantKirchhoff{law.youngsModulus, law.poissonRatio, density});
}
auto make(const NeoHookean& law, double density) {
  return fem::pointMaterial(fem::neoHookean(law.youngsModulus, law.poissonRatio, density));
}
fem::YieldCurve yieldOf(const J2Plastic& law) {
  if (law.hardeningCurve.empty()) return fem::linearYield(law.yieldStress, law.hardening);
  if (law.hardening > 0.0)
    throw InputError("both hardening and a hardening_curve are given", "material", "leave one of them out");
  std::vector<std::pair<double, double>> points{{0.0, law.yieldStress}};
  for (const YieldPoint& point : law.hardeningCurve) points.emplace_back(point.plasticStrain, point.yieldStress);
  return fem::tabulatedYield(points);
}
auto make(const J2Plastic& law, double density) {
  return fem::pointMaterial(fem::J2Plasticity{law.youngsModulus, law.poissonRatio, density, yieldOf(law),
                                              law.kinematicModulus, law.recovery});
}
auto make(const DruckerPrager& law, double density) {
  fem::DruckerPrager made{law.youngsModulus, law.poissonRatio,  density,
                          law.cohesion,      law.frictionAngle, law.dilatancyAngle};
  if (law.cohesionCurve.empty()) return fem::pointMaterial(made);
  std::vector<std::pair<double, double>> points{{0.0, law.cohesion}};
  for (const CohesionPoint& point : law.cohesionCurve) points.emplace_back(point.plasticStrain, point.cohesion);
  made.cohesion = 0.0;
  made.cohesionCurve = fem::tabulatedYield(points);
  return fem::pointMaterial(made);
}
auto make(const AxialSprings& law, double density) {
  return fem::pointMaterial(fem::AxialSprings{law.youngsModulus, density});
}
auto make(const DeformedMetric& law, double density) {
  return fem::pointMaterial(fem::DeformedMetricHooke{law.youngsModulus, law.poissonRatio, density});
}
std::shared_ptr<const fem::PointMaterial> make(const GrainCells&, double) { return nullptr; }

}  // namespace

std::shared_ptr<const fem::PointMaterial> makeMaterial(const SolidMaterial& material) {
  std::shared_ptr<const fem::PointMaterial> made = std::visit(
      [&](const auto& law) -> std::shared_ptr<const fem::PointMaterial> { return make(law, material.density); },
      material.law);
  if (material.dampingTime == 0.0) return made;
  return fem::pointMaterial(
      fem::kelvinVoigt(std::move(made), material.dampingTime, *youngsModulusOf(material), poissonRatioOf(material)));
}

std::optional<double> youngsModulusOf(const SolidMaterial& material) {
  return std::visit(
      [](const auto& law) -> std::optional<double> {
        if constexpr (requires { law.youngsModulus; }) return law.youngsModulus;
        return {};
      },
      material.law);
}

double poissonRatioOf(const SolidMaterial& material) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.poissonRatio; }) return law.poissonRatio;
        return 0.0;
      },
      material.law);
}

double confinedModulusOf(const SolidMaterial& material, const Built& built) {
  if (const auto* const cells = std::get_if<GrainCells>(&material.law)) return confinedModulus(*cells, built);
  return fem::moduliAtRest(*makeMaterial(material)).confined;
}

std::vector<const SolidMaterial*> materialsOf(const Solid& solid) {
  std::vector<const SolidMaterial*> all{&solid.material};
  for (const MaterialRegion& region : solid.regions) all.push_back(&region.material);
  return all;
}

const SolidMaterial& materialOf(const Solid& solid, const std::string& term) {
  const MaterialRegion* found = nullptr;  // the longest name: those of shapes may stand behind it
  for (const MaterialRegion& region : solid.regions)
    if (term.starts_with(region.elements) && (!found || region.elements.size() > found->elements.size()))
      found = &region;
  return found ? found->material : solid.material;
}

std::vector<std::size_t> materialByElement(const Solid& solid, const fem::SolidMesh& mesh) {
  std::vector<std::size_t> numbers(mesh.elementCount(), 0);
  for (std::size_t k = 0; k < solid.regions.size(); ++k)
    atPlace(solid.regions[k].where, [&] {
      for (const int element : fem::elementSet(mesh, solid.regions[k].elements)) {
        std::size_t& number = numbers[static_cast<std::size_t>(element)];
        if (number > 0)
          throw InputError("element " + std::to_string(element) + " is in two regions, \"" +
                               solid.regions[number - 1].elements + "\" and \"" + solid.regions[k].elements + "\"",
                           "", "let regions have no element in common");
        number = k + 1;
      }
    });
  return numbers;
}

}  // namespace dovetail::scene
