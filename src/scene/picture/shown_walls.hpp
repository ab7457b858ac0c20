// Walls of a scene as triangles.
#pragma once

#include <vector>

#include "cell_faces.hpp"
#include "dovetail/scene/scene.hpp"
#include "run_frames.hpp"

namespace dovetail::scene {

/// How walls are drawn: solid where they lie behind the grains, not at all where they would hide them, and meshes,
/// whose two sides are alike, so that one sees through.
struct WallPaints {
  std::uint8_t solid, clear;
};

/// @param box  of everything else: walls end a little beyond it, bodies that grains meet from outside and meshes later
/// @param back  direction to the viewer
std::vector<picture::Triangle> wallsOf(const Scene& scene, const Instant& instant, const geometry::Box& box,
                                       const Vec3& back, const WallPaints& paints);

}  // namespace dovetail::scene
