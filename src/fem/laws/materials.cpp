#include "dovetail/fem/laws/materials.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::fem {

LameConstants lameConstants(double youngsModulus, double poissonRatio) {
  return {youngsModulus * poissonRatio / ((1.0 + poissonRatio) * (1.0 - 2.0 * poissonRatio)),
          youngsModulus / (2.0 * (1.0 + poissonRatio))};
}

double density(const Material& material) {
  return std::visit([](const auto& law) { return law.density; }, material);
}
double youngsModulus(const Material& material) {
  return std::visit([](const auto& law) { return law.youngsModulus; }, material);
}
double poissonRatio(const Material& material) {
  return std::visit([](const auto& law) { return law.poissonRatio; }, material);
}

void validate(const Material& material) {
  requirePositive(youngsModulus(material), "youngsModulus");
  requirePositive(density(material), "density");
  const double nu = poissonRatio(material);
  if (!(nu > -1.0 && nu < 0.5))
    throw InputError("poissonRatio is " + formatNumber(nu), "material", "give a value above -1 and below 0.5");
}

}  // namespace dovetail::fem
