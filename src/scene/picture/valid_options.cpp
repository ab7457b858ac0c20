#include "valid_options.hpp"

#include <cmath>
#include <set>

#include "dovetail/core/error.hpp"

namespace dovetail::scene {

namespace {

void requireRange(const std::optional<ColourRange>& range, const char* where) {
  if (range && !(std::isfinite(range->low) && std::isfinite(range->high) && range->low < range->high))
    throw InputError("the range is empty", where, "give the smaller number first");
}

}  // namespace

void requireValid(const PictureOptions& options) {
  requireRange(options.grainRange, "--grain-range");
  requireRange(options.solidRange, "--solid-range");
  static const std::set<std::string> axes{"", "x", "y", "z", "none"}, lines{"none", "contacts", "bonds"};
  if (!axes.contains(options.cutAxis) || !std::isfinite(options.cutAt))
    throw InputError("'" + options.cutAxis + "' is no axis", "--cut", "give x, y or z, and the place in metres");
  if (!lines.contains(options.lines))
    throw InputError("there are no lines of '" + options.lines + "'", "--lines", "give none, contacts or bonds");
  for (const int length : {options.width, options.height == 0 ? 150 : options.height})
    if (length < 150 || length > 8000)
      throw InputError("the size is not possible", "--size", "give 150 to 8000 pixels");
  if (!(std::abs(options.azimuth.value_or(0.0)) <= 360.0 && std::abs(options.elevation.value_or(0.0)) <= 90.0))
    throw InputError("nobody looks from there", "--azimuth, --elevation", "give -360 to 360 and -90 to 90 degrees");
  if (!(options.warp >= 0.0 && std::isfinite(options.warp)))
    throw InputError("displacements cannot be drawn so many times as large", "--warp", "give 0 or a positive number");
}

}  // namespace dovetail::scene
