#include "vtu_sets.hpp"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

namespace dovetail::solid_io {

namespace {

/// Flags of vtkGhostType at each point or cell; none if there is no such array.
std::vector<int> ghostFlags(vtkDataSetAttributes* data) {
  vtkDataArray* const array = data->GetArray(vtkDataSetAttributes::GhostArrayName());
  std::vector<int> flags(array != nullptr ? static_cast<std::size_t>(array->GetNumberOfTuples()) : 0);
  for (std::size_t i = 0; i < flags.size(); ++i)
    flags[i] = static_cast<int>(array->GetComponent(static_cast<vtkIdType>(i), 0));
  return flags;
}

/// Up to one more than a set of sets may have.
constexpr std::size_t most = 100;
std::set<double> valuesOf(vtkDataArray* array) {
  std::set<double> values;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples() && values.size() <= most; ++i)
    values.insert(array->GetComponent(i, 0));
  return values;
}

bool isReal(vtkDataArray* array) { return array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE; }

/// A field that is 0 everywhere, or 1, says nothing; one of a few whole numbers may be meant to name sets.
bool looksLikeSets(const std::set<double>& values) {
  return values.size() > 1 && values.size() <= most &&
         std::all_of(values.begin(), values.end(), [](double value) { return value == std::floor(value); });
}

/// Why an array gives no sets; empty if nothing has to be said of it, or if it does.
std::string reasonAgainst(vtkDataArray* array, const std::set<double>& values) {
  const std::string name = array->GetName();
  if (name.starts_with("vtk")) return "is VTK's own";
  const int components = array->GetNumberOfComponents();
  if (isReal(array))
    return components == 1 && looksLikeSets(values) ? "holds whole numbers as real ones (save it as integers)" : "";
  if (components != 1) return "has " + std::to_string(components) + " components";
  if (values.size() > most) return "holds more than 100 different numbers";
  if (!values.empty() && std::max(-*values.begin(), *values.rbegin()) >= 0x1p63) return "holds numbers beyond 2^63";
  return "";
}

/// Called with a set, which array it is of, and an item.
using Add = std::function<void(const std::string& set, const std::string& array, vtkIdType item)>;

void addSets(vtkDataArray* array, const std::set<double>& values, const Add& add) {
  const std::string name = array->GetName();
  const bool flags = !values.empty() && *values.begin() >= 0.0 && *values.rbegin() <= 1.0;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
    const double value = array->GetComponent(i, 0);
    if (!flags) add(name + " " + std::to_string(static_cast<std::int64_t>(value)), " of " + name, i);
    if (flags && value > 0.0) add(name, "", i);
  }
}

void readSets(vtkFieldData* data, MeshBuilder& builder, const Add& add) {
  for (int a = 0; a < data->GetNumberOfArrays(); ++a) {
    vtkDataArray* const array = vtkDataArray::SafeDownCast(data->GetAbstractArray(a));
    const std::string name = array != nullptr && array->GetName() != nullptr ? array->GetName() : "";
    if (name.empty() || name == vtkDataSetAttributes::GhostArrayName()) continue;
    const std::set<double> values = valuesOf(array);
    const std::string reason = reasonAgainst(array, values);
    if (!reason.empty())
      builder.note("The array \"" + name + "\" " + reason + " and was ignored.");
    else if (!isReal(array))
      addSets(array, values, add);
  }
}

}  // namespace

std::vector<char> ghostCells(vtkUnstructuredGrid* grid, MeshBuilder& builder) {
  constexpr int left =
      vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::REFINEDCELL | vtkDataSetAttributes::HIDDENCELL;
  std::vector<char> leftOut(static_cast<std::size_t>(grid->GetNumberOfCells()), 0);
  const std::vector<int> cells = ghostFlags(grid->GetCellData()), points = ghostFlags(grid->GetPointData());
  for (std::size_t c = 0; c < cells.size(); ++c) leftOut[c] = (cells[c] & left) != 0;
  if (const auto count = static_cast<std::size_t>(std::count(leftOut.begin(), leftOut.end(), 1)); count > 0)
    builder.note(counted(count, "cell that vtkGhostType marks as a copy, refined or hidden was",
                         "cells that vtkGhostType marks as copies, refined or hidden were") +
                 " left out.");
  const auto hidden = static_cast<std::size_t>(std::count_if(
      points.begin(), points.end(), [](int flags) { return (flags & vtkDataSetAttributes::HIDDENPOINT) != 0; }));
  if (hidden > 0)
    builder.note(
        counted(hidden, "point that vtkGhostType marks as hidden is", "points that vtkGhostType marks as hidden are") +
        " kept.");
  return leftOut;
}

void readVtuSets(vtkUnstructuredGrid* grid, const std::vector<char>& leftOut, MeshBuilder& builder) {
  readSets(grid->GetPointData(), builder, [&](const std::string& set, const std::string& array, vtkIdType i) {
    builder.addNodeToSet({set, 0, "points" + array}, i, 0);
  });
  readSets(grid->GetCellData(), builder, [&](const std::string& set, const std::string& array, vtkIdType i) {
    if (!leftOut[static_cast<std::size_t>(i)]) builder.addElementToSet({set, 1, "cells" + array}, i, 0);
  });
}

}  // namespace dovetail::solid_io
