// Integrals of 1, x and x ⊗ x over a body.
#pragma once

#include <Eigen/Core>

#include "dovetail/dem/bodies/mass_properties.hpp"

namespace dovetail::dem {

struct VolumeMoments {
  double volume = 0.0;                               ///< m³
  Eigen::Vector3d first = Eigen::Vector3d::Zero();   ///< ∫ x dV, m⁴
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();  ///< ∫ x xᵀ dV, m⁵
};

/// @throws InputError if the density is not finite and > 0
MassProperties massProperties(const VolumeMoments& moments, const Vec3& origin, Density density);

/// Of the union of spheres, about the origin of their centres.
VolumeMoments unionMoments(std::span<const Vec3> centre, std::span<const double> radius);

}  // namespace dovetail::dem
