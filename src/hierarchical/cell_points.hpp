// Points of solids that own a cell of grains.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::hierarchical {

/// What points with cells are beside fem::FieldPoint.
struct CellOwner {
  virtual ~CellOwner() = default;
  virtual int copies() const = 0;
  virtual void visitCommitted(const std::function<void(const rve::Rve&)>& visit) const = 0;
};

/// Makes a point that begins as the sample of that number.
using MakeCell = std::function<std::unique_ptr<fem::FieldPoint>(std::size_t sample)>;
/// @throws InputError if a setting is not valid
MakeCell cellMaker(std::shared_ptr<const std::vector<rve::Rve>> samples, const QuasiStaticCells& settings);
MakeCell cellMaker(std::shared_ptr<const std::vector<rve::Rve>> samples, const DynamicCells& settings);

}  // namespace dovetail::hierarchical
