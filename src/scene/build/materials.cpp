// Materials of solids of a scene.
#include "dovetail/fem/laws/plasticity.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "parts.hpp"

namespace dovetail::scene {

namespace {

auto make(const StVenantKirchhoff& law, double density) {
  return fem::pointMaterial(fem::StVenantKirchhoff{law.youngsModulus, law.poissonRatio, density});
}
auto make(const NeoHookean& law, double density) {
  return fem::pointMaterial(fem::neoHookean(law.youngsModulus, law.poissonRatio, density));
}
auto make(const J2Plastic& law, double density) {
  return fem::pointMaterial(fem::J2Plasticity{law.youngsModulus, law.poissonRatio, density,
                                              fem::linearYield(law.yieldStress, law.hardening)});
}
auto make(const DruckerPrager& law, double density) {
  return fem::pointMaterial(fem::DruckerPrager{law.youngsModulus, law.poissonRatio, density, law.cohesion,
                                               law.frictionAngle, law.dilatancyAngle});
}
auto make(const AxialSprings& law, double density) {
  return fem::pointMaterial(fem::AxialSprings{law.youngsModulus, density});
}
auto make(const DeformedMetric& law, double density) {
  return fem::pointMaterial(fem::DeformedMetricHooke{law.youngsModulus, law.poissonRatio, density});
}

}  // namespace

std::shared_ptr<const fem::PointMaterial> makeMaterial(const SolidMaterial& material) {
  return std::visit([&](const auto& law) { return make(law, material.density); }, material.law);
}

}  // namespace dovetail::scene
