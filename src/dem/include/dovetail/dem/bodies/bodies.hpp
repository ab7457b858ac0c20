// Rigid bodies: their state, and the verbs of their time step.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "dovetail/core/quaternion.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/bodies/mass_properties.hpp"
#include "dovetail/geometry/hierarchical_grid.hpp"

namespace dovetail::dem {

/// Rigid bodies as a structure of arrays, one entry per body each.
///
/// The rotation's state is the angular momentum, which no free motion changes; the angular velocity follows from it and
/// the orientation.
struct Bodies {
  std::vector<Vec3> x;                  ///< centres of mass, m
  std::vector<Vec3> v;                  ///< their velocities, m/s
  std::vector<Vec3> f;                  ///< forces, N
  std::vector<double> mass;             ///< kg
  std::vector<Vec3> inertia;            ///< principal moments, kg m²
  std::vector<Quaternion> orientation;  ///< turns the principal frame into space
  std::vector<Quaternion> turnedFrom;   ///< orientations before the last drift
  std::vector<Vec3> angularMomentum;    ///< about the centre of mass, in space, kg m²/s
  std::vector<Vec3> torque;             ///< about the centre of mass, in space, N m

  std::size_t size() const { return x.size(); }
};

/// Appends a body, turned by `turn` about its centre of mass from how its mass properties were described, with the
/// centre at x. Returns its number.
/// @param turn of any length but 0: it is made a unit quaternion @param v m/s @param omega rad/s, in space
/// @throws InputError naming the body and the field if a value is not finite, mass or a principal moment not > 0, one
/// of
///   these larger than the sum of the others, or a quaternion of length 0
int addBody(Bodies& bodies, const MassProperties& properties, const Vec3& x, const Quaternion& turn = {},
            const Vec3& v = {}, const Vec3& omega = {});

/// Checks lengths and values of all arrays.
/// @throws InputError naming the body and the field, an orientation that is no unit quaternion among them
void validate(const Bodies& bodies);
/// @param when for instance "t = 0.5 s, step 100"
/// @throws NumericalError naming the first body and what of it is NaN or Inf: position, velocity, orientation, angular
///         momentum, force or torque
void requireFinite(const Bodies& bodies, const std::string& when);

/// rad/s, in space.
Vec3 angularVelocity(const Bodies& bodies, int body);
void setAngularVelocity(Bodies& bodies, int body, const Vec3& omega);

/// Forces and torques to zero.
void clearForces(Bodies& bodies);
/// f += m g, g in m/s².
void applyGravity(Bodies& bodies, const Vec3& g);

/// v += f/m dt, angular momentum += torque dt.
void kickBodies(Bodies& bodies, double dt);

/// x += v dt, and the free rotation: the splitting into turns about the principal axes of Dullweber, Leimkuhler &
/// McLachlan (J. Chem. Phys. 107, 1997), symmetric. Together with kickBodies as in velocity Verlet it is of second
/// order, reversible in time and symplectic: the energy of a free body oscillates without drift, its angular momentum
/// does not change at all, and orientations stay unit quaternions to round-off.
void driftBodies(Bodies& bodies, double dt);

/// f −= rate · m v, torque −= rate · L: the viscous bath of applyViscousDamping, once for every body. Returns its
/// power, W. @param rate 1/s @throws InputError unless rate is finite and ≥ 0
double applyViscousDamping(Bodies& bodies, double rate);
/// Local damping as that of particles (applyLocalDamping), on the components in space. Returns its power, W.
/// @throws InputError unless 0 ≤ α < 1
double applyLocalDamping(Bodies& bodies, double alpha);

/// Moves centres by whole periods into the periodic box. Returns the sum of mass times move, kg m.
Vec3 wrapPositions(Bodies& bodies, const geometry::Periodicity& space);

/// Takes bodies out of all arrays; the others keep their order. @param newNumber one per body, −1 = gone, ascending
void renumber(Bodies& bodies, std::span<const int> newNumber);

/// ½ Σ m v² + ½ Σ ω·L, J.
double kineticEnergy(const Bodies& bodies);
/// Σ m v, kg m/s.
Vec3 momentum(const Bodies& bodies);
/// Σ m x × v + Σ L about the origin, kg m²/s.
Vec3 angularMomentum(const Bodies& bodies);

}  // namespace dovetail::dem
