// Motions by functions of a program's own, in the place of the expressions of a scene.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dovetail/scene/build.hpp"

namespace dovetail::scene {

/// Of a rigid whole, by functions of the run's time, s. Each is called a few times a step, by one thread.
struct OwnPath {
  std::function<Vec3(double)> displacement{};  ///< m, of which counts what it changes from now on
  std::function<Vec3(double)> velocity{};      ///< m/s; this, a displacement or neither
  std::function<double(double)> rate{};        ///< rad/s, about `axis`; it may be empty
  Vec3 axis{};                                 ///< of any length
  std::optional<Vec3> point{};                 ///< on the axis, m; not given: that of the wall
};

/// Gives a wall of a started run another motion from where it is now, in place of its path or servo.
/// @param wall  its name or number, as in a scene
/// @throws InputError if there is no such wall, for a displacement beside a velocity, an axis without a length, and
///         turns out of a period; nothing has changed then
void moveWall(Built& built, const Scene& scene, const std::string& wall, const OwnPath& path);

/// Drives grains of a started run, all members of a clump or none, from where they are now. Those that spin keep
/// `spin`, rad/s, or turn with the whole. @param ids  Particles::id
/// @throws InputError for grains that are not there or driven already, a spin beside a turn, a spin of grains that do
///         not spin, turns in periodic space or without a point, and as moveWall; nothing has changed then
void driveGrains(Built& built, const std::vector<std::int64_t>& ids, const OwnPath& path,
                 const std::function<Vec3(double)>& spin);

}  // namespace dovetail::scene
