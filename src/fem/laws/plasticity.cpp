#include "dovetail/fem/laws/plasticity.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/laws/materials.hpp"
#include "log_laws.hpp"

namespace dovetail::fem {
namespace {

detail::HenckyElasticity elasticityOf(double youngsModulus, double poissonRatio, double density) {
  validate(Material(StVenantKirchhoff{youngsModulus, poissonRatio, density}));
  return {youngsModulus / (3.0 * (1.0 - 2.0 * poissonRatio)), youngsModulus / (2.0 * (1.0 + poissonRatio))};
}

/// Piece of a table that holds a.
std::size_t pieceOf(const std::vector<std::pair<double, double>>& points, double a) {
  const auto after =
      std::upper_bound(points.begin(), points.end(), a, [](double x, const auto& point) { return x < point.first; });
  return after == points.begin() ? 0 : static_cast<std::size_t>(after - points.begin()) - 1;
}

double slopeOf(const std::vector<std::pair<double, double>>& points, std::size_t piece) {
  if (piece + 1 >= points.size()) return 0.0;
  return (points[piece + 1].second - points[piece].second) / (points[piece + 1].first - points[piece].first);
}

void requireYield(const YieldCurve& yield) {
  if (!yield.stress || !yield.slope || !yield.stored)
    throw InputError("the yield curve has no stress, slope or stored energy", "J2Plasticity",
                     "take saturatingYield, linearYield or tabulatedYield, or set all three functions");
  requirePositive(yield.stress(0.0), "yield stress");
}

}  // namespace

YieldCurve saturatingYield(double initial, double linear, double saturation, double exponent) {
  requirePositive(initial, "initial yield stress");
  requirePositive(saturation, "saturation yield stress");
  requireNonNegative(linear, "linear hardening");
  requireNonNegative(exponent, "hardening exponent");
  const double gain = saturation - initial;
  YieldCurve curve;
  curve.stress = [=](double a) { return initial + linear * a - gain * std::expm1(-exponent * a); };
  curve.slope = [=](double a) { return linear + gain * exponent * std::exp(-exponent * a); };
  curve.stored = [=](double a) {
    const double saturated = exponent > 0.0 ? gain * (a + std::expm1(-exponent * a) / exponent) : 0.0;
    return 0.5 * linear * a * a + saturated;
  };
  return curve;
}

YieldCurve linearYield(double initial, double linear) { return saturatingYield(initial, linear, initial, 0.0); }

YieldCurve tabulatedYield(const std::vector<std::pair<double, double>>& points) {
  if (points.empty() || points.front().first != 0.0)
    throw InputError("the table does not begin at plastic strain 0", "tabulatedYield", "give the first yield stress");
  std::vector<double> stored(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    requirePositive(points[i].second, "yield stress of point " + std::to_string(i));
    if (i == 0) continue;
    const double length = points[i].first - points[i - 1].first;
    requirePositive(length, "step of plastic strain before point " + std::to_string(i));
    stored[i] = stored[i - 1] + length * (0.5 * (points[i].second + points[i - 1].second) - points.front().second);
  }
  YieldCurve curve;
  curve.stress = [points](double a) {
    const std::size_t piece = pieceOf(points, a);
    return points[piece].second + slopeOf(points, piece) * (a - points[piece].first);
  };
  curve.slope = [points](double a) { return slopeOf(points, pieceOf(points, a)); };
  curve.stored = [points, stored](double a) {
    const std::size_t piece = pieceOf(points, a);
    const double length = a - points[piece].first;
    return stored[piece] +
           length * (points[piece].second - points.front().second + 0.5 * slopeOf(points, piece) * length);
  };
  return curve;
}

namespace {

/// c(a) for constant cohesion too.
YieldCurve cohesionOf(const DruckerPrager& law) {
  requireNonNegative(law.cohesion, "cohesion");
  if (!law.cohesionCurve.stress && !law.cohesionCurve.slope)
    return {[c = law.cohesion](double) { return c; }, [](double) { return 0.0; }, {}};
  if (!law.cohesionCurve.stress || !law.cohesionCurve.slope)
    throw InputError("the cohesion curve has no stress or no slope", "DruckerPrager",
                     "take saturatingYield, linearYield or tabulatedYield, or set both functions");
  if (law.cohesion > 0.0)
    throw InputError("there are a cohesion and a cohesionCurve", "DruckerPrager", "set the cohesion to 0");
  requireNonNegative(law.cohesionCurve.stress(0.0), "cohesionCurve at 0");
  return law.cohesionCurve;
}

}  // namespace

ConeConstants coneConstants(const DruckerPrager& law) {
  const double cohesion = cohesionOf(law).stress(0.0);
  requireNonNegative(law.dilatancyAngle, "dilatancy angle");
  const double phi = requireNonNegative(law.frictionAngle, "friction angle");
  if (!(phi < 1.57))
    throw InputError("the friction angle is " + formatNumber(phi), "Drucker-Prager", "give radians below 1.57");
  if (law.dilatancyAngle > phi)
    throw InputError("the dilatancy angle exceeds the friction angle", "Drucker-Prager",
                     "give a smaller one: flow would create energy");
  if (!(cohesion > 0.0 || phi > 0.0))
    throw InputError("cohesion and friction angle are zero", "Drucker-Prager", "give one of them");
  const auto slope = [&](double angle) {
    if (law.match == ConeMatch::planeStrain)
      return 3.0 * std::tan(angle) / std::sqrt(9.0 + 12.0 * std::tan(angle) * std::tan(angle));
    const double side = law.match == ConeMatch::compression ? -1.0 : 1.0;
    return 6.0 * std::sin(angle) / (std::numbers::sqrt3 * (3.0 + side * std::sin(angle)));
  };
  const double cohesive =
      law.match == ConeMatch::planeStrain
          ? 3.0 / std::sqrt(9.0 + 12.0 * std::tan(phi) * std::tan(phi))
          : 6.0 * std::cos(phi) /
                (std::numbers::sqrt3 * (3.0 + (law.match == ConeMatch::compression ? -1.0 : 1.0) * std::sin(phi)));
  return {slope(phi), slope(law.dilatancyAngle), cohesive, cohesive * cohesion};
}

std::shared_ptr<const PointMaterial> pointMaterial(const J2Plasticity& law) {
  const detail::HenckyElasticity elasticity = elasticityOf(law.youngsModulus, law.poissonRatio, law.density);
  requireYield(law.yield);
  requireNonNegative(law.kinematicModulus, "kinematicModulus");
  requireNonNegative(law.recovery, "recovery");
  if (law.recovery > 0.0 && !(law.kinematicModulus > 0.0))
    throw InputError("recovery without kinematicModulus", "J2Plasticity", "set kinematicModulus too");
  if (!(3.0 * elasticity.mu + law.yield.slope(0.0) > 0.0))
    throw InputError("the yield curve falls faster than the shear modulus allows", "J2Plasticity",
                     "keep its slope above -3 times the shear modulus");
  return detail::plasticMaterial(law.density,
                                 detail::J2Flow{elasticity, law.yield, law.kinematicModulus, law.recovery});
}

std::shared_ptr<const PointMaterial> pointMaterial(const DruckerPrager& law) {
  const detail::HenckyElasticity elasticity = elasticityOf(law.youngsModulus, law.poissonRatio, law.density);
  const detail::DruckerPragerFlow flow{elasticity, coneConstants(law), cohesionOf(law),
                                       static_cast<bool>(law.cohesionCurve.slope)};
  if (!(flow.resistance(0.0) > 0.0))
    throw InputError("the cohesion falls faster than the elastic moduli allow", "DruckerPrager",
                     "keep its slope above " + formatNumber(-flow.elasticGain() / flow.hardeningFraction()));
  return detail::plasticMaterial(law.density, flow);
}

double hardeningEnergy(const J2Plasticity& law, std::span<const double> history) {
  double stored = law.yield.stored(history[9]);
  for (std::size_t i = 10; i < history.size(); ++i) stored += law.kinematicModulus / 3.0 * history[i] * history[i];
  return stored;
}

double plasticStrain(std::span<const double> history) { return history[9]; }

double plasticVolume(std::span<const double> history) { return 1.0 / determinant(detail::asTensor(history.data())); }

}  // namespace dovetail::fem
