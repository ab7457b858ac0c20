// Continuum fields of particles: density, momentum, velocity, and the loads they put on a boundary.
//
// Distances are Euclidean over all three coordinates. For a 1- or 2-D kernel give points and positions that differ
// only in the directions it is normalised on (drop the others to zero).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dovetail/cg/kernel.hpp"
#include "dovetail/core/vec3.hpp"

namespace dovetail::cg {

/// Particles as the fields need them; the three spans have the same length.
struct ParticleView {
  std::span<const Vec3> x;       ///< centres, m
  std::span<const Vec3> v;       ///< velocities, m/s
  std::span<const double> mass;  ///< kg
};

/// Fields at a list of points; d = dimension of the kernel.
struct Fields {
  std::vector<double> density;  ///< ρ, kg/m^d
  std::vector<Vec3> momentum;   ///< j, kg/(m^(d−1) s)
  std::vector<Vec3> velocity;   ///< v = j/ρ, m/s; zero where no particle is within the width
};

/// ρ = Σ m W(x − x_α), j = Σ m v W, v = j/ρ (Cheng et al. 2023, Eqs. 8 and 11).
/// @throws InputError for an invalid kernel or spans that do not match
Fields particleFields(const Kernel& kernel, std::span<const Vec3> points, const ParticleView& particles);

/// Points of a regular grid, x fastest: point (i, j, k) has number i + count[0] (j + count[1] k).
struct Grid {
  Vec3 lower;                ///< first point, m
  Vec3 spacing;              ///< m; unused (any value) in a direction with one point
  std::array<int, 3> count;  ///< points per direction, ≥ 1
};
/// @throws InputError if a count is below 1 or a spacing that is used is not > 0
std::vector<Vec3> gridPoints(const Grid& grid);

/// Boundary force density on the solid, N/m^d: b(x) = Σ −f W(x − x_c) (Eq. 12).
/// In the balance of the *particles'* continuum it enters with the opposite sign (see stress.hpp).
/// @param contact  contact points x_c on the wall, m   @param force  f, force of the wall on the particle, N
/// @throws InputError for an invalid kernel or spans that do not match
std::vector<Vec3> boundaryForceDensity(const Kernel& kernel, std::span<const Vec3> points,
                                       std::span<const Vec3> contact, std::span<const Vec3> force);

/// Traction on a flat boundary, N/m²: t(x) = Σ −f W(x − x_c) with a kernel normalised on the surface (Eqs. 13 and 14).
/// Its integral over the plane is Σ −f exactly. Near an edge use surfaceKernelRow, which normalises on what is there.
/// @param kernel  dimension 2   @param points  points on the boundary, m
/// @throws InputError if the kernel is invalid or not 2-D, or spans do not match
std::vector<Vec3> surfaceTraction(const Kernel& kernel, std::span<const Vec3> points, std::span<const Vec3> contact,
                                  std::span<const Vec3> force);

/// Adds the *kinetic* traction, the switchable part that Eq. (13) leaves out: t_k(x) = σ_k·n with
/// σ_k = −Σ m v'⊗v' W(x − x_α), v' = v_α − v(x), v = j/ρ: the flux of momentum that the fluctuations carry towards the
/// solid (Weinhart et al. 2012: σ = σ_contact + σ_kinetic). It presses on the solid, like a gas.
///
/// It is a statement about the *continuum* of the particles at x, not a force between bodies: the wall feels the
/// contact forces and nothing else, whose sum over an impact already is that momentum. Adding it to the load of a
/// solid therefore breaks the balance of forces unless the particles are relieved of as much. Leave it out (the
/// default: do not call this) unless the traction is compared with a continuum theory.
/// @param kernel   dimension 3   @param normal  per point: unit normal out of the solid, towards the particles
/// @param traction  per point, N/m², added to
/// @throws InputError if the kernel is invalid or not 3-D, or spans do not match
void addKineticTraction(const Kernel& kernel, std::span<const Vec3> points, std::span<const Vec3> normal,
                        const ParticleView& particles, std::span<Vec3> traction);

}  // namespace dovetail::cg
