// Files in which arrays of a scene reach it.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/solid_mesh.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/solid_io/solid_files.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace fs = std::filesystem;
using Integers = py::array_t<std::int64_t, py::array::c_style>;

namespace {

void requirePositive(const Numbers& radius, const std::string& where) {
  const double* const r = radius.data();
  for (py::ssize_t k = 0; k < radius.size(); ++k)
    if (!(r[k] > 0.0) || !std::isfinite(r[k]))
      throw InputError("radius " + std::to_string(k) + " is not finite and > 0", where, "give radii in m");
}

/// One row a sphere, in the columns that scenes read.
void writeSpheres(const fs::path& file, const Numbers& at, const Numbers& radius,
                  const std::optional<Numbers>& velocity, const std::optional<Numbers>& spin,
                  const std::string& where) {
  if (at.ndim() != 2 || at.shape(0) == 0)
    throw InputError("there are no rows in \"at\"", where, "give centres as an array of the shape (N, 3), m");
  const auto n = static_cast<std::size_t>(at.shape(0));
  if (radius.ndim() > 1 || (radius.ndim() == 1 && static_cast<std::size_t>(radius.shape(0)) != n))
    throw InputError("there are " + std::to_string(radius.size()) + " radii of " + std::to_string(n) + " spheres",
                     where, "give as many, or one number for all");
  requirePositive(radius, where);
  std::vector<std::string> names{"x_m", "y_m", "z_m", "radius_m"};
  std::vector<std::vector<Vec3>> vectors{vectorsOf(at, n, where + ".at")};
  const auto add = [&](const std::optional<Numbers>& more, const char* key, const char* begin, const char* unit) {
    if (!more) return;
    vectors.push_back(vectorsOf(*more, n, where + "." + key));
    for (const char axis : {'x', 'y', 'z'}) names.push_back(std::string(begin) + axis + unit);
  };
  add(velocity, "velocity", "v", "_m_per_s");
  add(spin, "spin", "w", "_rad_per_s");
  io::TimeSeries table(names);
  std::vector<double> row(names.size());
  for (std::size_t i = 0; i < n; ++i) {
    auto to = row.begin();
    for (std::size_t k = 0; k < vectors.size(); ++k) {
      for (int c = 0; c < 3; ++c) *to++ = vectors[k][i][c];
      if (k == 0) *to++ = radius.data()[radius.ndim() == 0 ? 0 : i];
    }
    table.append(row);
  }
  io::writeCsv(file, table, {});
}

fem::ElementShape shapeNamed(const std::string& name, const std::string& where) {
  std::string known;
  for (const fem::ElementShape shape : fem::allCellShapes) {
    if (name == fem::name(shape)) return shape;
    known += (known.empty() ? "" : ", ") + std::string(fem::name(shape));
  }
  throw InputError("the shape of elements is \"" + name + "\"", where, "give one of " + known);
}

void writeMesh(const fs::path& file, const Numbers& nodes, const Integers& elements, const std::string& shape,
               const std::string& where) {
  fem::SolidMesh mesh;
  mesh.X = vectorsOf(nodes, nodes.ndim() == 2 ? static_cast<std::size_t>(nodes.shape(0)) : 0, where + ".nodes");
  fem::ElementGroup group{shapeNamed(shape, where), {}};
  mesh.groups.push_back({group.shape, numbersOf(elements, static_cast<std::size_t>(fem::nodesOf(group.shape)),
                                                mesh.X.size(), where + ".elements")});
  solid_io::writeSolid(mesh, file);
}

}  // namespace

std::vector<int> numbersOf(const Integers& rows, std::size_t perRow, std::size_t below, const std::string& what) {
  if (rows.ndim() != 2 || static_cast<std::size_t>(rows.shape(1)) != perRow)
    throw InputError("these are not rows of " + std::to_string(perRow) + " numbers", what,
                     "give an array of integers of the shape (M, " + std::to_string(perRow) + ")");
  std::vector<int> all(static_cast<std::size_t>(rows.size()));
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::int64_t number = rows.data()[k];
    if (number < 0 || static_cast<std::uint64_t>(number) >= below)
      throw InputError("row " + std::to_string(k / perRow) + " names number " + std::to_string(number) + " of " +
                           std::to_string(below),
                       what, "numbers count from 0");
    all[k] = static_cast<int>(number);
  }
  return all;
}

void bindFiles(py::module_& m) {
  m.def("_write_spheres", &writeSpheres);
  m.def("_write_mesh", &writeMesh);
}

}  // namespace dovetail::python
