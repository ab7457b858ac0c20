// Cells of grains: made, read, written.
#include "cells.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include "dovetail/rve/rve_archive.hpp"
#include "dovetail/scene/files.hpp"
#include "dovetail/scene/make_cells.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace fs = std::filesystem;

Numbers arrayOf(const Eigen::Matrix3d& a) {
  Numbers all({py::ssize_t{3}, py::ssize_t{3}});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) all.mutable_at(i, j) = a(i, j);
  return all;
}

Numbers arrayOf(const std::vector<Eigen::Matrix3d>& a) {
  Numbers all({static_cast<py::ssize_t>(a.size()), py::ssize_t{3}, py::ssize_t{3}});
  double* to = all.mutable_data();
  for (const Eigen::Matrix3d& one : a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) *to++ = one(i, j);
  return all;
}

Eigen::Matrix3d matrixOf(const Numbers& a, const char* what, bool open) {
  if (a.ndim() != 2 || a.shape(0) != 3 || a.shape(1) != 3)
    throw InputError("it is no matrix of (3, 3)", what, "give three rows of three numbers");
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      m(i, j) = a.at(i, j);
      if (!std::isfinite(m(i, j)) && !(open && std::isnan(m(i, j))))
        throw InputError("number (" + std::to_string(i) + ", " + std::to_string(j) + ") is not finite", what,
                         "give finite numbers");
    }
  return m;
}

namespace {

std::vector<Cell> cellsOf(std::vector<rve::Rve> all) {
  std::vector<Cell> cells;
  for (rve::Rve& one : all) cells.emplace_back(std::move(one));
  return cells;
}

/// @param text  an item of "cells" of a scene
std::vector<Cell> makeCells(const std::string& text, const std::string& name, const fs::path& folder,
                            const std::vector<std::string>& settings) {
  scene::Cells cells;
  scene::Parameters parameters;
  scene::readFields({text, name, folder}, settings, [&](scene::Fields& fields) {
    cells = {};
    fields.parameters({"let", "parameters of expressions"}, parameters);
    describe(fields, cells);
  });
  const py::gil_scoped_release free;
  return cellsOf(scene::makeCells(cells));
}

std::vector<Cell> readCells(const fs::path& file) { return cellsOf(rve::readSamples(file)); }

void writeCells(const fs::path& file, const std::vector<const Cell*>& cells) {
  std::vector<rve::Rve> all;
  for (const Cell* const one : cells) all.push_back(one->now());
  rve::writeSamples(file, all);
}

py::dict cellsOfRun(SceneRun& run) {
  py::dict all;
  for (const auto& [name, cells] : run.built().cells) all[py::str(name)] = cellsOf(cells);
  return all;
}

}  // namespace

void bindCells(py::module_& m) {
  py::class_<Cell> type(m, "Rve",
                        "A cell of grains: the stress that answers a deformation gradient F. Arrays are copies; discs "
                        "lie in the plane z = 0, and their F is that of the plane. Stresses are Pa, tension positive.");
  type.def(
      "copy", [](const Cell& cell) { return Cell(cell.now()); }, "A cell of its own, in the same state.");
  bindCellState(type);
  bindCellVerbs(type);
  m.def("make_cells", &makeCells);
  m.def("read_cells", &readCells, py::arg("file"), "Cells that write_cells, or dovetail cell, has written.");
  m.def("write_cells", &writeCells, py::arg("file"), py::arg("cells"),
        "Cells with their states, for scenes (\"grains\": \"file\") and read_cells.");
  m.def("cells_of_run", &cellsOfRun);
}

}  // namespace dovetail::python
