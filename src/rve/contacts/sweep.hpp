// The sweep over the contacts of a cell.
#pragma once

#include <Eigen/Core>

#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

/// What the cell did as a whole in the last dt, on top of which the grains have v and spin.
struct MeanMotion {
  Eigen::Matrix3d rate = Eigen::Matrix3d::Zero();      ///< of strain, 1/s, symmetric, in the directions of the end
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< all of it, which springs take part in
};

/// Forces, torques and Σ f ⊗ b of the grains as they lie; springs of contacts turn and stretch by the motion of the
/// last dt.
void sweep(Rve& cell, double dt, const MeanMotion& motion = {});

/// @throws NumericalError naming a grain whose force is not finite
void requireFiniteForces(const Rve& cell);

template <bool slides, bool rolls>
void sweepDiscs(Rve& cell, double dt, const MeanMotion& motion);
template <bool slides, bool elastic>
void sweepSpheres(Rve& cell, double dt, const MeanMotion& motion);

/// What a contact's image is away by, m, by Contacts::image.
inline std::array<Vec3, 27> imageShifts(const geometry::Lattice& lattice) {
  std::array<Vec3, 27> shift;
  for (int code = 0; code < 27; ++code)
    shift[static_cast<std::size_t>(code)] = lattice.shift({code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1});
  return shift;
}

}  // namespace dovetail::rve
