#include "letters.hpp"

#include "dovetail/rve/rve_archive.hpp"

namespace dovetail::hierarchical {

void write(const CellRecipe& recipe, ByteWriter& archive) {
  archive(std::holds_alternative<DynamicCells>(recipe.settings));
  std::visit([&](const auto& settings) { archive(settings); }, recipe.settings);
  rve::writeCells(*recipe.samples, archive, "cells of a farm");
}

CellRecipe readRecipe(ByteReader& archive) {
  CellRecipe recipe;
  bool isDynamic = false;
  archive(isDynamic);
  if (isDynamic) recipe.settings = DynamicCells{};
  std::visit([&](auto& settings) { archive(settings); }, recipe.settings);
  recipe.samples = std::make_shared<const std::vector<rve::Rve>>(rve::readCells(archive, "cells of a farm"));
  return recipe;
}

}  // namespace dovetail::hierarchical
