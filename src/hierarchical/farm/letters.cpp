#include "letters.hpp"

#include "dovetail/rve/rve_archive.hpp"

namespace dovetail::hierarchical {

namespace {

/// For both ways.
template <class Archive, class Settings>
void pass(Archive& archive, Settings& settings) {
  if constexpr (requires { settings.path; })
    archive(settings.path.inertialNumber, settings.path.damping, settings.path.stepFraction,
            settings.path.rest.tolerance, settings.path.rest.steps, settings.unbalanced, settings.tangent);
  else
    archive(settings.strainPerStep, settings.damping, settings.stepFraction);
}

}  // namespace

void write(const CellRecipe& recipe, ByteWriter& archive) {
  archive(std::holds_alternative<DynamicCells>(recipe.settings));
  std::visit([&](const auto& settings) { pass(archive, settings); }, recipe.settings);
  rve::writeCells(*recipe.samples, archive, "cells of a farm");
}

CellRecipe readRecipe(ByteReader& archive) {
  CellRecipe recipe;
  bool isDynamic = false;
  archive(isDynamic);
  if (isDynamic) recipe.settings = DynamicCells{};
  std::visit([&](auto& settings) { pass(archive, settings); }, recipe.settings);
  recipe.samples = std::make_shared<const std::vector<rve::Rve>>(rve::readCells(archive, "cells of a farm"));
  return recipe;
}

}  // namespace dovetail::hierarchical
