// Numbers of a scene that are far from those of any material or machine.
#pragma once

#include "dovetail/scene/scene.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

/// One sentence for each number out of the range of its key, with the unit that is likely meant.
void lookAtNumbers(const Scene& scene, Lines& lines);

}  // namespace dovetail::scene
