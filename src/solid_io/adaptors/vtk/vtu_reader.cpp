#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "../../../io/adaptors/vtk/vtk_xml.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"
#include "mesh_builder.hpp"

namespace dovetail::solid_io {

namespace {

struct VtkType {
  int code, nodes, dimension;
  fem::CellShape shape;
};
constexpr auto none = fem::CellShape::hex8;
constexpr std::array<VtkType, 13> types = {{{VTK_HEXAHEDRON, 8, 3, fem::CellShape::hex8},
                                            {VTK_QUADRATIC_HEXAHEDRON, 20, 3, fem::CellShape::hex20},
                                            {VTK_TRIQUADRATIC_HEXAHEDRON, 27, 3, fem::CellShape::hex27},
                                            {VTK_TETRA, 4, 3, fem::CellShape::tet4},
                                            {VTK_QUADRATIC_TETRA, 10, 3, fem::CellShape::tet10},
                                            {VTK_TRIANGLE, 3, 2, none},
                                            {VTK_QUADRATIC_TRIANGLE, 6, 2, none},
                                            {VTK_QUAD, 4, 2, none},
                                            {VTK_QUADRATIC_QUAD, 8, 2, none},
                                            {VTK_BIQUADRATIC_QUAD, 9, 2, none},
                                            {VTK_VERTEX, 1, 0, none},
                                            {VTK_LINE, 2, 1, none},
                                            {VTK_QUADRATIC_EDGE, 3, 1, none}}};

using io::refuseVtk;

const VtkType& requireType(int code, vtkIdType cell, const std::filesystem::path& path) {
  for (const VtkType& type : types)
    if (type.code == code) return type;
  refuseVtk(path, "cell " + std::to_string(cell), "cells of VTK's type " + std::to_string(code) + " are not known here",
            "give hexahedra or tetrahedra of first or second order");
}

/// The nodes of each cell, after offsets and indices have been checked.
std::vector<std::vector<Label>> cellNodes(vtkUnstructuredGrid* grid, const std::filesystem::path& path) {
  vtkCellArray* const cells = grid->GetCells();
  std::vector<std::vector<Label>> result(static_cast<std::size_t>(grid->GetNumberOfCells()));
  if (result.empty()) return result;
  vtkDataArray *const offsets = cells->GetOffsetsArray(), *const ids = cells->GetConnectivityArray();
  for (std::size_t c = 0; c < result.size(); ++c) {
    const std::string place = "cell " + std::to_string(c);
    const double begin = offsets->GetComponent(static_cast<vtkIdType>(c), 0);
    const double end = offsets->GetComponent(static_cast<vtkIdType>(c) + 1, 0);
    if (begin < 0.0 || end < begin || end > static_cast<double>(cells->GetNumberOfConnectivityIds()))
      refuseVtk(path, place, "its offsets do not fit", "give a complete VTU file");
    for (auto k = static_cast<vtkIdType>(begin); k < static_cast<vtkIdType>(end); ++k) {
      const double id = ids->GetComponent(k, 0);
      if (id < 0.0 || id >= static_cast<double>(grid->GetNumberOfPoints()))
        refuseVtk(path, place, "it names a point that does not exist",
                  "use 0 to " + std::to_string(grid->GetNumberOfPoints() - 1));
      result[c].push_back(static_cast<Label>(id));
    }
  }
  return result;
}

/// Calls add(set, which array, item) for what the whole-number arrays say; notes those that are passed over.
template <class Add>
void readSets(vtkFieldData* data, MeshBuilder& builder, Add&& add) {
  constexpr std::size_t most = 100;
  for (int a = 0; a < data->GetNumberOfArrays(); ++a) {
    vtkDataArray* const array = vtkDataArray::SafeDownCast(data->GetAbstractArray(a));
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() != 1) continue;
    if (array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE) continue;
    const std::string name = array->GetName();
    if (name.empty() || name.rfind("vtk", 0) == 0) continue;
    std::set<double> values;
    for (vtkIdType i = 0; i < array->GetNumberOfTuples() && values.size() <= most; ++i)
      values.insert(array->GetComponent(i, 0));
    if (values.size() > most) {
      builder.note("The array \"" + name + "\" holds more than 100 different numbers and was passed over.");
      continue;
    }
    if (!values.empty() && std::max(-*values.begin(), *values.rbegin()) >= 0x1p63) {
      builder.note("The array \"" + name + "\" holds numbers beyond 2^63 and was passed over.");
      continue;
    }
    const bool flags = !values.empty() && *values.begin() >= 0.0 && *values.rbegin() <= 1.0;
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i) {
      const double value = array->GetComponent(i, 0);
      if (!flags) add(name + " " + std::to_string(static_cast<std::int64_t>(value)), " of " + name, i);
      if (flags && value > 0.0) add(name, "", i);
    }
  }
}

void addCell(MeshBuilder& builder, const VtkType& type, Label label, std::span<const Label> nodes) {
  if (type.dimension == 3) builder.addCell(label, type.shape, nodes, 0);
  if (type.dimension == 2) builder.addFace(label, surfaceOf(type.nodes), nodes, 0, false);
  if (type.dimension < 2)
    builder.addLine(label, nodes, 0, type.dimension == 1 ? MeshBuilder::LineUse::line : MeshBuilder::LineUse::names);
}

}  // namespace

SolidFile readVtu(const std::filesystem::path& path) {
  const auto grid = io::readVtkXml<vtkXMLUnstructuredGridReader>(path, "VTU", "UnstructuredGrid");
  const Source source("", path.string());
  MeshBuilder builder(source);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
    double p[3];
    grid->GetPoint(i, p);
    const Vec3 X{p[0], p[1], p[2]};
    if (!isFinite(X))
      refuseVtk(path, "point " + std::to_string(i), "a coordinate is NaN or infinite", "give finite numbers");
    builder.addNode(i, X, 0);
  }
  const auto nodes = cellNodes(grid, path);
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    const auto cell = static_cast<vtkIdType>(c);
    const VtkType& type = requireType(grid->GetCellType(cell), cell, path);
    if (nodes[c].size() != static_cast<std::size_t>(type.nodes))
      refuseVtk(path, "cell " + std::to_string(c), "it has " + std::to_string(nodes[c].size()) + " points",
                "give " + std::to_string(type.nodes) + " for its type");
    addCell(builder, type, cell, nodes[c]);
  }
  readSets(grid->GetPointData(), builder, [&](const std::string& set, const std::string& array, vtkIdType i) {
    builder.addNodeToSet({set, 0, "points" + array}, i, 0);
  });
  readSets(grid->GetCellData(), builder, [&](const std::string& set, const std::string& array, vtkIdType i) {
    builder.addElementToSet({set, 1, "cells" + array}, i, 0);
  });
  return builder.finish();
}

}  // namespace dovetail::solid_io
