#include "dovetail/dem/laws/materials.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

double mean(Mean rule, double a, double b) {
  switch (rule) {
    case Mean::harmonic:
      return a + b > 0.0 ? 2.0 * a * b / (a + b) : 0.0;
    case Mean::geometric:
      return std::sqrt(a * b);
    case Mean::arithmetic:
      return 0.5 * (a + b);
    case Mean::smaller:
      return std::min(a, b);
    case Mean::larger:
      return std::max(a, b);
  }
  throw InputError("there is no such mean", "mixing rule", "give one of Mean's");
}

double effectiveModulus(const Material& a, const Material& b) {
  const auto compliance = [](const Material& m) { return (1.0 - m.poissonRatio * m.poissonRatio) / m.youngsModulus; };
  return 1.0 / (compliance(a) + compliance(b));
}

double effectiveShearModulus(const Material& a, const Material& b) {
  const auto compliance = [](const Material& m) {
    return 2.0 * (2.0 - m.poissonRatio) * (1.0 + m.poissonRatio) / m.youngsModulus;
  };
  return 1.0 / (compliance(a) + compliance(b));
}

double mindlinRatio(const Material& a, const Material& b) {
  return 4.0 * effectiveShearModulus(a, b) / effectiveModulus(a, b);
}

Surface mean(Mean rule, const Surface& a, const Surface& b) {
  return {mean(rule, a.restitution, b.restitution), mean(rule, a.friction, b.friction),
          mean(rule, a.tangentialDampingRatio, b.tangentialDampingRatio)};
}

HertzMindlinLaw hertzMindlin(const Material& a, const Material& b, const Surface& surface) {
  validate(a);
  validate(b);
  if (std::isinf(a.youngsModulus) && std::isinf(b.youngsModulus))
    throw InputError("both materials are rigid", "Young's modulus", "make one of them deform");
  HertzMindlinLaw law;
  law.normal.effectiveModulus = effectiveModulus(a, b);
  law.normal.restitution = surface.restitution;
  law.tangential = {mindlinRatio(a, b), surface.friction, surface.tangentialDampingRatio};
  validate(law);
  return law;
}

double equivalentStiffness(const Material& a, const Material& b, double effectiveRadius, double effectiveMass,
                           double speed) {
  const double k = 16.0 / 15.0 * std::sqrt(effectiveRadius) * effectiveModulus(a, b);
  return k * std::pow(effectiveMass * speed * speed / k, 0.2);
}

LawTable<HertzMindlinLaw> hertzMindlinTable(std::span<const Material> materials, std::span<const Surface> surfaces,
                                            Mean rule) {
  if (materials.empty() || materials.size() != surfaces.size())
    throw InputError(
        std::to_string(materials.size()) + " materials and " + std::to_string(surfaces.size()) + " surfaces",
        "contact laws", "give one surface for each material, and one material at least");
  for (std::size_t m = 0; m < materials.size(); ++m) validate(materials[m], "material " + std::to_string(m));
  const auto finite = std::find_if(materials.begin(), materials.end(),
                                   [](const Material& m) { return std::isfinite(m.youngsModulus); });
  if (finite == materials.end())
    throw InputError("all materials are rigid", "contact laws", "give one of them a finite Young's modulus");
  return makeLawTable(static_cast<int>(materials.size()), [&](int a, int b) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const bool rigid = std::isinf(materials[i].youngsModulus) && std::isinf(materials[j].youngsModulus);
    return hertzMindlin(materials[i], rigid ? *finite : materials[j], mean(rule, surfaces[i], surfaces[j]));
  });
}

void validate(const Material& material, const std::string& name) {
  if (!(material.youngsModulus > 0.0))
    throw InputError("Young's modulus is " + formatNumber(material.youngsModulus), name,
                     "give a number greater than zero, infinite for a rigid wall");
  if (!(material.poissonRatio > -1.0 && material.poissonRatio <= 0.5))
    throw InputError("Poisson's ratio is " + formatNumber(material.poissonRatio), name, "give −1 < ν ≤ 0.5");
  requireNonNegative(material.density, name + ", density");
}

}  // namespace dovetail::dem
