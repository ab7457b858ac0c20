#include "dovetail/io_hdf5/time_series_hdf5.hpp"

#include <hdf5.h>

#include "dovetail/core/error.hpp"
#include "dovetail/io/output_folder.hpp"

namespace dovetail::io {

namespace {

/// An HDF5 identifier, closed by the function that goes with its kind.
class Handle {
public:
  Handle(hid_t id, herr_t (*closeIt)(hid_t), const char* step) : id_(id), close_(closeIt) {
    if (id < 0) throw Error(std::string("HDF5 failed at ") + step, "", "look for repeated names and for memory");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void require(herr_t status, const char* step) {
  if (status < 0) throw Error(std::string("HDF5 failed at ") + step, "", "look for repeated names and for memory");
}

/// While it lives, HDF5 prints no error stack of its own.
class Silence {
public:
  Silence() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Silence() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Strings of variable length: an attribute of fixed length could not pass 64 KiB.
void writeStrings(hid_t object, const std::string& name, const std::vector<std::string>& values, bool scalar) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "string type");
  require(H5Tset_size(type, H5T_VARIABLE), "string length");
  require(H5Tset_cset(type, H5T_CSET_UTF8), "string encoding");
  const hsize_t count = values.size();
  const Handle space(scalar ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose, "space");
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "attribute");
  std::vector<const char*> pointers;
  for (const std::string& value : values) pointers.push_back(value.c_str());
  require(H5Awrite(attribute, type, pointers.data()), "writing an attribute");
}

void writeColumn(hid_t file, const std::string& name, std::span<const double> values) {
  const hsize_t count = values.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, "space");
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "dataset properties");
  require(H5Pset_obj_track_times(creation, false), "leaving out times");
  const Handle dataset(H5Dcreate2(file, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                       H5Dclose, "dataset");
  if (count > 0)
    require(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "writing a dataset");
  writeStrings(dataset, "unit", {unitOf(name)}, true);
}

/// The bytes of the file, without the times of its parts: equal series are equal files. HDF5 builds it in memory,
/// because a file that it cannot close on a full disk makes the program crash at exit.
std::string fileImage(const TimeSeries& series, const KeyValues& provenance) {
  constexpr unsigned order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "file properties");
  require(H5Pset_attr_creation_order(creation, order), "order of attributes");
  require(H5Pset_link_creation_order(creation, order), "order of datasets");
  require(H5Pset_obj_track_times(creation, false), "leaving out times");
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file properties");
  require(H5Pset_fapl_core(access, std::size_t{1} << 20, false), "a file in memory");
  const Handle file(H5Fcreate("image", H5F_ACC_TRUNC, creation, access), H5Fclose, "creating the file");
  // First, so that the mark of our files lies near the beginning.
  for (const auto& [key, value] : provenance) writeStrings(file, key, {value}, true);
  writeStrings(file, "columns", series.names(), false);
  for (std::size_t i = 0; i < series.names().size(); ++i) writeColumn(file, series.names()[i], series.column(i));
  require(H5Fflush(file, H5F_SCOPE_GLOBAL), "flushing the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  require(size < 0 ? -1 : 0, "size of the file");
  std::string image(static_cast<std::size_t>(size), '\0');
  require(H5Fget_file_image(file, image.data(), image.size()) == size ? 0 : -1, "bytes of the file");
  return image;
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
  writeFileAtomically(path, fileImage(series, withMark(provenance)));
}

}  // namespace dovetail::io
