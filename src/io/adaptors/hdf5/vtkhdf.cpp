#include "dovetail/io_hdf5/vtkhdf.hpp"

#include <cmath>

#include "dovetail/io/output_folder.hpp"
#include "hdf5_file.hpp"

namespace dovetail::io {

namespace {

Handle groupIn(hid_t parent, const char* name) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose, "group properties");
  require(H5Pset_obj_track_times(creation, false), "leaving out times");
  return Handle(H5Gcreate2(parent, name, H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose, "group");
}

/// @param inFile, inMemory  types of the numbers
void writeNumbers(hid_t group, const char* name, hid_t inFile, hid_t inMemory, const void* values, std::size_t count) {
  const hsize_t extent = count;
  const Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, "space");
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "dataset properties");
  require(H5Pset_obj_track_times(creation, false), "leaving out times");
  const Handle dataset(H5Dcreate2(group, name, inFile, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose, "dataset");
  if (count > 0) require(H5Dwrite(dataset, inMemory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "writing a dataset");
}
void writeIntegers(hid_t group, const char* name, const std::vector<std::int64_t>& values) {
  writeNumbers(group, name, H5T_STD_I64LE, H5T_NATIVE_INT64, values.data(), values.size());
}

/// What kind of file it is: the reader wants a string of fixed length.
void writeKind(hid_t root, std::int64_t major) {
  const std::string kind = "UnstructuredGrid";
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "string type"), scalar(H5Screate(H5S_SCALAR), H5Sclose, "space");
  require(H5Tset_size(type, kind.size()), "string length");
  const Handle attribute(H5Acreate2(root, "Type", type, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "attribute");
  require(H5Awrite(attribute, type, kind.data()), "writing an attribute");
  const hsize_t two = 2;
  const std::int64_t version[] = {major, 0};
  const Handle pair(H5Screate_simple(1, &two, nullptr), H5Sclose, "space");
  const Handle number(H5Acreate2(root, "Version", H5T_STD_I64LE, pair, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                      "attribute");
  require(H5Awrite(number, H5T_NATIVE_INT64, version), "writing an attribute");
}

void requireConsistent(const HdfGrid& grid) {
  for (const HdfGrid::Field& field : grid.fields) {
    const std::size_t count = field.perCell ? grid.types.size() : grid.points.size();
    if (field.components < 1 || field.values.size() != count * static_cast<std::size_t>(field.components))
      throw InputError("the field \"" + field.name + "\" has " + std::to_string(field.values.size()) + " values",
                       "VTKHDF", "give one value per component and point or cell");
  }
  if (grid.offsets.size() != grid.types.size() + 1 || grid.offsets.front() != 0 ||
      grid.offsets.back() != static_cast<std::int64_t>(grid.connectivity.size()))
    throw InputError("the offsets do not go with the cells", "VTKHDF", "give one per cell, and the end");
}

void fillGrid(hid_t file, double time, const HdfGrid& grid) {
  const Handle root = groupIn(file, "VTKHDF");
  writeKind(root, 1);
  writeIntegers(root, "NumberOfPoints", {static_cast<std::int64_t>(grid.points.size())});
  writeIntegers(root, "NumberOfCells", {static_cast<std::int64_t>(grid.types.size())});
  writeIntegers(root, "NumberOfConnectivityIds", {static_cast<std::int64_t>(grid.connectivity.size())});
  writeDoubles(root, "Points", grid.points.empty() ? nullptr : &grid.points[0].x, 3 * grid.points.size(), 3);
  writeIntegers(root, "Connectivity", grid.connectivity);
  writeIntegers(root, "Offsets", grid.offsets);
  writeNumbers(root, "Types", H5T_STD_U8LE, H5T_NATIVE_UINT8, grid.types.data(), grid.types.size());
  const Handle perPoint = groupIn(root, "PointData"), perCell = groupIn(root, "CellData"),
               fields = groupIn(root, "FieldData");
  for (const HdfGrid::Field& field : grid.fields)
    writeDoubles(field.perCell ? perCell : perPoint, field.name, field.values.data(), field.values.size(),
                 field.components);
  writeDoubles(fields, "TimeValue", &time, 1);
}

void requireConsistent(const std::vector<HdfPoints>& frames) {
  if (frames.empty()) throw InputError("there are no frames", "VTKHDF", "give some");
  const auto sizes = [](const HdfPoints& frame) {
    std::vector<std::pair<std::string, int>> names;
    for (const HdfPoints::Field& field : frame.fields) names.emplace_back(field.name, field.components);
    for (const HdfPoints::Integers& field : frame.integers) names.emplace_back(field.name, 0);
    return names;
  };
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const HdfPoints& frame = frames[k];
    const std::string where = "VTKHDF, frame " + std::to_string(k);
    if (!std::isfinite(frame.time) || (k > 0 && !(frame.time > frames[k - 1].time)))
      throw InputError("its time is not later than that of the frame before", where, "give times that grow");
    if (sizes(frame) != sizes(frames.front()))
      throw InputError("its fields are not those of the first frame", where, "give all frames the same");
    for (const HdfPoints::Field& field : frame.fields)
      if (field.values.size() != frame.points.size() * static_cast<std::size_t>(field.components))
        throw InputError("the field \"" + field.name + "\" has another size", where, "give a value per point");
    for (const HdfPoints::Integers& field : frame.integers)
      if (field.values.size() != frame.points.size())
        throw InputError("the field \"" + field.name + "\" has another size", where, "give a value per point");
  }
}

/// One after the other, of all frames. @param of  the numbers of a frame
template <class Number, class Of>
std::vector<Number> joined(const std::vector<HdfPoints>& frames, Of&& of) {
  std::vector<Number> all;
  for (const HdfPoints& frame : frames) {
    const std::span<const Number> own = of(frame);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

/// Where the points of each frame begin; those of their cells, which are one per point, as well.
void writeSteps(hid_t root, const std::vector<HdfPoints>& frames) {
  const Handle steps = groupIn(root, "Steps");
  std::vector<double> times;
  std::vector<std::int64_t> begins, parts;
  for (const HdfPoints& frame : frames) {
    parts.push_back(static_cast<std::int64_t>(parts.size()));
    begins.push_back(times.empty() ? 0
                                   : begins.back() + static_cast<std::int64_t>(frames[times.size() - 1].points.size()));
    times.push_back(frame.time);
  }
  const Handle scalar(H5Screate(H5S_SCALAR), H5Sclose, "space");
  const Handle count(H5Acreate2(steps, "NSteps", H5T_STD_I64LE, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                     "attribute");
  const auto number = static_cast<std::int64_t>(frames.size());
  require(H5Awrite(count, H5T_NATIVE_INT64, &number), "writing an attribute");
  writeDoubles(steps, "Values", times.data(), times.size());
  writeIntegers(steps, "PartOffsets", parts);
  writeIntegers(steps, "NumberOfParts", std::vector<std::int64_t>(frames.size(), 1));
  for (const char* const name : {"PointOffsets", "CellOffsets", "ConnectivityIdOffsets"})
    writeIntegers(steps, name, begins);
  const Handle offsets = groupIn(steps, "PointDataOffsets");
  for (const HdfPoints::Field& field : frames.front().fields) writeIntegers(offsets, field.name.c_str(), begins);
  for (const HdfPoints::Integers& field : frames.front().integers) writeIntegers(offsets, field.name.c_str(), begins);
}

void writePointData(hid_t root, const std::vector<HdfPoints>& frames) {
  const Handle perPoint = groupIn(root, "PointData");
  for (std::size_t k = 0; k < frames.front().fields.size(); ++k) {
    const HdfPoints::Field& field = frames.front().fields[k];
    const auto values = joined<double>(frames, [k](const HdfPoints& frame) { return frame.fields[k].values; });
    writeDoubles(perPoint, field.name, values.data(), values.size(), field.components);
  }
  for (std::size_t k = 0; k < frames.front().integers.size(); ++k)
    writeIntegers(perPoint, frames.front().integers[k].name.c_str(),
                  joined<std::int64_t>(frames, [k](const HdfPoints& frame) { return frame.integers[k].values; }));
}

void fillSeries(hid_t file, const std::vector<HdfPoints>& frames) {
  constexpr std::uint8_t vertex = 1;  // VTK_VERTEX
  const Handle root = groupIn(file, "VTKHDF");
  writeKind(root, 2);
  std::vector<std::int64_t> counts, connectivity, offsets;
  for (const HdfPoints& frame : frames) {
    counts.push_back(static_cast<std::int64_t>(frame.points.size()));
    for (std::int64_t i = 0; i < counts.back(); ++i) {
      connectivity.push_back(i);
      offsets.push_back(i);
    }
    offsets.push_back(counts.back());
  }
  for (const char* const name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    writeIntegers(root, name, counts);
  const std::vector<Vec3> points = joined<Vec3>(frames, [](const HdfPoints& frame) { return frame.points; });
  writeDoubles(root, "Points", points.empty() ? nullptr : &points[0].x, 3 * points.size(), 3);
  writeIntegers(root, "Connectivity", connectivity);
  writeIntegers(root, "Offsets", offsets);
  const std::vector<std::uint8_t> types(points.size(), vertex);
  writeNumbers(root, "Types", H5T_STD_U8LE, H5T_NATIVE_UINT8, types.data(), types.size());
  writePointData(root, frames);
  writeSteps(root, frames);
}

}  // namespace

void writeVtkHdf(const std::filesystem::path& path, double time, const HdfGrid& grid, const KeyValues& provenance) {
  requireConsistent(grid);
  requireFreeOrOurs(path);
  const Silence silence;
  writeFileAtomically(path, hdf5Image(withMark(provenance), [&](hid_t file) { fillGrid(file, time, grid); }));
}

void writeVtkHdfSeries(const std::filesystem::path& path, const std::vector<HdfPoints>& frames,
                       const KeyValues& provenance) {
  requireConsistent(frames);
  requireFreeOrOurs(path);
  const Silence silence;
  writeFileAtomically(path, hdf5Image(withMark(provenance), [&](hid_t file) { fillSeries(file, frames); }));
}

}  // namespace dovetail::io
