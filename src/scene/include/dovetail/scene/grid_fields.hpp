// Continuum fields of a saved run.
#pragma once

#include <array>
#include <filesystem>
#include <iosfwd>
#include <optional>

#include "dovetail/cg/kernel.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::scene {

struct GridOptions {
  cg::KernelShape shape = cg::KernelShape::lucy;
  std::optional<double> width{};       ///< of the kernel, m; not given: 1.5 mean diameters
  bool advisesWidth = false;           ///< takes and prints the width on which the fields depend least
  std::optional<double> spacing{};     ///< of the points, m; not given: half the width
  std::optional<geometry::Box> box{};  ///< m; not given: around all centres
  std::optional<int> profile{};        ///< axis 0, 1, 2: means over the layers across it, with standard errors
  std::filesystem::path file{};        ///< .vti; of profiles .csv
};

/// Builds the scene of a run, goes to its last checkpoint and writes cg::sample of its grains as a VTI file: density
/// (kg/m³), solid_fraction, momentum (kg/(m² s)), velocity (m/s), stress (Pa, nine, > 0 in tension) and its parts
/// contact_stress and kinetic_stress, pressure (Pa), temperature (m²/s²), wall_force (N/m³). With `profile` a CSV file
/// of the means of layers (inspect/field_profile.hpp) in its place.
/// @throws InputError if there is no run, no checkpoint or no grain, for more than 1e7 points, in builds without VTK,
///   and as cg::sample
void writeGridFields(const std::filesystem::path& folder, const GridOptions& settings, std::ostream& log);

}  // namespace dovetail::scene
