// Continuum fields of a saved run.
#pragma once

#include <array>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/cg/fields.hpp"
#include "dovetail/geometry/box.hpp"

namespace dovetail::dem {
struct Model;
}

namespace dovetail::scene {

struct GridOptions {
  cg::KernelShape shape = cg::KernelShape::lucy;
  std::optional<double> width{};              ///< of the kernel, m; not given: 1.5 mean diameters
  bool advisesWidth = false;                  ///< takes and prints the width on which the fields depend least
  std::optional<double> spacing{};            ///< of the points, m; not given: half the width
  std::optional<geometry::Box> box{};         ///< m; not given: around all centres
  std::optional<std::vector<Vec3>> points{};  ///< m, in the place of a grid
  std::optional<int> profile{};               ///< axis 0, 1, 2: means over the layers across it, with standard errors
  std::filesystem::path file{};               ///< .vti; of profiles .csv
};

/// Fields of grains at one instant.
struct SampledFields {
  double time = 0.0;  ///< s
  cg::Kernel kernel;
  cg::Grid grid{};  ///< without meaning where points are given
  std::vector<Vec3> points{};
  cg::Fields fields{};
};
/// Of grains as they are now. @param log  for the advice on the width
/// @throws InputError if there is no grain, for no point or more than 1e7, and as cg::sample and dem::takeSnapshot
SampledFields sampleFields(const dem::Model& grains, const GridOptions& settings, std::ostream& log);
/// Of the last checkpoint of a run. @throws InputError also if there is no run and no checkpoint
SampledFields sampleFields(const std::filesystem::path& folder, const GridOptions& settings, std::ostream& log);

struct Scene;
/// @throws InputError where a solid of material points meets grains as spheres, which are no grains
void requireGrainsAlone(const Scene& scene, const std::string& where);

/// A field under the name that files give it, one row of components after the other.
struct NamedField {
  std::string name;
  std::vector<double> values;
  int components = 1;
};
/// Density (kg/m³), solid_fraction, momentum (kg/(m² s)), velocity (m/s), stress (Pa, nine, > 0 in tension) and its
/// parts contact_stress and kinetic_stress, pressure (Pa), temperature (m²/s²), wall_force (N/m³).
std::vector<NamedField> namedFields(const cg::Fields& fields);

/// Builds the scene of a run, goes to its last checkpoint and writes namedFields of its grains as a VTI file. With
/// `profile` a CSV file of the means of layers (inspect/field_profile.hpp) in its place.
/// @throws InputError as sampleFields, and in builds without VTK
void writeGridFields(const std::filesystem::path& folder, const GridOptions& settings, std::ostream& log);

}  // namespace dovetail::scene
