#include "bank.hpp"

#include <algorithm>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/hierarchical/cell_field.hpp"

namespace dovetail::hierarchical {

namespace {

void validateCell(const rve::Cell& cell, const rve::Cell& first, double unbalanced, const std::string& where) {
  if (cell.shape != first.shape || !(cell.springs == first.springs))
    throw InputError("the shape or the springs of grains are others than in the first cell", where,
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

void validateBank(const std::vector<rve::Cell>& bank, double unbalanced) {
  if (bank.empty()) throw InputError("there are no cells", "cellField", "give one, as compress() leaves it");
  for (std::size_t k = 0; k < bank.size(); ++k)
    validateCell(bank[k], bank.front(), unbalanced, "cell " + std::to_string(k) + " of a bank");
}

double meanDensity(const std::vector<rve::Cell>& bank) {
  double sum = 0.0;
  for (const rve::Cell& cell : bank) sum += cell.density * rve::solidFraction(cell);
  return sum / static_cast<double>(bank.size());
}

std::string whySmall(const rve::Cell& cell) {
  if (cell.size() < 100) return "fewer than 100 grains";
  const auto widths = cell.state.lattice.widths();
  const double least = *std::min_element(widths.begin(), widths.begin() + cell.dimension());
  return least < 6.0 * rve::meanDiameter(cell) ? "thinner than 6 mean diameters" : "";
}

std::string nameOf(const std::vector<rve::Cell>& bank) {
  const auto [fewest, most] = std::ranges::minmax_element(bank, {}, &rve::Cell::size);
  std::string name = "cells of " + std::to_string(fewest->size());
  if (most->size() > fewest->size()) name += " to " + std::to_string(most->size());
  name += bank.front().shape == rve::Shape::disc ? " discs" : " spheres";
  for (const rve::Cell& cell : bank)
    if (const std::string why = whySmall(cell); !why.empty())
      return name + " (too small to be representative: " + why + ")";
  return name;
}

}  // namespace dovetail::hierarchical
