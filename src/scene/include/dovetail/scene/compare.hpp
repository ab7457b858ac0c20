// Two runs, or two files of runs, side by side.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace dovetail::scene {

/// The largest difference of one quantity.
struct Difference {
  std::string what;         ///< "series residual_J", "grains velocity"
  double largest = 0.0;     ///< in the quantity's unit; infinite where one of the two is NaN
  double scale = 0.0;       ///< largest magnitude of the quantity in either; of positions, the extent of all points
  std::string where;        ///< of the largest
  double relative() const;  ///< largest over scale; 0 where both are 0
};

struct Comparison {
  std::vector<Difference> differences;  ///< of all quantities that both have
  std::vector<std::string> unlike;      ///< what cannot be compared: one sentence each
  bool within(double tolerance) const;  ///< nothing unlike, and no relative difference beyond it
};

/// Series (CSV, HDF5), frames and series of frames (VTU, VTP, VTI, PVD), states by their bytes; of folders of runs all
/// of these that one of them has. Series of unlike times are compared where both have rows, by interpolation, and
/// energies have one scale, the largest of all; vectors have one for all components. Grains are compared by id,
/// contacts by the ids of their two grains.
/// @throws InputError for what is no file or folder of a run, or of two kinds
Comparison compare(const std::filesystem::path& a, const std::filesystem::path& b);

/// What is unlike, and a table of the largest differences, the largest first.
/// @param rows  at most
void print(const Comparison& comparison, double tolerance, std::size_t rows, std::ostream& out);

}  // namespace dovetail::scene
