// Whether grains can come to a part of a scene.
#pragma once

#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// Whether no grain, of those there are and those that enter, lies near a solid or comes there, as far as motions and
/// weight tell; false where that is not known.
bool isOutOfReach(const Built& built, const Scene& scene, std::size_t solid);
/// The same of a box.
bool isBeyondReach(const Built& built, const Scene& scene, const geometry::Box& box);

}  // namespace dovetail::scene
