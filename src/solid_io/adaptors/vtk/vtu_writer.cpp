#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSignedCharArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <set>

#include "../../../io/adaptors/vtk/vtk_arrays.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"
#include "dovetail/solid_io/vtk_cell_types.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"

namespace dovetail::solid_io {

namespace {

static_assert(vtkCellTypes == std::array<std::uint8_t, 7>{VTK_HEXAHEDRON, VTK_QUADRATIC_HEXAHEDRON,
                                                          VTK_TRIQUADRATIC_HEXAHEDRON, VTK_TETRA, VTK_QUADRATIC_TETRA,
                                                          VTK_QUAD, VTK_QUADRATIC_QUAD});

void setCells(vtkUnstructuredGrid* grid, const fem::SolidMesh& mesh) {
  vtkNew<vtkIdTypeArray> offsets, connectivity;
  vtkNew<vtkUnsignedCharArray> types;
  offsets->InsertNextValue(0);
  for (const fem::ElementGroup& group : mesh.groups) {
    for (const int node : group.node) connectivity->InsertNextValue(node);
    for (std::size_t e = 0; e < group.size(); ++e) {
      offsets->InsertNextValue(offsets->GetValue(offsets->GetNumberOfValues() - 1) + fem::nodesOf(group.shape));
      types->InsertNextValue(vtkCellType(group.shape));
    }
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  grid->SetCells(types, cells);
}

/// Adds arrays to the points or the cells; every name once.
class Arrays {
public:
  Arrays(vtkFieldData* data, std::size_t count, const char* item) : data_(data), count_(count), item_(item) {}

  void add(const VtuField& field) {
    if (field.components < 1 || field.values.size() != count_ * static_cast<std::size_t>(field.components))
      throw InputError(
          "the field \"" + field.name + "\" has " + std::to_string(field.values.size()) + " values of " +
              std::to_string(field.components) + " components",
          std::string("fields per ") + item_,
          "give one value per component and " + std::string(item_) + ", of which there are " + std::to_string(count_));
    vtkNew<vtkDoubleArray> array;
    prepare(array, field.name, field.components);
    std::copy(field.values.begin(), field.values.end(), array->GetPointer(0));
  }
  void addSet(std::string name, const std::vector<int>& members) {
    while (seen_.contains(name)) name += " (set)";
    vtkNew<vtkSignedCharArray> array;
    prepare(array, name, 1);
    array->Fill(0.0);
    for (const int member : members) array->SetValue(member, 1);
  }

private:
  void prepare(vtkDataArray* array, const std::string& name, int components) {
    if (name.empty() || !seen_.insert(name).second)
      throw InputError("the name \"" + name + "\" is empty or occurs twice",
                       std::string("fields and sets per ") + item_, "give each a name of its own");
    array->SetName(name.c_str());
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(static_cast<vtkIdType>(count_));
    data_->AddArray(array);
  }

  vtkFieldData* data_;
  std::size_t count_;
  const char* item_;
  std::set<std::string> seen_;
};

}  // namespace

std::string vtuText(const fem::SolidMesh& mesh, const VtuFields& fields, const io::KeyValues& provenance) {
  fem::validate(mesh);
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& X : mesh.X) points->InsertNextPoint(X.x, X.y, X.z);
  grid->SetPoints(points);
  setCells(grid, mesh);
  Arrays perPoint(grid->GetPointData(), mesh.X.size(), "point");
  std::vector<double> displacement;
  for (const Vec3& u : fields.displacement) displacement.insert(displacement.end(), {u.x, u.y, u.z});
  if (!displacement.empty()) perPoint.add({"displacement", displacement, 3});
  for (const VtuField& field : fields.perPoint) perPoint.add(field);
  for (const auto& [name, nodes] : mesh.nodeSets) perPoint.addSet(name, nodes);
  Arrays perCell(grid->GetCellData(), mesh.elementCount(), "cell");
  for (const VtuField& field : fields.perCell) perCell.add(field);
  for (const auto& [name, elements] : mesh.elementSets) perCell.addSet(name, elements);
  io::addProvenance(grid, io::withMark(provenance));
  if (fields.time) io::addTime(grid, *fields.time);
  return io::xmlText<vtkXMLUnstructuredGridWriter>(grid);
}

void writeVtu(const std::filesystem::path& path, const fem::SolidMesh& mesh, const VtuFields& fields,
              const io::KeyValues& provenance) {
  io::writeFileAtomically(path, vtuText(mesh, fields, provenance));
}

}  // namespace dovetail::solid_io
