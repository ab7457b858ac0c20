#include "dovetail/mesh_io_vtk/vtp.hpp"

#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <limits>
#include <string>

#include "../../../io/adaptors/vtk/vtk_xml.hpp"
#include "dovetail/core/farthest.hpp"

namespace dovetail::mesh_io {

namespace {

using io::refuseVtk;

std::string place(const char* kind, vtkIdType cell) { return std::string(kind) + " " + std::to_string(cell); }

/// Calls add(corners, mesh) for each cell, after its indices have been checked.
template <class Add>
void readCells(vtkCellArray* cells, const char* kind, const std::filesystem::path& path, geometry::TriangleMesh& mesh,
               Add&& add) {
  const auto iterator = vtkSmartPointer<vtkCellArrayIterator>::Take(cells->NewIterator());
  std::vector<int> corners;
  vtkIdType number = 0;
  for (iterator->GoToFirstCell(); !iterator->IsDoneWithTraversal(); iterator->GoToNextCell(), ++number) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    iterator->GetCurrentCell(count, ids);
    if (count < 3)
      refuseVtk(path, place(kind, number), "it has " + std::to_string(count) + " vertices", "give 3 or more");
    corners.clear();
    for (vtkIdType k = 0; k < count; ++k) {
      if (ids[k] < 0 || ids[k] >= static_cast<vtkIdType>(mesh.x.size()))
        refuseVtk(path, place(kind, number), "it names vertex " + std::to_string(ids[k]),
                  "use 0 to " + std::to_string(static_cast<long>(mesh.x.size()) - 1));
      corners.push_back(static_cast<int>(ids[k]));
    }
    add(corners);
  }
}

/// The offsets of cells as the file has them, before anything follows them.
void requireOffsets(vtkCellArray* cells, const char* kind, const std::filesystem::path& path) {
  vtkDataArray* const offsets = cells->GetOffsetsArray();
  for (vtkIdType c = 0; c < cells->GetNumberOfCells(); ++c) {
    const double begin = offsets->GetComponent(c, 0), end = offsets->GetComponent(c + 1, 0);
    if (begin < 0.0 || end < begin || end > static_cast<double>(cells->GetNumberOfConnectivityIds()))
      refuseVtk(path, place(kind, c), "its offsets do not fit", "give a complete VTP file");
  }
}

}  // namespace

geometry::TriangleMesh readVtp(const std::filesystem::path& path) {
  const auto data = io::readVtkXml<vtkXMLPolyDataReader>(path, "VTP", "PolyData");
  geometry::TriangleMesh mesh;
  const vtkIdType points = data->GetNumberOfPoints();
  if (points > std::numeric_limits<int>::max())
    refuseVtk(path, "", "the file holds too many vertices", "cut the surface into several files");
  for (vtkIdType i = 0; i < points; ++i) {
    double p[3];
    data->GetPoint(i, p);
    mesh.x.push_back({p[0], p[1], p[2]});
    if (isTooFar({p[0], p[1], p[2]}))
      refuseVtk(path, place("point", i), "it lies farther than 1e15 m from the origin", "give coordinates in metres");
  }
  requireOffsets(data->GetPolys(), "polygon", path);
  requireOffsets(data->GetStrips(), "strip", path);
  readCells(data->GetPolys(), "polygon", path, mesh, [&](const std::vector<int>& v) {
    for (std::size_t k = 2; k < v.size(); ++k) mesh.facets.push_back({v[0], v[k - 1], v[k]});
  });
  readCells(data->GetStrips(), "strip", path, mesh, [&](const std::vector<int>& v) {
    for (std::size_t k = 2; k < v.size(); ++k)
      mesh.facets.push_back(k % 2 == 0 ? geometry::Facet{v[k - 2], v[k - 1], v[k]}
                                       : geometry::Facet{v[k - 1], v[k - 2], v[k]});
  });
  if (mesh.facets.empty()) refuseVtk(path, "", "the file holds no facets", "give a file with a surface of polygons");
  return mesh;
}

}  // namespace dovetail::mesh_io
