#include "dovetail/io_vtk/spheres.hpp"

#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cmath>

#include "vtk_xml.hpp"

namespace dovetail::io {

namespace {

/// The array of that name; null if there is none.
vtkDataArray* arrayOf(vtkPointSet* data, const char* name, int components, const std::filesystem::path& path) {
  vtkDataArray* const array = data->GetPointData()->GetArray(name);
  if (!array) return nullptr;
  if (array->GetNumberOfComponents() != components || array->GetNumberOfTuples() != data->GetNumberOfPoints())
    refuseVtk(path, name,
              "the array has " + std::to_string(array->GetNumberOfTuples()) + " × " +
                  std::to_string(array->GetNumberOfComponents()) + " numbers",
              "give " + std::to_string(components) + " for each of the " + std::to_string(data->GetNumberOfPoints()) +
                  " points");
  return array;
}

SphereTable spheresIn(vtkPointSet* data, const std::filesystem::path& path) {
  vtkDataArray* const radius = arrayOf(data, "radius", 1, path);
  vtkDataArray* const velocity = arrayOf(data, "velocity", 3, path);
  if (data->GetNumberOfPoints() == 0) refuseVtk(path, "", "the file holds no points", "give one with spheres");
  if (!radius) refuseVtk(path, "", "the points have no array \"radius\"", "give them one, in metres");
  SphereTable spheres;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    double x[3], v[3] = {0.0, 0.0, 0.0};
    data->GetPoint(i, x);
    if (velocity) velocity->GetTuple(i, v);
    spheres.position.push_back({x[0], x[1], x[2]});
    spheres.radius.push_back(radius->GetTuple1(i));
    if (velocity) spheres.velocity.push_back({v[0], v[1], v[2]});
    const std::string place = "point " + std::to_string(i);
    if (!isFinite(spheres.position.back()) || !isFinite(Vec3{v[0], v[1], v[2]}))
      refuseVtk(path, place, "its position or velocity is not finite", "give numbers");
    if (!(spheres.radius.back() > 0.0 && std::isfinite(spheres.radius.back())))
      refuseVtk(path, place, "its radius is not finite and > 0", "give one in metres");
  }
  return spheres;
}

}  // namespace

SphereTable readSpheres(const std::filesystem::path& path) {
  if (path.extension() == ".vtp") return spheresIn(readVtkXml<vtkXMLPolyDataReader>(path, "VTP", "PolyData"), path);
  return spheresIn(readVtkXml<vtkXMLUnstructuredGridReader>(path, "VTU", "UnstructuredGrid"), path);
}

}  // namespace dovetail::io
