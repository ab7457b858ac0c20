// How the impacts of a scene go at a step, and how deep.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "dovetail/scene/build.hpp"
#include "warnings.hpp"

namespace dovetail::scene {

/// Speed after over speed before of a head-on impact, as the steps make it and as the law says.
struct Rebound {
  double found = 1.0, right = 1.0;
  double error() const { return std::abs(found - right); }
};
/// What the error of a low restitution may be.
inline constexpr double reboundTolerance = 0.03;

/// Of laws with a restitution below a half: the impact of the smallest grains whose rebound is farthest from the law's,
/// wherever within a step they touch first.
Rebound worstRebound(const Built& built, const Scene& scene, double dt);

/// Grains that have been seen in contacts deeper than half the smaller radius.
struct DeepGrains {
  std::vector<std::int64_t> ids;  ///< ascending
  double overlap = 0.0;           ///< the deepest, over the smaller radius
  std::int64_t worst = -1;        ///< its grain
  double time = 0.0;              ///< s
};
/// Looks at all contacts as they are; costs about the twentieth part of a step.
void lookForDeepGrains(const dem::Model& m, DeepGrains& deep);
/// "3 grains were seen …"; empty if there were none
std::string lineOf(const DeepGrains& deep);

/// Springs that are too soft for the speeds or the weight of a scene.
void lookAtSoftness(const Built& built, const Scene& scene, Lines& lines);

}  // namespace dovetail::scene
