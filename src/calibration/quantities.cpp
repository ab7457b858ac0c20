#include "quantities.hpp"

#include <map>

#include "dovetail/core/error.hpp"

namespace dovetail::calibration {

namespace {

namespace unit = scene::unit;
using Units = std::map<std::string, scene::Dimension>;

const Units& unitsOf(const ModuliProbe&) {
  static const Units units{
      {"density", unit::density},       {"solid_fraction", unit::none},    {"pressure", unit::pressure},
      {"bulk_modulus", unit::pressure}, {"shear_modulus", unit::pressure}, {"youngs_modulus", unit::pressure},
      {"poisson_ratio", unit::none},    {"anisotropy", unit::none},        {"nonlinearity", unit::none},
      {"p_wave_speed", unit::velocity}, {"s_wave_speed", unit::velocity}};
  return units;
}
const Units& unitsOf(const TriaxialProbe&) {
  static const Units units{{"strain", unit::none},
                           {"volumetric_strain", unit::none},
                           {"axial_pressure", unit::pressure},
                           {"lateral_pressure", unit::pressure},
                           {"deviator", unit::pressure},
                           {"stress_ratio", unit::none},
                           {"friction_angle", unit::angle},
                           {"peak_friction_angle", unit::angle},
                           {"peak_strain", unit::none},
                           {"residual_friction_angle", unit::angle},
                           {"dilatancy_angle", unit::angle},
                           {"density", unit::density}};
  return units;
}

/// By the end of a column's name.
std::optional<scene::Dimension> unitOfColumn(const std::string& name) {
  static const Units units{{"_m", unit::length}, {"_s", unit::time},  {"_m_per_s", unit::velocity}, {"_J", {2, 1, -2}},
                           {"_N", {1, 1, -2}},   {"_Ns", {1, 1, -1}}, {"_Pa", unit::pressure}};
  std::optional<scene::Dimension> found;
  std::size_t longest = 0;
  for (const auto& [ending, dimension] : units)
    if (name.ends_with(ending) && ending.size() > longest) {
      found = dimension;
      longest = ending.size();
    }
  return found;
}

}  // namespace

std::optional<scene::Dimension> dimensionOf(const Experiment& experiment, const std::string& quantity,
                                            const std::string& where) {
  const auto known = [&](const Units& units) -> std::optional<scene::Dimension> {
    if (const auto found = units.find(quantity); found != units.end()) return found->second;
    std::string names;
    for (const auto& [name, dimension] : units) names += (names.empty() ? "" : ", ") + name;
    throw InputError("the experiment \"" + experiment.name + "\" has no quantity \"" + quantity + "\"", where,
                     "write one of " + names);
  };
  if (const auto* const moduli = std::get_if<ModuliProbe>(&experiment.probe)) return known(unitsOf(*moduli));
  if (const auto* const triaxial = std::get_if<TriaxialProbe>(&experiment.probe)) return known(unitsOf(*triaxial));
  return unitOfColumn(quantity);
}

}  // namespace dovetail::calibration
