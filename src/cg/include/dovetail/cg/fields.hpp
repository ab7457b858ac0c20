// Continuum fields of particles at points: density, momentum, velocity, stress, granular temperature.
//
// With these definitions the balances of mass and momentum of the particles' continuum hold at every point, at every
// instant and for every width (Goldhirsch, Granul. Matter 12, 2010; next to walls Weinhart, Thornton, Luding &
// Bokhove, Granul. Matter 14, 2012):
//
//     ∂t ρ + ∇·j = 0,    ∂t j + ∇·(ρ v⊗v) = ∇·σ + ρ g + t,    σ = contactStress + kineticStress,
//
// t being the force density of the walls on the particles (wallForce).
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "dovetail/cg/kernel.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::cg {

/// Particles as the fields need them; the spans have the same length.
struct ParticleView {
  std::span<const Vec3> x;              ///< centres, m
  std::span<const Vec3> v;              ///< velocities, m/s
  std::span<const double> mass;         ///< kg, ≥ 0; of a particle that another model shares, this model's part
  std::span<const double> volume = {};  ///< m³, of the same part; empty: no solid fraction is wanted
};

/// Contacts and bonds as the stress needs them; the three spans have the same length.
/// Between particles: from = x_i, to = x_j (its image next to x_i), force on i. At a wall: from = x_i, to = contact
/// point, force on i. A non-central contact may be given as two branches that meet at the contact point.
struct BranchView {
  std::span<const Vec3> from, to;  ///< m
  std::span<const Vec3> force;     ///< on the body at `from`; its reaction is at `to`, N
};

/// Where walls push; the two spans have the same length. Their contacts are among the branches as well.
struct WallForceView {
  std::span<const Vec3> point;  ///< contact point on the wall, m
  std::span<const Vec3> force;  ///< of the wall on the particle, N
};

/// One instant of a run. What is left empty adds nothing.
struct SnapshotView {
  ParticleView particles = {};
  BranchView branches = {};
  WallForceView walls = {};
  /// Periodic space: every image counts, wherever particles and points are.
  geometry::Periodicity space = {};
};

/// The view of what holds these arrays by these names, such as a dem::Snapshot. @param s must outlive the view
template <class Snapshot>
SnapshotView viewOf(const Snapshot& s) {
  return {{s.x, s.v, s.mass, s.volume}, {s.from, s.to, s.force}, {s.wallPoint, s.wallForce}, s.space};
}

/// Fields at a list of points, one entry per point each; d = dimension of the kernel. Stresses are positive in tension;
/// (row, column) = (component of force, direction of the face normal). Where no particle is within the width, all but
/// contactStress and wallForce are zero.
struct Fields {
  std::vector<double> density;                 ///< ρ = Σ m W(x − x_i), kg/m^d
  std::vector<double> solidFraction;           ///< φ = Σ V W, 1 for d = 3; empty if no volumes were given
  std::vector<Vec3> momentum;                  ///< j = Σ m v W, kg/(m^(d−1) s)
  std::vector<Vec3> velocity;                  ///< v = j/ρ, m/s
  std::vector<double> temperature;             ///< T = Σ m |v′|² W/(3ρ), m²/s²: −⅓ tr kineticStress/ρ
  std::vector<Eigen::Matrix3d> kineticStress;  ///< −Σ m v′⊗v′ W, v′ = v_i − v(x), Pa for d = 3; never tensile
  /// −Σ f⊗l ∫₀¹ W(x − from + s l) ds, l = from − to, by the closed form of the line integral, Pa for d = 3.
  std::vector<Eigen::Matrix3d> contactStress;
  std::vector<Vec3> wallForce;  ///< t = Σ f W(x − point), of the walls on the particles, N/m^d

  std::size_t size() const { return density.size(); }
  /// σ of a point, Pa for d = 3.
  Eigen::Matrix3d stress(std::size_t p) const { return contactStress[p] + kineticStress[p]; }
};

/// Fields at points, by a grid over what is near: O(items + points × items in reach), bitwise the same for any number
/// of threads.
///
/// Distances are Euclidean over all three coordinates. For a 1- or 2-D kernel give points and positions that differ
/// only in the directions it is normalised on (drop the others to zero).
/// @param points m; far from all particles they get zeros
/// @throws InputError for an invalid kernel or one of more than 32 periods, spans that do not match, or naming what is
///         not finite or a mass or volume below zero
Fields sample(const Kernel& kernel, std::span<const Vec3> points, const SnapshotView& snapshot);

/// Points of a regular grid, x fastest: point (i, j, k) has number i + count[0] (j + count[1] k).
struct Grid {
  Vec3 lower;                ///< first point, m
  Vec3 spacing;              ///< m; unused (any value) in a direction with one point
  std::array<int, 3> count;  ///< points per direction, ≥ 1
};
/// @throws InputError if a count is below 1 or a spacing that is used is not > 0
std::vector<Vec3> gridPoints(const Grid& grid);

/// Fields averaged over time. Velocity is mean momentum over mean density; the kinetic stress and the temperature are
/// those of all frames about it, so slow motion of the whole counts as fluctuation and the balances above hold for the
/// means, in steady flow without their rates.
struct TimeMean {
  Fields mean;
  double time = 0.0;  ///< s, that the frames stand for
};

/// @param duration s, that the frame stands for
/// @throws InputError unless the duration is finite and > 0 and frames have the same fields at as many points
void addFrame(TimeMean& mean, const Fields& frame, double duration);

}  // namespace dovetail::cg
