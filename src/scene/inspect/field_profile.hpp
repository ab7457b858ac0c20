// Fields along an axis.
#pragma once

#include "dovetail/cg/fields.hpp"
#include "dovetail/io/time_series.hpp"

namespace dovetail::scene {

/// Means over the layers of a grid across an axis (0, 1, 2), with their standard errors, "…_error_…": position, number
/// of places that share no grain, density, solid fraction, velocity (momentum over density, with the error of a ratio),
/// total stress, pressure, temperature. A layer has as many independent places as patches of the kernel's diameter fit
/// into it; with one alone, errors are NaN.
/// @param width  cut-off radius of the kernel, m
io::TimeSeries profileOf(const cg::Grid& grid, const cg::Fields& fields, int axis, double width);

}  // namespace dovetail::scene
