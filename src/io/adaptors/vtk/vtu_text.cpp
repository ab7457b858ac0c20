#include "vtu_text.hpp"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdTypeArray.h>
#include <vtkImageData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <numeric>

#include "vtk_arrays.hpp"

namespace dovetail::io {

namespace {

void addIds(vtkFieldData* data, std::span<const std::int64_t> ids, std::size_t count) {
  std::vector<std::int64_t> numbers;
  if (ids.empty()) {
    numbers.resize(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    ids = numbers;
  }
  addField(data, "id", ids);
}

void setPoints(vtkPointSet* set, std::span<const Vec3> values) {
  vtkNew<vtkDoubleArray> array;
  fill(array, "Points", 3, values.size(), values.data());
  vtkNew<vtkPoints> points;
  points->SetData(array);
  set->SetPoints(points);
}

/// `cells` cells with `nodesPerCell` nodes each; node(i) is entry i of the connectivity.
template <class Node>
vtkSmartPointer<vtkCellArray> cellsOf(std::size_t cells, std::size_t nodesPerCell, Node&& node) {
  vtkNew<vtkIdTypeArray> offsets, connectivity;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(cells + 1));
  connectivity->SetNumberOfValues(static_cast<vtkIdType>(cells * nodesPerCell));
  for (std::size_t i = 0; i <= cells; ++i)
    offsets->SetValue(static_cast<vtkIdType>(i), static_cast<vtkIdType>(i * nodesPerCell));
  for (std::size_t i = 0; i < cells * nodesPerCell; ++i)
    connectivity->SetValue(static_cast<vtkIdType>(i), static_cast<vtkIdType>(node(i)));
  auto array = vtkSmartPointer<vtkCellArray>::New();
  array->SetData(offsets, connectivity);
  return array;
}
template <std::size_t n>
vtkSmartPointer<vtkCellArray> cellsOf(std::span<const std::array<int, n>> cells) {
  return cellsOf(cells.size(), n, [&](std::size_t i) { return cells[i / n][i % n]; });
}

vtkSmartPointer<vtkCellArray> vertices(std::size_t points) {
  return cellsOf(points, 1, [](std::size_t i) { return i; });
}

template <class Field>
void addAll(vtkFieldData* data, const std::vector<Field>& fields) {
  for (const Field& field : fields) addField(data, field.name, field.values);
}

}  // namespace

std::string vtuText(double time, const HexFrame& frame, const KeyValues& provenance) {
  vtkNew<vtkUnstructuredGrid> grid;
  setPoints(grid, frame.points);
  grid->SetCells(VTK_HEXAHEDRON, cellsOf(frame.cells));
  addAll(grid->GetPointData(), frame.pointVectors);
  addAll(grid->GetPointData(), frame.pointScalars);
  addAll(grid->GetCellData(), frame.cellScalars);
  addTime(grid, time);
  addProvenance(grid, provenance);
  return xmlText<vtkXMLUnstructuredGridWriter>(grid);
}

std::string vtuText(double time, const ParticleFrame& frame, const KeyValues& provenance) {
  vtkNew<vtkUnstructuredGrid> grid;
  setPoints(grid, frame.position);
  grid->SetCells(VTK_VERTEX, vertices(frame.position.size()));
  vtkFieldData* data = grid->GetPointData();
  addField(data, "radius", frame.radius);
  if (!frame.velocity.empty()) addField(data, "velocity", frame.velocity);
  if (!frame.force.empty()) addField(data, "force", frame.force);
  addIds(data, frame.id, frame.position.size());
  addAll(data, frame.vectors);
  addAll(data, frame.scalars);
  addTime(grid, time);
  addProvenance(grid, provenance);
  return xmlText<vtkXMLUnstructuredGridWriter>(grid, Compressed::no);
}

std::string vtuText(double time, const PointFrame& frame, const KeyValues& provenance) {
  vtkNew<vtkUnstructuredGrid> grid;
  setPoints(grid, frame.points);
  grid->SetCells(VTK_VERTEX, vertices(frame.points.size()));
  for (const ComponentField& field : frame.fields)
    addField(grid->GetPointData(), field.name, field.values, field.components);
  addAll(grid->GetPointData(), frame.integers);
  addTime(grid, time);
  addProvenance(grid, provenance);
  return xmlText<vtkXMLUnstructuredGridWriter>(grid, Compressed::no);
}

std::string vtpText(double time, const PolyFrame& frame, const KeyValues& provenance) {
  vtkNew<vtkPolyData> poly;
  setPoints(poly, frame.points);
  poly->SetLines(cellsOf(frame.lines));
  poly->SetPolys(cellsOf(frame.triangles));
  addAll(poly->GetCellData(), frame.vectors);
  addAll(poly->GetCellData(), frame.scalars);
  addAll(poly->GetCellData(), frame.integers);
  addTime(poly, time);
  addProvenance(poly, provenance);
  return xmlText<vtkXMLPolyDataWriter>(poly, Compressed::no);
}

std::string vtiText(double time, const GridFrame& frame, const KeyValues& provenance) {
  vtkNew<vtkImageData> image;
  image->SetOrigin(frame.lower.x, frame.lower.y, frame.lower.z);
  image->SetSpacing(frame.spacing.x, frame.spacing.y, frame.spacing.z);
  image->SetDimensions(frame.count.data());
  const auto points = static_cast<std::size_t>(image->GetNumberOfPoints());
  for (const ComponentField& field : frame.fields) {
    if (field.values.size() != points * static_cast<std::size_t>(field.components))
      throw InputError("the field '" + field.name + "' has " + std::to_string(field.values.size()) + " values",
                       "fields on a grid", "give one per component and point");
    addField(image->GetPointData(), field.name, field.values, field.components);
  }
  addTime(image, time);
  addProvenance(image, withMark(provenance));
  return xmlText<vtkXMLImageDataWriter>(image);
}

}  // namespace dovetail::io
