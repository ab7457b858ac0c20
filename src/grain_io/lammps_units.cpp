#include <algorithm>
#include <array>

#include "dovetail/core/error.hpp"
#include "grain_rows.hpp"

namespace dovetail::grain_io {

namespace {

struct UnitSystem {
  std::string_view name;
  Scale scale;
};
/// In the order of Units, without ofFile. Masses of micro and nano are picograms and attograms.
constexpr std::array<UnitSystem, 5> systems{{{"si", {}},
                                             {"cgs", {1e-2, 1e-3, 1.0}},
                                             {"micro", {1e-6, 1e-15, 1e-6}},
                                             {"nano", {1e-9, 1e-21, 1e-9}},
                                             {"lj", {}}}};

}  // namespace

Scale scaleOf(Units units, std::string_view named, const TextSource& source) {
  const auto isNamed = [&](const UnitSystem& one) { return one.name == named; };
  if (!named.empty() && std::none_of(systems.begin(), systems.end(), isNamed))
    throw InputError("the file is in units " + shown(named), source.name(),
                     "write it with units si, cgs, micro, nano or lj");
  if (units == Units::ofFile) {
    if (named == "lj")
      throw InputError("the file is in units lj, which have no metre, kilogram and second", source.name(),
                       "write \"units\": \"lj\" (convert: --units lj) to take its numbers as these");
    units = Units::si;
    for (std::size_t k = 0; k < systems.size(); ++k)
      if (systems[k].name == named) units = static_cast<Units>(k + 1);
  }
  const UnitSystem& taken = systems[static_cast<std::size_t>(units) - 1];
  if (!named.empty() && taken.name != named)
    throw InputError("the file is in units " + std::string(named) + ", not " + std::string(taken.name), source.name(),
                     "leave out \"units\"");
  return taken.scale;
}

}  // namespace dovetail::grain_io
