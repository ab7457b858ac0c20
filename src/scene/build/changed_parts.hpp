// What changes of stages do to the description of walls and supports.
#pragma once

#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

bool movesAnew(const WallChange& change);
WallMotion motionIn(const WallChange& change);
/// The supports of a solid after a change.
void change(std::vector<SupportNow>& supports, const SupportChange& change, double since,
            const std::shared_ptr<const std::vector<Vec3>>& from);

}  // namespace dovetail::scene
