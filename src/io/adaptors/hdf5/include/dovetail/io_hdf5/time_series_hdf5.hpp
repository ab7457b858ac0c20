// Time series as HDF5.
#pragma once

#include <filesystem>

#include "dovetail/io/provenance.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::io {

/// One dataset of doubles per column, named like the column, shape (rows), attribute "unit" (see unitOf); the
/// provenance as string attributes of the root group, in their order of creation. The columns' order is kept in the
/// attribute "columns" of the root group. Written under a temporary name and renamed: whatever goes wrong, the file
/// that was there stays (see output_folder.hpp for the rule).
/// @throws InputError if nothing can be written there or the name is taken by a file that is not ours
/// @throws Error if HDF5 fails (a repeated key of the provenance) or writing breaks off (disk full)
void writeHdf5(const std::filesystem::path& path, const TimeSeries& series, const KeyValues& provenance);

/// What writeHdf5 wrote. @throws InputError if the file is none, or damaged
TimeSeries readHdf5(const std::filesystem::path& path);
/// The string attributes of its root group but "columns", in their order.
KeyValues readHdf5Provenance(const std::filesystem::path& path);

}  // namespace dovetail::io
