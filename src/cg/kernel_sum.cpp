#include "kernel_sum.hpp"

#include "dovetail/core/parallel.hpp"
#include "near_items.hpp"

namespace dovetail::cg {

void addKernels(const Kernel& kernel, std::span<const Vec3> points, const WallForceView& at,
                const geometry::Periodicity& space, double sign, std::span<Vec3> sum) {
  const double peak = kernel.peak();
  const NearItems near(kernel, at.point, {}, space);
  parallelFor(points.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      near.forEach(points[p], [&](std::size_t c, const Vec3& place) {
        sum[p] += sign * peak * profile(kernel.shape, norm(place - at.point[c]) / kernel.width) * at.force[c];
      });
  });
}

}  // namespace dovetail::cg
