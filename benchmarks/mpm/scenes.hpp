// What the cases are made of.
#pragma once

#include <functional>
#include <memory>

#include "dovetail/fem/laws/point_field.hpp"
#include "dovetail/mpm/point_solid.hpp"

namespace dovetail::benchmark {

inline constexpr double density = 1000.0;  // kg/m³

/// Points in the plane, half of their distance off the faces of a box, 1 m thick.
mpm::MaterialPoints box(const Vec3& low, double width, double height, double distance);

const char* nameOf(mpm::Transfer transfer);

std::shared_ptr<fem::PointField> neoHookeanField(double youngs, double poisson);

/// Accelerations of points, m/s², at time t, s: an acceleration that follows points through the grid. Its work is
/// booked.
using PointAcceleration = std::function<Vec3(std::size_t point, const Vec3& x, double t)>;
std::shared_ptr<fem::Term> push(std::shared_ptr<const mpm::PointSolid> points, PointAcceleration acceleration);

/// Seconds of the processor.
double seconds();

}  // namespace dovetail::benchmark
