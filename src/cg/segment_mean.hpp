// The mean of a kernel's profile along a segment.
#pragma once

#include "dovetail/cg/kernel.hpp"

namespace dovetail::cg {

/// ∫₀¹ profile(|from + s (to − from)| / width) ds: Kernel::segmentMean over the kernel's peak. No checks.
double profileMean(KernelShape shape, double width, const Vec3& from, const Vec3& to);

}  // namespace dovetail::cg
