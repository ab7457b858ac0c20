#include "dovetail/io_hdf5/time_series_hdf5.hpp"

#include "dovetail/io/output_folder.hpp"
#include "hdf5_file.hpp"

namespace dovetail::io {

namespace {

void writeColumn(hid_t file, const std::string& name, std::span<const double> values) {
  writeDoubles(file, name, values.data(), values.size());
  const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "dataset");
  writeStrings(dataset, "unit", {unitOf(name)}, true);
}

Handle opened(const std::filesystem::path& path) {
  const hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id < 0) throw InputError("the file is no HDF5 file, or damaged", path.string(), "give a series.h5 of a run");
  return Handle(id, H5Fclose, "opening the file");
}

/// Strings of variable length, as writeStrings writes them. @throws Error if the attribute is of another type
std::vector<std::string> readStrings(hid_t attribute) {
  const Handle type(H5Aget_type(attribute), H5Tclose, "type of an attribute"),
      space(H5Aget_space(attribute), H5Sclose, "space");
  require(H5Tis_variable_str(type) > 0 ? 0 : -1, "reading an attribute that is no string");
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  require(count < 0 || count > 1000000 ? -1 : 0, "size of an attribute");
  std::vector<char*> pointers(static_cast<std::size_t>(count), nullptr);
  require(H5Aread(attribute, type, pointers.data()), "reading an attribute");
  std::vector<std::string> values;
  for (const char* const pointer : pointers) values.emplace_back(pointer ? pointer : "");
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
  return values;
}

std::vector<double> readColumn(hid_t file, const std::string& name) {
  const Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "opening a column"),
      space(H5Dget_space(dataset), H5Sclose, "space");
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  require(count < 0 || static_cast<hsize_t>(count) * sizeof(double) > H5Dget_storage_size(dataset) ? -1 : 0,
          "size of a column");
  std::vector<double> values(static_cast<std::size_t>(count));
  if (count > 0)
    require(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "reading a column");
  return values;
}

/// What HDF5 cannot do with a file is the file's fault.
template <class Act>
auto asInput(const std::filesystem::path& path, Act&& act) {
  try {
    const Silence silence;
    return act();
  } catch (const InputError&) {
    throw;
  } catch (const Error& error) {
    throw InputError("the file is no series, or damaged (" + std::string(error.what()) + ")", path.string(),
                     "give a series.h5 of a run");
  }
}

}  // namespace

TimeSeries readHdf5(const std::filesystem::path& path) {
  return asInput(path, [&] {
    const Handle file = opened(path), names(H5Aopen(file, "columns", H5P_DEFAULT), H5Aclose, "the columns");
    TimeSeries series(readStrings(names));
    std::vector<std::vector<double>> columns;
    for (const std::string& name : series.names()) columns.push_back(readColumn(file, name));
    std::vector<double> row(columns.size());
    for (std::size_t k = 0; k < columns.front().size(); ++k) {
      for (std::size_t c = 0; c < row.size(); ++c) {
        require(columns[c].size() == columns[0].size() ? 0 : -1, "columns of one length");
        row[c] = columns[c][k];
      }
      series.append(row);
    }
    return series;
  });
}

KeyValues readHdf5Provenance(const std::filesystem::path& path) {
  return asInput(path, [&] {
    const Handle file = opened(path);
    KeyValues entries;
    const auto visit = [](hid_t object, const char* name, const H5A_info_t*, void* found) -> herr_t {
      if (std::string(name) == "columns") return 0;
      try {
        const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, "an attribute");
        const std::vector<std::string> values = readStrings(attribute);
        if (values.size() == 1) static_cast<KeyValues*>(found)->emplace_back(name, values[0]);
        return 0;
      } catch (const Error&) {
        return -1;
      }
    };
    require(H5Aiterate2(file, H5_INDEX_CRT_ORDER, H5_ITER_INC, nullptr, visit, &entries), "attributes");
    return entries;
  });
}

void writeHdf5(const std::filesystem::path& path, const TimeSeries& series, const KeyValues& provenance) {
  requireFreeOrOurs(path);
  const Silence silence;
  writeFileAtomically(path, hdf5Image(withMark(provenance), [&](hid_t file) {
                        writeStrings(file, "columns", series.names(), false);
                        for (std::size_t i = 0; i < series.names().size(); ++i)
                          writeColumn(file, series.names()[i], series.column(i));
                      }));
}

}  // namespace dovetail::io
