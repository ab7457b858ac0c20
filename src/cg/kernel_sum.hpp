// A sum of kernels about contact points.
#pragma once

#include "dovetail/cg/fields.hpp"

namespace dovetail::cg {

/// sum[p] += sign Σ f W(points[p] − point), images included. Points and contacts are taken as checked.
void addKernels(const Kernel& kernel, std::span<const Vec3> points, const WallForceView& at,
                const geometry::Periodicity& space, double sign, std::span<Vec3> sum);

}  // namespace dovetail::cg
