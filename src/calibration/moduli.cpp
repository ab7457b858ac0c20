#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "dovetail/calibration/cell_probes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/cell.hpp"
#include "dovetail/dem/setup/relax.hpp"

namespace dovetail::calibration {

namespace {

/// Pressures at rest after a strain along one axis, Pa.
Vec3 probed(dem::Model cell, int axis, double strain, const ModuliOptions& settings) {
  Vec3 strains{};
  strains[axis] = std::expm1(strain);
  dem::strainCell(cell, strains);
  const dem::RelaxationReport report = dem::relax(cell, {settings.unbalanced, settings.steps}, {.lookEvery = 50});
  if (!report.atRest)
    throw NumericalError("a cell strained by " + formatNumber(strain) +
                             " does not come to rest: unbalanced forces are " + formatNumber(report.residual) +
                             " of the contacts'",
                         std::string("probe along ") + "xyz"[axis], "take more steps, or allow more unbalanced force");
  return cellPressures(cell);
}

double largestOff(const std::array<double, 3>& values, double mean) {
  double off = 0.0;
  for (const double value : values) off = std::max(off, std::abs(value - mean));
  return off / mean;
}

/// Grains that do not touch, or not across all periods, resist nothing.
void requireModuli(const Moduli& m) {
  const std::pair<double, const char*> all[] = {{m.bulk, "bulk modulus"},
                                                {m.shear, "shear modulus"},
                                                {m.youngsModulus, "Young's modulus"},
                                                {m.poissonRatio, "Poisson's ratio"},
                                                {m.anisotropy, "anisotropy"},
                                                {m.nonlinearity, "nonlinearity"},
                                                {m.pWaveSpeed, "speed of pressure waves"},
                                                {m.sWaveSpeed, "speed of shear waves"}};
  for (const auto& [value, name] : all)
    if (!std::isfinite(value))
      throw NumericalError(std::string("its ") + name + " is " + formatNumber(value), "probes of a cell",
                           "let its grains touch along all axes: make the cell denser, or the pressure higher");
}

}  // namespace

Moduli smallStrainModuli(const dem::Model& start, const ModuliOptions& settings) {
  requirePositive(settings.strain, "strain of the probes");
  dem::Model cell = start;
  dem::findForces(cell);
  Moduli found;
  found.density = cellDensity(cell);
  found.solidFraction = cellSolidFraction(cell);
  const Vec3 rest = cellPressures(cell);
  found.pressure = meanOf(rest);
  std::array<double, 3> along{}, bothWays{};
  double across = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Vec3 shortened = probed(cell, axis, -settings.strain, settings);
    const Vec3 stretched = probed(cell, axis, settings.strain, settings);
    for (int row = 0; row < 3; ++row) {
      const double slope = (shortened[row] - stretched[row]) / (2.0 * settings.strain);
      found.stiffness[static_cast<std::size_t>(row)][a] = slope;
      if (row != axis) across += slope / 6.0;
    }
    along[a] = found.stiffness[a][a];
    bothWays[a] = (shortened[axis] - 2.0 * rest[axis] + stretched[axis]) / settings.strain;
  }
  const double mean = (along[0] + along[1] + along[2]) / 3.0;
  found.anisotropy = largestOff(along, mean);
  for (const double difference : bothWays)
    found.nonlinearity = std::max(found.nonlinearity, std::abs(difference) / mean);
  found.bulk = (mean + 2.0 * across) / 3.0;
  found.shear = 0.5 * (mean - across);
  found.youngsModulus = 9.0 * found.bulk * found.shear / (3.0 * found.bulk + found.shear);
  found.poissonRatio = across / (mean + across);
  found.pWaveSpeed = std::sqrt((found.bulk + 4.0 / 3.0 * found.shear) / found.density);
  found.sWaveSpeed = std::sqrt(found.shear / found.density);
  requireModuli(found);
  return found;
}

}  // namespace dovetail::calibration
