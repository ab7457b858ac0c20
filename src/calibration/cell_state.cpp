// Stress and volume of a cell, and its way to a pressure.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "dovetail/calibration/cell_probes.hpp"
#include "dovetail/cg/averages.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/model/snapshot.hpp"
#include "dovetail/dem/setup/cell.hpp"
#include "dovetail/dem/setup/packing.hpp"
#include "dovetail/dem/setup/pressure_secant.hpp"
#include "dovetail/dem/setup/relax.hpp"

namespace dovetail::calibration {

Vec3 cellPressures(const dem::Model& m) {
  const dem::Snapshot now = dem::takeSnapshot(m);
  const cg::SnapshotView view = cg::viewOf(now);
  const Eigen::Matrix3d stress = cg::loveWeberStress(view.branches, {}, cellVolume(m)).contact;
  return {-stress(0, 0), -stress(1, 1), -stress(2, 2)};
}

double meanOf(const Vec3& v) { return (v.x + v.y + v.z) / 3.0; }

double cellVolume(const dem::Model& m) {
  const geometry::Periodicity& space = m.pairs.periodicity();
  return space.length(0) * space.length(1) * space.length(2);
}

double cellDensity(const dem::Model& m) {
  return std::accumulate(m.particles.mass.begin(), m.particles.mass.end(), 0.0) / cellVolume(m);
}

double cellSolidFraction(const dem::Model& m) { return dem::volumeOf(m.particles.radius) / cellVolume(m); }

namespace {

void requireCell(const dem::Model& m) {
  const geometry::Periodicity& space = m.pairs.periodicity();
  for (int k = 0; k < 3; ++k)
    if (!space.axes[static_cast<std::size_t>(k)])
      throw InputError(std::string("space does not repeat along ") + "xyz"[k], "periodic cell",
                       "make it periodic along x, y and z");
  if (norm(m.gravity) > 0.0)
    throw InputError("there is gravity", "periodic cell", "leave it out: nothing holds a cell");
  if (m.particles.size() == 0) throw InputError("there are no grains", "periodic cell", "put some in");
}

/// Pressure at rest, Pa; far from the one wanted, rest is not waited for.
double pressureAtRest(dem::Model& m, const CompressionOptions& settings) {
  struct Stage {
    double within;  // relative distance from the pressure wanted
    RestCriterion rest;
  };
  const Stage stages[] = {{1e300, {.tolerance = 1e-2, .steps = 1500}},
                          {0.5, {.tolerance = 1e-3, .steps = 10000}},
                          {0.05, {.tolerance = settings.unbalanced}}};
  double pressure = 0.0;
  for (const Stage& stage : stages) {
    if (stage.within < 1e300 && std::abs(settings.pressure - pressure) > stage.within * settings.pressure) break;
    dem::relax(m, stage.rest);
    pressure = meanOf(cellPressures(m));
  }
  return pressure;
}

}  // namespace

double compressRve(dem::Model& m, const CompressionOptions& settings) {
  requireCell(m);
  requirePositive(settings.pressure, "pressure");
  requirePositive(settings.tolerance, "tolerance of the pressure");
  dem::findForces(m);
  dem::PressureSecant secant(settings.pressure, 0.01, 0.0);
  double pressure = 0.0;
  for (std::int64_t k = 0; k < settings.strains; ++k) {
    pressure = pressureAtRest(m, settings);
    if (std::abs(settings.pressure - pressure) <= settings.tolerance * settings.pressure) return secant.bulk();
    const double each = std::expm1(-secant.next(pressure) / 3.0);
    dem::strainCell(m, {each, each, each});
  }
  throw NumericalError(
      "the cell is at " + formatNumber(pressure) + " Pa after " + std::to_string(settings.strains) + " strains",
      "compression to " + formatNumber(settings.pressure) + " Pa",
      "begin with another solid fraction, or take a larger tolerance");
}

}  // namespace dovetail::calibration
