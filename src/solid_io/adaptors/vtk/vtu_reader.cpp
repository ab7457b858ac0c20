#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include "../../../io/adaptors/vtk/vtk_xml.hpp"
#include "dovetail/solid_io_vtk/solid_vtu.hpp"
#include "vtu_sets.hpp"

namespace dovetail::solid_io {

namespace {

struct VtkType {
  int code, nodes, dimension;
  fem::ElementShape shape;
};
constexpr auto none = fem::ElementShape::hex8;
constexpr std::array<VtkType, 13> types = {{{VTK_HEXAHEDRON, 8, 3, fem::ElementShape::hex8},
                                            {VTK_QUADRATIC_HEXAHEDRON, 20, 3, fem::ElementShape::hex20},
                                            {VTK_TRIQUADRATIC_HEXAHEDRON, 27, 3, fem::ElementShape::hex27},
                                            {VTK_TETRA, 4, 3, fem::ElementShape::tet4},
                                            {VTK_QUADRATIC_TETRA, 10, 3, fem::ElementShape::tet10},
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

void addCell(MeshBuilder& builder, const VtkType& type, Label label, std::span<const Label> nodes) {
  if (type.dimension == 3) builder.addCell(label, type.shape, nodes, 0);
  if (type.dimension == 2) builder.addFace(label, surfaceOf(type.nodes), nodes, 0, false);
  if (type.dimension < 2)
    builder.addLine(label, nodes, 0, type.dimension == 1 ? MeshBuilder::LineUse::line : MeshBuilder::LineUse::names);
}

}  // namespace

SolidFile readVtu(const std::filesystem::path& path) {
  const auto grid = io::readVtkXml<vtkXMLUnstructuredGridReader>(path, "VTU", "UnstructuredGrid");
  TextSource source("", path.string());
  source.places = TextSource::Places::none;
  MeshBuilder builder(source);
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) {
    double p[3];
    grid->GetPoint(i, p);
    builder.addNode(i, {p[0], p[1], p[2]}, 0);
  }
  const auto nodes = cellNodes(grid, path);
  const std::vector<char> leftOut = ghostCells(grid, builder);
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    if (leftOut[c]) continue;
    const auto cell = static_cast<vtkIdType>(c);
    const VtkType& type = requireType(grid->GetCellType(cell), cell, path);
    if (nodes[c].size() != static_cast<std::size_t>(type.nodes))
      refuseVtk(path, "cell " + std::to_string(c), "it has " + std::to_string(nodes[c].size()) + " points",
                "give " + std::to_string(type.nodes) + " for its type");
    addCell(builder, type, cell, nodes[c]);
  }
  readVtuSets(grid, leftOut, builder);
  return builder.finish();
}

}  // namespace dovetail::solid_io
