// Sand that softens, under pressure from the start.
#pragma once

#include <memory>
#include <optional>

#include "dovetail/core/vec3.hpp"
#include "dovetail/fem/laws/point_field.hpp"

namespace dovetail::benchmark {

/// Drucker–Prager: E = 50 MPa, ν = 0.3, √(½ s:s) + η p ≤ k, no dilatancy, k from 47 kPa to 20 kPa. Points begin at
/// 100 kPa all round.
struct SoftSand {
  double softening = 60e3;  ///< Pa, by which k falls per shear strain
  double friction = 0.3;    ///< η
  /// 10 % weaker there, with a radius of 0.1 m.
  std::optional<Vec3> weakSpot{{0.0, 0.5, 0.0}};
};

std::shared_ptr<fem::PointField> softSand(const SoftSand& settings);

/// Pa.
constexpr double allRoundPressure = 1e5, sandShearModulus = 50e6 / 2.6;

}  // namespace dovetail::benchmark
