// What the writers and readers of HDF5 files share.
#pragma once

#include <hdf5.h>

#include <functional>
#include <string>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/io/provenance.hpp"

namespace dovetail::io {

/// An HDF5 identifier, closed by the function that goes with its kind.
class Handle {
public:
  Handle(hid_t id, herr_t (*closeIt)(hid_t), const char* step) : id_(id), close_(closeIt) {
    if (id < 0) throw Error(std::string("HDF5 failed at ") + step, "", "check for repeated names and free memory");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

inline void require(herr_t status, const char* step) {
  if (status < 0) throw Error(std::string("HDF5 failed at ") + step, "", "check for repeated names and free memory");
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
void writeStrings(hid_t object, const std::string& name, const std::vector<std::string>& values, bool scalar);

/// The bytes of a file whose root group has the provenance as attributes, and what `fill` puts into it; without the
/// times of its parts, so that equal contents are equal files. HDF5 builds it in memory, because a file that it cannot
/// close on a full disk makes the program crash at exit.
std::string hdf5Image(const KeyValues& provenance, const std::function<void(hid_t file)>& fill);

/// A dataset of doubles, one per row, or rows of `components` of them. @param count  of all doubles
void writeDoubles(hid_t group, const std::string& name, const double* values, std::size_t count, int components = 1);

}  // namespace dovetail::io
