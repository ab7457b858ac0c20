#include "dovetail/io_hdf5/vtkhdf.hpp"

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
void writeKind(hid_t root) {
  const std::string kind = "UnstructuredGrid";
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "string type"), scalar(H5Screate(H5S_SCALAR), H5Sclose, "space");
  require(H5Tset_size(type, kind.size()), "string length");
  const Handle attribute(H5Acreate2(root, "Type", type, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "attribute");
  require(H5Awrite(attribute, type, kind.data()), "writing an attribute");
  const hsize_t two = 2;
  const std::int64_t version[] = {1, 0};
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
  writeKind(root);
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

}  // namespace

void writeVtkHdf(const std::filesystem::path& path, double time, const HdfGrid& grid, const KeyValues& provenance) {
  requireConsistent(grid);
  requireFreeOrOurs(path);
  const Silence silence;
  writeFileAtomically(path, hdf5Image(withMark(provenance), [&](hid_t file) { fillGrid(file, time, grid); }));
}

}  // namespace dovetail::io
