#include "dovetail/dem/walls/facet_spin.hpp"

#include <cmath>

namespace dovetail::dem {

FacetSpin::FacetSpin(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 e1 = b - a, e2 = c - a, areaNormal = cross(e1, e2);
  const double squared = squaredNorm(areaNormal);
  if (!(squared > 0.0)) return;
  normal_ = areaNormal / std::sqrt(squared);
  slope1_ = cross(e2, areaNormal) / squared;
  slope2_ = cross(areaNormal, e1) / squared;
}

Vec3 FacetSpin::operator()(const Vec3& va, const Vec3& vb, const Vec3& vc) const {
  const Vec3 d1 = vb - va, d2 = vc - va;
  const Vec3 tilting = dot(d1, normal_) * cross(slope1_, normal_) + dot(d2, normal_) * cross(slope2_, normal_);
  return tilting + 0.5 * dot(normal_, cross(slope1_, d1) + cross(slope2_, d2)) * normal_;
}

std::array<Vec3, 3> FacetSpin::forces(const Vec3& couple) const {
  const auto at = [&](const Vec3& slope) {
    return dot(couple, cross(slope, normal_)) * normal_ + 0.5 * dot(couple, normal_) * cross(normal_, slope);
  };
  const Vec3 fb = at(slope1_), fc = at(slope2_);
  return {-(fb + fc), fb, fc};
}

}  // namespace dovetail::dem
