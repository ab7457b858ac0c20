// Reads frames from their files, to compare them and to list their contents.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::io {

struct FrameArray {
  std::string name;
  bool perCell = false;
  int components = 1;
  std::vector<double> values;  ///< side by side; whole numbers beyond 2⁵³ are rounded
};

struct FrameContent {
  std::string kind;                     ///< "VTU", "VTP" or "VTI"
  std::optional<double> time;           ///< "TimeValue", s
  std::vector<std::string> provenance;  ///< "key: value"
  std::size_t cells = 0;
  std::vector<int> cellType;           ///< by the numbers of VTK; none of a VTI file
  std::vector<std::size_t> cellEnd;    ///< where the points of a cell end in `cellPoint`
  std::vector<std::size_t> cellPoint;  ///< numbers of points, in the order of VTK
  std::vector<Vec3> position;          ///< of the points, m
  std::vector<FrameArray> arrays;

  /// Null if there is none.
  const FrameArray* find(const std::string& name, bool perCell) const;
};

/// A file ending in .vtu, .vtp or .vti. @throws InputError if it is none, or damaged
FrameContent readFrame(const std::filesystem::path& path);

/// Times, s, and files of a PVD series, in its order; of all parts.
/// @throws InputError if it is none
std::vector<std::pair<double, std::filesystem::path>> readPvd(const std::filesystem::path& path);

}  // namespace dovetail::io
