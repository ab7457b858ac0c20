#include "hdf5_file.hpp"

namespace dovetail::io {

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

void writeDoubles(hid_t group, const std::string& name, const double* values, std::size_t count, int components) {
  const hsize_t extent[] = {count / static_cast<hsize_t>(components), static_cast<hsize_t>(components)};
  const Handle space(H5Screate_simple(components > 1 ? 2 : 1, extent, nullptr), H5Sclose, "space");
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "dataset properties");
  require(H5Pset_obj_track_times(creation, false), "leaving out times");
  const Handle dataset(H5Dcreate2(group, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                       H5Dclose, "dataset");
  if (count > 0)
    require(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "writing a dataset");
}

std::string hdf5Image(const KeyValues& provenance, const std::function<void(hid_t file)>& fill) {
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
  fill(file);
  require(H5Fflush(file, H5F_SCOPE_GLOBAL), "flushing the file");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  require(size < 0 ? -1 : 0, "size of the file");
  std::string image(static_cast<std::size_t>(size), '\0');
  require(H5Fget_file_image(file, image.data(), image.size()) == size ? 0 : -1, "bytes of the file");
  return image;
}

}  // namespace dovetail::io
