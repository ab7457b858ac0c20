// What a run looks like: fields, pictures, rows of series; of a run step by step and of folders.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <sstream>
#include <tuple>

#include "callbacks.hpp"
#include "dovetail/core/progress.hpp"
#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/grid_fields.hpp"
#include "dovetail/scene/picture.hpp"
#include "scene_run.hpp"

namespace dovetail::python {

namespace fs = std::filesystem;

namespace {

/// Arrays of this shape, with the components behind it. @param values  x fastest, if the shape is one of a grid
Numbers shaped(std::span<const double> values, const std::vector<py::ssize_t>& shape, int components) {
  std::vector<py::ssize_t> full(shape.rbegin(), shape.rend());
  if (components == 3) full.push_back(3);
  if (components == 9) full.insert(full.end(), {3, 3});
  Numbers all(full);
  std::ranges::copy(values, all.mutable_data());
  if (shape.size() == 1) return all;
  py::list axes;  // (z, y, x) as it lies in memory becomes (x, y, z)
  for (const int axis : {2, 1, 0}) axes.append(axis);
  for (int c = 3; c < all.ndim(); ++c) axes.append(c);
  return py::module_::import("numpy").attr("ascontiguousarray")(all.attr("transpose")(axes));
}

std::vector<double> flat(const std::vector<Vec3>& all) {
  std::vector<double> numbers;
  for (const Vec3& one : all) numbers.insert(numbers.end(), {one.x, one.y, one.z});
  return numbers;
}

py::dict dictOf(const scene::SampledFields& sample, bool hasGrid, const std::string& advice) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(sample.points.size())};
  if (hasGrid) shape.assign(sample.grid.count.begin(), sample.grid.count.end());
  py::dict all;
  all["x"] = shaped(flat(sample.points), shape, 3);
  for (const scene::NamedField& field : scene::namedFields(sample.fields))
    all[py::str(field.name)] = shaped(field.values, shape, field.components);
  all["time"] = sample.time;
  all["width"] = sample.kernel.width;
  if (!advice.empty()) all["advice"] = advice;
  return all;
}

scene::GridOptions gridOptions(const std::string& kernel, std::optional<double> width, std::optional<double> spacing,
                               const std::optional<Numbers>& box, const std::optional<Numbers>& points, bool advises) {
  scene::GridOptions options{.width = width, .advisesWidth = advises, .spacing = spacing};
  if (kernel != "lucy" && kernel != "gauss")
    throw InputError("there is no kernel '" + kernel + "'", "kernel", "give lucy or gauss");
  if (kernel == "gauss") options.shape = cg::KernelShape::gauss;
  if (width && advises) throw InputError("a width is given and asked for", "width", "leave out one of them");
  if (box) {
    const std::vector<Vec3> corners = vectorsOf(*box, 2, "box");
    if (box->ndim() != 2) throw InputError("a box has two corners", "box", "give [[x, y, z], [x, y, z]], lower first");
    options.box = geometry::Box{corners[0], corners[1]};
  }
  if (points) {
    const auto rows = points->ndim() == 2 ? static_cast<std::size_t>(points->shape(0)) : 1;
    options.points = vectorsOf(*points, rows, "points");
  }
  return options;
}

py::dict fieldsOfRun(SceneRun& run, const scene::GridOptions& options) {
  run.requireWhole();
  scene::requireGrainsAlone(run.scene(), "fields");
  std::ostringstream advice;
  const scene::SampledFields sample = scene::sampleFields(run.run().grains, options, advice);
  return dictOf(sample, !options.points, advice.str());
}

py::dict fieldsOfFolder(const fs::path& folder, const scene::GridOptions& options) {
  std::ostringstream advice;
  const scene::SampledFields sample = [&] {
    const py::gil_scoped_release free;
    return scene::sampleFields(folder, options, advice);
  }();
  return dictOf(sample, !options.points, advice.str());
}

template <class T>
T valueOf(const py::dict& given, const char* name) {
  try {
    return py::cast<T>(given[name]);
  } catch (const py::cast_error&) {
    throw InputError(std::string(py::repr(given[name])) + " is of another type", name,
                     "see the options of dovetail picture --help");
  }
}

/// Options of the program by their names, those that are given.
scene::PictureOptions pictureOptions(const py::dict& given) {
  using Pair = std::pair<double, double>;
  scene::PictureOptions options;
  const auto take = [&]<class T>(const char* name, T& to) {
    if (given.contains(name)) to = valueOf<T>(given, name);
  };
  take("film", options.film);
  take("frame", options.frame);
  take("mode", options.mode);
  take("cell", options.cell);
  take("azimuth", options.azimuth);
  take("elevation", options.elevation);
  take("grains", options.grains);
  take("solids", options.solids);
  take("lines", options.lines);
  take("warp", options.warp);
  take("background", options.background);
  if (given.contains("cut"))
    std::tie(options.cutAxis, options.cutAt) = valueOf<std::pair<std::string, double>>(given, "cut");
  if (given.contains("uncut") && valueOf<bool>(given, "uncut")) options.cutAxis = "none";
  if (given.contains("size")) std::tie(options.width, options.height) = valueOf<std::pair<int, int>>(given, "size");
  for (const auto& [name, to] :
       {std::pair{"grain_range", &options.grainRange}, std::pair{"solid_range", &options.solidRange}})
    if (given.contains(name)) {
      const auto [low, high] = valueOf<Pair>(given, name);
      *to = scene::ColourRange{low, high};
    }
  return options;
}

py::tuple tupleOf(const scene::Picture& picture) { return py::make_tuple(py::bytes(picture.bytes), picture.caption); }

py::tuple pictureOfRun(SceneRun& run, const py::dict& given) {
  run.requireWhole();
  return tupleOf(scene::drawPicture(run.built(), run.scene(), pictureOptions(given)));
}

py::tuple pictureOfFolder(const fs::path& folder, const py::dict& given) {
  const scene::PictureOptions options = pictureOptions(given);
  const scene::Picture picture = [&] {
    const py::gil_scoped_release free;
    return scene::drawPicture(folder, options);
  }();
  return tupleOf(picture);
}

py::dict columnsOf(const fs::path& file) {
  const io::TimeSeries table = io::readCsv(file);
  py::dict all;
  for (std::size_t c = 0; c < table.names().size(); ++c) all[py::str(table.names()[c])] = arrayOf(table.column(c));
  return all;
}

py::dict dictOf(const std::vector<std::string>& names, const std::vector<double>& values) {
  py::dict all;
  for (std::size_t c = 0; c < names.size(); ++c) all[py::str(names[c])] = values[c];
  return all;
}

}  // namespace

void bindLooking(py::module_& m) {
  m.def("fields_of_run",
        [](SceneRun& run, const std::string& kernel, std::optional<double> width, std::optional<double> spacing,
           const std::optional<Numbers>& box, const std::optional<Numbers>& points,
           bool advises) { return fieldsOfRun(run, gridOptions(kernel, width, spacing, box, points, advises)); });
  m.def("fields_of_folder",
        [](const fs::path& folder, const std::string& kernel, std::optional<double> width,
           std::optional<double> spacing, const std::optional<Numbers>& box, const std::optional<Numbers>& points,
           bool advises) { return fieldsOfFolder(folder, gridOptions(kernel, width, spacing, box, points, advises)); });
  m.def("picture_of_run", &pictureOfRun);
  m.def("picture_of_folder", &pictureOfFolder);
  m.def("columns_of", &columnsOf);
  m.def("progress_line", &progressLine);
  m.def("probes_of_run", [](SceneRun& run) {
    run.requireWhole();
    return dictOf(run.row().probeNames(), run.row().probesNow(run.built()));
  });
  m.def("series_of_run", [](SceneRun& run) {
    run.requireWhole();
    return dictOf(run.row().names(), run.row().now(run.built(), run.run().criticalStep().dt));
  });
}

}  // namespace dovetail::python
