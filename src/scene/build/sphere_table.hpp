// Spheres from tables.
#pragma once

#include <string>
#include <vector>

#include "dovetail/scene/grains.hpp"

namespace dovetail::scene {

struct SphereOfTable : MovingSphere {
  std::size_t line = 0;  ///< of the file, from 1
};

/// See SphereFile. @throws InputError for columns that are unknown or lack, and as io::readCsv
std::vector<SphereOfTable> spheresOfTable(const std::string& file);

}  // namespace dovetail::scene
