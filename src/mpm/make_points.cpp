#include <cmath>
#include <cstdio>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "points.hpp"

namespace dovetail::mpm {

namespace {

void requireEnough(const MaterialPoints& points, const PointOptions& options) {
  const GridOptions& grid = options.grid;
  const double perCell = pointsPerCell(grid, points.x), least = leastPerCell(grid);
  if (perCell >= least) return;
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", perCell);
  throw InputError(std::string("there are ") + text +
                       " points in a cell, between which nodes move unseen: under a load it would creep for ever",
                   options.name,
                   "give at least " + formatNumber(least) + ", by closer points or a grid with a spacing of about " +
                       formatNumber(grid.spacing * std::pow(least / perCell, grid.plane ? 0.5 : 1.0 / 3.0)) + " m");
}

void validate(const MaterialPoints& points, const fem::PointField* field, const PointOptions& options) {
  const std::string& name = options.name;
  if (points.x.empty()) throw InputError("there are no points", name, "give some");
  if (points.volume.size() != points.x.size() || (!points.v.empty() && points.v.size() != points.x.size()))
    throw InputError("there are " + std::to_string(points.x.size()) + " places, " + std::to_string(points.v.size()) +
                         " velocities and " + std::to_string(points.volume.size()) + " volumes",
                     name, "give one of each per point, or no velocities");
  for (std::size_t p = 0; p < points.x.size(); ++p) {
    const std::string where = "point " + std::to_string(p) + " of \"" + name + "\"";
    if (!isFinite(points.x[p]) || (!points.v.empty() && !isFinite(points.v[p])))
      throw InputError("its place or velocity is not finite", where, "give numbers");
    if (options.grid.plane && points.x[p].z != 0.0)
      throw InputError("it lies at z = " + formatNumber(points.x[p].z) + " m", where, "give z = 0 in the plane");
    requirePositive(points.volume[p], "volume of " + where);
  }
  if (field == nullptr) throw InputError("there is no material", name, "give a field from fem::pointField()");
  validate(options.grid);
  requireNonNegative(options.damping, "damping of points");
  if (!(options.renewal > 0.0 && options.renewal <= 0.5))
    throw InputError("renewal is " + formatNumber(options.renewal), name, "give a number above 0, up to 0.5");
  if (options.transfer == Transfer::apic && secondMoment(options.grid.shape) == 0.0)
    throw InputError(std::string("apic with ") + mpm::name(options.grid.shape) + " shapes", name,
                     "take quadratic or cubic ones, or flip");
  requireEnough(points, options);
}

}  // namespace

std::shared_ptr<PointSolid> makePoints(const MaterialPoints& points, std::shared_ptr<fem::PointField> field,
                                       const PointOptions& options) {
  validate(points, field.get(), options);
  return std::make_shared<detail::Points>(points, std::move(field), options);
}

fem::Model makeModel(std::shared_ptr<PointSolid> points) {
  if (points == nullptr) throw InputError("there are no points", "mpm::makeModel", "give those of makePoints");
  fem::Model model;
  points->layNodes(model.nodes);
  model.add(std::move(points));
  return model;
}

}  // namespace dovetail::mpm
