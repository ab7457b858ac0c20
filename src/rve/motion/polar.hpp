// A deformation as a turn after a stretch.
#pragma once

#include <Eigen/Core>

namespace dovetail::rve {

/// G = turn · stretch, the stretch symmetric and positive definite.
struct Polar {
  Eigen::Matrix3d turn, stretch;
};

/// @param G  det G > 0. One that leaves z alone is decomposed in the plane, and leaves z alone to the last digit
Polar polar(const Eigen::Matrix3d& G);

/// Whether z stays as it is: what discs may do.
bool isPlane(const Eigen::Matrix3d& G);

}  // namespace dovetail::rve
