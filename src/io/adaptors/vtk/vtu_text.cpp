#include "vtu_text.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cstring>

#include "dovetail/core/error.hpp"

namespace dovetail::io {

namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "the bytes of a Vec3 are copied as three doubles");

void fill(vtkDoubleArray* array, const std::string& name, int components, std::size_t count, const void* values) {
  array->SetName(name.c_str());
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  if (count > 0)
    std::memcpy(array->GetPointer(0), values, static_cast<std::size_t>(components) * count * sizeof(double));
}

void addField(vtkFieldData* data, const std::string& name, std::span<const Vec3> values) {
  vtkNew<vtkDoubleArray> array;
  fill(array, name, 3, values.size(), values.data());
  data->AddArray(array);
}

void addField(vtkFieldData* data, const std::string& name, std::span<const double> values) {
  vtkNew<vtkDoubleArray> array;
  fill(array, name, 1, values.size(), values.data());
  data->AddArray(array);
}

void addIds(vtkFieldData* data, std::span<const std::int64_t> ids, std::size_t count) {
  vtkNew<vtkTypeInt64Array> array;
  array->SetName("id");
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i)
    array->SetValue(static_cast<vtkIdType>(i), ids.empty() ? static_cast<std::int64_t>(i) : ids[i]);
  data->AddArray(array);
}

void setPoints(vtkUnstructuredGrid* grid, std::span<const Vec3> values) {
  vtkNew<vtkDoubleArray> array;
  fill(array, "Points", 3, values.size(), values.data());
  vtkNew<vtkPoints> points;
  points->SetData(array);
  grid->SetPoints(points);
}

/// Cells of one type with `nodesPerCell` nodes each; node(i) is entry i of the connectivity.
template <class Node>
void setCells(vtkUnstructuredGrid* grid, int type, std::size_t cells, std::size_t nodesPerCell, Node&& node) {
  vtkNew<vtkIdTypeArray> offsets, connectivity;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(cells + 1));
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(cells * nodesPerCell));
  for (std::size_t i = 0; i <= cells; ++i)
    offsets->SetValue(static_cast<vtkIdType>(i), static_cast<vtkIdType>(i * nodesPerCell));
  for (std::size_t i = 0; i < cells * nodesPerCell; ++i)
    connectivity->SetValue(static_cast<vtkIdType>(i), static_cast<vtkIdType>(node(i)));
  vtkNew<vtkCellArray> array;
  array->SetData(offsets, connectivity);
  grid->SetCells(type, array);
}

void addTimeAndProvenance(vtkUnstructuredGrid* grid, double time, const KeyValues& provenance) {
  addField(grid->GetFieldData(), "TimeValue", std::span<const double>(&time, 1));
  vtkNew<vtkStringArray> lines;
  lines->SetName("provenance");
  for (const auto& [key, value] : provenance) lines->InsertNextValue(key + ": " + value);
  grid->GetFieldData()->AddArray(lines);
}

std::string toText(vtkUnstructuredGrid* grid) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->SetHeaderTypeToUInt64();
  writer->WriteToOutputStringOn();
  if (writer->Write() == 0) throw Error("VTK could not write a frame", "", "see what it printed above");
  std::string text = writer->GetOutputString();
  // The mark of our files; what follows is compressed. Offsets in the file count from the appended section.
  const std::size_t root = text.find("<VTKFile");
  if (root == std::string::npos) throw Error("VTK wrote a frame without a root element", "", "check its version");
  return text.insert(root, "<!-- dovetail " + buildInfo().version + " -->\n");
}

}  // namespace

std::string vtuText(double time, const HexFrame& frame, const KeyValues& provenance) {
  vtkNew<vtkUnstructuredGrid> grid;
  setPoints(grid, frame.points);
  setCells(grid, VTK_HEXAHEDRON, frame.cells.size(), 8, [&](std::size_t i) { return frame.cells[i / 8][i % 8]; });
  for (const VectorField& field : frame.pointVectors) addField(grid->GetPointData(), field.name, field.values);
  for (const ScalarField& field : frame.pointScalars) addField(grid->GetPointData(), field.name, field.values);
  for (const ScalarField& field : frame.cellScalars) addField(grid->GetCellData(), field.name, field.values);
  addTimeAndProvenance(grid, time, provenance);
  return toText(grid);
}

std::string vtuText(double time, const ParticleFrame& frame, const KeyValues& provenance) {
  vtkNew<vtkUnstructuredGrid> grid;
  setPoints(grid, frame.position);
  setCells(grid, VTK_VERTEX, frame.position.size(), 1, [](std::size_t i) { return i; });
  vtkFieldData* data = grid->GetPointData();
  addField(data, "radius", frame.radius);
  if (!frame.velocity.empty()) addField(data, "velocity", frame.velocity);
  if (!frame.force.empty()) addField(data, "force", frame.force);
  addIds(data, frame.id, frame.position.size());
  for (const VectorField& field : frame.vectors) addField(data, field.name, field.values);
  for (const ScalarField& field : frame.scalars) addField(data, field.name, field.values);
  addTimeAndProvenance(grid, time, provenance);
  return toText(grid);
}

}  // namespace dovetail::io
