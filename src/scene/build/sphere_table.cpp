#include "sphere_table.hpp"

#include <algorithm>
#include <iterator>

#include "dovetail/core/error.hpp"
#include "dovetail/io/csv_table.hpp"
#include "keys/advice.hpp"

namespace dovetail::scene {

namespace {

/// Columns that nobody knows, or that want others, are refused: what they say would be lost.
void requireColumns(const io::TimeSeries& table, const std::string& file) {
  static const std::vector<std::string> needed = {"x_m", "y_m", "z_m", "radius_m"},
                                        velocity = {"vx_m_per_s", "vy_m_per_s", "vz_m_per_s"},
                                        spin = {"wx_rad_per_s", "wy_rad_per_s", "wz_rad_per_s"};
  const std::vector<std::string>& names = table.names();
  const auto has = [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  std::vector<std::string> known = needed;
  for (const auto& three : {velocity, spin}) known.insert(known.end(), three.begin(), three.end());
  std::vector<std::string> missing;
  std::copy_if(known.begin(), known.end(), std::back_inserter(missing), [&](const auto& name) { return !has(name); });
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string near = nearest(name, missing);
      throw InputError("the table has a column \"" + name + "\", which is unknown", file,
                       near.empty()
                           ? "leave it out; spheres have x_m, y_m, z_m, radius_m and, all or none, vx_m_per_s, "
                             "vy_m_per_s, vz_m_per_s, and likewise wx_rad_per_s, wy_rad_per_s, wz_rad_per_s, and a "
                             "density and material from the scene"
                           : "write \"" + near + "\" (values in its unit)");
    }
  for (const std::string& name : needed)
    if (!has(name)) throw InputError("the table has no column \"" + name + "\"", file, "add it");
  for (const auto& three : {velocity, spin}) {
    const auto given = std::find_if(three.begin(), three.end(), has);
    const auto absent = std::find_if_not(three.begin(), three.end(), has);
    if (given != three.end() && absent != three.end())
      throw InputError("the table has a column \"" + *given + "\", but no \"" + *absent + "\"", file,
                       three == spin ? "give all three spins, 0 where there is none"
                                     : "give all three velocities, 0 where there is none");
  }
  if (table.rows() == 0) throw InputError("the table has no rows", file, "give one a sphere, or leave the table out");
}

}  // namespace

std::vector<SphereOfTable> spheresOfTable(const std::string& file) {
  const io::CsvTable read = io::readCsvTable(file);
  const io::TimeSeries& table = read.series;
  requireColumns(table, file);
  const auto x = table.column("x_m"), y = table.column("y_m"), z = table.column("z_m"), r = table.column("radius_m");
  const auto vectorsOf = [&](const std::string& begin, const std::string& unit) {
    const std::vector<std::string>& names = table.names();
    std::vector<Vec3> all(table.rows());
    if (std::find(names.begin(), names.end(), begin + "x" + unit) == names.end()) return all;
    for (int c = 0; c < 3; ++c) {
      const auto column = table.column(begin + "xyz"[c] + unit);
      for (std::size_t i = 0; i < all.size(); ++i) all[i][c] = column[i];
    }
    return all;
  };
  const std::vector<Vec3> velocity = vectorsOf("v", "_m_per_s"), spin = vectorsOf("w", "_rad_per_s");
  std::vector<SphereOfTable> spheres;
  for (std::size_t i = 0; i < table.rows(); ++i)
    spheres.push_back({{{{x[i], y[i], z[i]}, r[i]}, velocity[i], spin[i]}, read.line[i]});
  return spheres;
}

}  // namespace dovetail::scene
