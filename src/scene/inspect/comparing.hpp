// The parts of a comparison.
#pragma once

#include <filesystem>

#include "dovetail/io/time_series.hpp"
#include "dovetail/scene/compare.hpp"

namespace dovetail::scene {

/// |a − b|, infinite if only one of them is NaN.
double apart(double a, double b);

/// Two files of frames, or series of them; in builds without VTK they are unlike. @param name  of the series
void compareFrames(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& name,
                   Comparison& to);
bool isFrameFile(const std::filesystem::path& file);

/// @throws InputError in builds without HDF5
io::TimeSeries readSeriesHdf5(const std::filesystem::path& file);

}  // namespace dovetail::scene
