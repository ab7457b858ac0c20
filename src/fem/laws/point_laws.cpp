#include "dovetail/fem/laws/point_laws.hpp"

#include "dovetail/core/error.hpp"
#include "elastic_laws.hpp"
#include "log_laws.hpp"

namespace dovetail::fem {
namespace detail {

/// Enough for stiffnessLeft > 0: λ s sᵀ is never negative, and no eigenvalue of C is below 1 − |C − 1|.
bool surelyStiff(double lambda, double mu, const Tensor<double>& C) {
  double doubleTrace = 0.0, squares = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    const double strain = C[k] - (k % 4 == 0 ? 1.0 : 0.0);
    squares += strain * strain;
    if (k % 4 == 0) doubleTrace += strain;
  }
  return lambda >= 0.0 && squares < 0.4 && 0.5 * lambda * doubleTrace + mu * (2.0 - 3.0 * std::sqrt(squares)) > 0.0;
}

std::string StVenantKirchhoffLaw::whyInvalid(const double* F) const {
  if (surelyStiff(lambda, mu, gram(asTensor(F)))) return {};
  if (stiffnessLeft(constants, F) > 0.0) return {};
  const Spectrum<double> C = spectrum(gram(asTensor(F)));
  std::string text = "St Venant-Kirchhoff is past its limit point at the stretches";
  for (const double square : C.value) text.append(1, ' ').append(formatNumber(std::sqrt(square)));
  return text + " (a bar softens below 1/sqrt(3) = 0.577): use a neo-Hookean law";
}

}  // namespace detail

double stiffnessLeft(const StVenantKirchhoff& law, const double* F) {
  const LameConstants lame = lameConstants(law.youngsModulus, law.poissonRatio);
  const detail::Spectrum<double> C = detail::spectrum(gram(detail::asTensor(F)));
  const double doubleTrace = C.value[0] + C.value[1] + C.value[2] - 3.0;
  Tensor<double> hessian;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b)
      hessian[3 * a + b] = lame.lambda * std::sqrt(C.value[a] * C.value[b]) +
                           (a == b ? 0.5 * lame.lambda * doubleTrace + lame.mu * (3.0 * C.value[a] - 1.0) : 0.0);
  const std::array<double, 3> eigenvalues = detail::spectrum(hessian).value;
  return *std::min_element(eigenvalues.begin(), eigenvalues.end()) / lame.mu;
}

NeoHookean neoHookean(double youngsModulus, double poissonRatio, double density) {
  validate(Material(StVenantKirchhoff{youngsModulus, poissonRatio, density}));
  return {youngsModulus / (3.0 * (1.0 - 2.0 * poissonRatio)), youngsModulus / (2.0 * (1.0 + poissonRatio)), density};
}

std::shared_ptr<const PointMaterial> pointMaterial(const NeoHookean& law) {
  requirePositive(law.bulkModulus, "bulkModulus");
  requirePositive(law.shearModulus, "shearModulus");
  return elasticMaterial("neo-Hookean", law.density, detail::NeoHookeanLaw{law.bulkModulus, law.shearModulus});
}

std::shared_ptr<const PointMaterial> pointMaterial(const CoupledNeoHookean& law) {
  using Volume = CoupledNeoHookean::Volume;
  requirePositive(law.mu, "mu");
  requirePositive(3.0 * law.lambda + 2.0 * law.mu, "3 lambda + 2 mu");
  if (law.volume == Volume::logarithm)
    return elasticMaterial("coupled neo-Hookean", law.density,
                           detail::CoupledNeoHookeanLaw<Volume::logarithm>{law.lambda, law.mu});
  return elasticMaterial("coupled neo-Hookean", law.density,
                         detail::CoupledNeoHookeanLaw<Volume::quadratic>{law.lambda, law.mu});
}

std::shared_ptr<const PointMaterial> pointMaterial(const Hencky& law) {
  const NeoHookean moduli = neoHookean(law.youngsModulus, law.poissonRatio, law.density);
  return elasticMaterial("Hencky", law.density, detail::HenckyLaw{{moduli.bulkModulus, moduli.shearModulus}});
}

std::shared_ptr<const PointMaterial> pointMaterial(const Material& material) {
  validate(material);
  const double youngs = youngsModulus(material), rho = density(material);
  const LameConstants lame = lameConstants(youngs, poissonRatio(material));
  if (const auto* law = std::get_if<StVenantKirchhoff>(&material))
    return elasticMaterial("St Venant-Kirchhoff", rho, detail::StVenantKirchhoffLaw{*law, lame.lambda, lame.mu});
  if (const auto* law = std::get_if<DeformedMetricHooke>(&material))
    return elasticMaterial("Hooke on the deformed metric", rho, detail::DeformedMetricLaw{*law, lame.lambda, lame.mu});
  return elasticMaterial("axial springs", rho, detail::AxialSpringsLaw{std::get<AxialSprings>(material), youngs});
}

}  // namespace dovetail::fem
