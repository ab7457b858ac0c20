#include "samples.hpp"

#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/hierarchical/cell_field.hpp"

namespace dovetail::hierarchical {

namespace {

void validateCell(const rve::Rve& cell, const rve::Rve& first, double unbalanced, const std::string& where) {
  if (cell.shape != first.shape || !(cell.springs == first.springs))
    throw InputError("the shape or the springs of grains differ from those of the first cell", where,
                     "make all cells of a field with the same springs, or give each part of the solid its own field");
  if (cell.state.F != Eigen::Matrix3d::Identity())
    throw InputError("it is deformed", where, "give cells at F = 1, as compress() leaves them");
  if (!(rve::stress(cell).pressure > 0.0))
    throw InputError("it is not under pressure: a cell without cohesion has no stiffness then", where,
                     "compress() it first");
  const double now = rve::balance(cell).unbalanced;
  if (!(now <= unbalanced) || rve::kineticEnergy(cell) > 0.0)
    throw InputError(
        "it is not at rest: forces on grains are out of balance by " + formatNumber(now) + " of the mean contact force",
        where, "relax() or polish() it to " + formatNumber(unbalanced) + " first");
}

}  // namespace

void validateSamples(const std::vector<rve::Rve>& samples, double unbalanced) {
  if (samples.empty()) throw InputError("there are no cells", "cellField", "give one, as compress() leaves it");
  for (std::size_t k = 0; k < samples.size(); ++k)
    validateCell(samples[k], samples.front(), unbalanced, "cell " + std::to_string(k) + " of the samples");
}

double meanDensity(const std::vector<rve::Rve>& samples) {
  double sum = 0.0;
  for (const rve::Rve& cell : samples) sum += cell.density * rve::solidFraction(cell);
  return sum / static_cast<double>(samples.size());
}

std::string whySmall(const rve::Rve& cell) {
  if (cell.size() < 100) return "fewer than 100 grains";
  const auto widths = cell.state.lattice.widths();
  const double least = *std::min_element(widths.begin(), widths.begin() + cell.dimension());
  return least < 6.0 * rve::meanDiameter(cell) ? "thinner than 6 mean diameters" : "";
}

std::string nameOf(const std::vector<rve::Rve>& samples) {
  const auto [fewest, most] = std::ranges::minmax_element(samples, {}, &rve::Rve::size);
  std::string name = "cells of " + std::to_string(fewest->size());
  if (most->size() > fewest->size()) name += " to " + std::to_string(most->size());
  name += samples.front().shape == rve::Shape::disc ? " discs" : " spheres";
  for (const rve::Rve& cell : samples)
    if (const std::string why = whySmall(cell); !why.empty())
      return name + " (too small to be representative: " + why + ")";
  return name;
}

}  // namespace dovetail::hierarchical
