// Spheres of files of other codes, as a group of a scene.
#pragma once

#include <string>
#include <vector>

#include "dovetail/dem/model/model.hpp"
#include "dovetail/grain_io/grain_files.hpp"
#include "dovetail/scene/scene.hpp"

namespace dovetail::scene {

/// Where the spheres of an item of `particles` go.
struct GroupTarget {
  dem::Model& grains;
  const Particles& group;
  const Scene& scene;
  std::vector<std::string>& notes;
};

/// Adds those of the wanted type. What the file holds beside them, types that become one group, and a periodic space
/// that the scene does not have are noted, each once.
/// @throws InputError if the type is not there, or if densities are told twice or not at all
void addGrainsOfCode(const GroupTarget& to, const GrainsOfCode& wanted, const grain_io::GrainFile& file);

/// "periodic": {…} as a scene has it.
std::string periodicKey(const geometry::Box& box, const std::array<bool, 3>& axes);

}  // namespace dovetail::scene
