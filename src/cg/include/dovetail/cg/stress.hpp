// Coarse-grained stress of particles: contact forces along their branches, plus the velocity fluctuations.
//
// With these definitions the balance of the particles' continuum holds at every point and for every width
// (Goldhirsch 2010; Weinhart et al. 2012):
//
//     ∂t(ρv) + ∇·(ρ v⊗v) = ∇·σ + ρg + t_b,    σ = contactStress + kineticStress,
//
// with t_b = −boundaryForceDensity = Σ f W(x − x_c), the force density of the walls *on the particles*.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "dovetail/cg/fields.hpp"
#include "dovetail/cg/kernel.hpp"

namespace dovetail::cg {

/// Contacts as the stress needs them; the three spans have the same length.
/// Between particles: from = x_i, to = x_j, force on i. At a wall: from = x_i, to = contact point, force on i.
/// A non-central contact is given as two branches that meet at the contact point.
struct BranchView {
  std::span<const Vec3> from, to;  ///< m
  std::span<const Vec3> force;     ///< on the body at `from`; its reaction is at `to`, N
};

/// σ_c(x) = −Σ f ⊗ l ∫₀¹ W(x − from + s l) ds, l = from − to (closed-form line integral), N/m^(d−1) per m, that is Pa
/// in 3-D. Positive in tension; (row, column) = (component of force, direction of the face normal).
/// @throws InputError for an invalid kernel or spans that do not match
std::vector<Eigen::Matrix3d> contactStress(const Kernel& kernel, std::span<const Vec3> points,
                                           const BranchView& branches);

/// σ_k(x) = −Σ m v'⊗v' W(x − x_α), v' = v_α − v(x), v = j/ρ at the same point. Pa in 3-D; never tensile.
/// @throws InputError for an invalid kernel or spans that do not match
std::vector<Eigen::Matrix3d> kineticStress(const Kernel& kernel, std::span<const Vec3> points,
                                           const ParticleView& particles);

}  // namespace dovetail::cg
