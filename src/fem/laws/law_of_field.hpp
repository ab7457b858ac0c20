// What a field of points that pointField has made of a law tells of that law.
#pragma once

#include "dovetail/fem/laws/point_field.hpp"

namespace dovetail::fem {

/// The law that pointField made a field of; null for other fields.
const PointMaterial* lawOf(const PointField& field);

}  // namespace dovetail::fem
