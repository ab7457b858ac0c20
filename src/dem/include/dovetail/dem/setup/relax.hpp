// Relaxation of a model.
#pragma once

#include <cstdint>
#include <functional>

#include "dovetail/core/rest.hpp"
#include "dovetail/dem/model/model.hpp"

namespace dovetail::dem {

/// Parameters of FIRE.
struct RelaxationOptions {
  double stepFraction = 0.6;                   ///< of the critical step, which is computed anew now and then; in (0, 1)
  std::int64_t lookEvery = 20;                 ///< steps between two checks of the contacts
  std::function<bool(const Model&)> enough{};  ///< called at every check: whether to stop here, at rest or not
};

/// The residual is the mean force on a particle or body over the mean contact force; rattlers and driven particles left
/// out. A body's torque counts as the force that exerts it at the surface of the sphere of the same mass and mean
/// moment of inertia. Where a servo's load is further from being carried, relative to it, that counts.
struct RelaxationReport : RestReport {
  std::int64_t rattlers = 0;  ///< particles and bodies without contacts and forces
};

/// Relaxes the model under its present forces: gravity, contacts with their friction, bonds, walls at rest. By FIRE
/// (Bitzek et al., Phys. Rev. Lett. 97, 2006): velocities are mixed with the direction of the forces, and set to zero
/// when their power is negative; the energy that this takes is booked as damping. Contact springs evolve as in any
/// other step, so friction carries load. Afterwards velocities are zero, and time has advanced by the steps taken.
/// Bodies move and turn as a whole, free walls among them; walls with a servo move until they carry its load. Driven
/// particles are held where they are, and go on along their path afterwards.
/// @throws InputError if a setting is not valid, or walls, their surfaces or driven particles move; NumericalError as
///   advance
RelaxationReport relax(Model& m, const RestCriterion& rest = {}, const RelaxationOptions& settings = {});

/// ½ Σ m v² + ½ Σ ω·L of particles, bodies and walls with a servo, J.
double kineticEnergy(const Model& m);
/// Sets the velocities and spins of all these to zero.
void stop(Model& m);
/// Contacts of pairs and walls forget how they moved in the last step: to be called when velocities were changed by
/// other than forces, which dashpots would take for acceleration.
void forgetVelocities(Model& m);

/// Mean force on a particle over the mean contact force, and the rattlers, of the present model, whose forces must have
/// been found. Contacts with walls count. Infinite where there are forces and no contacts.
RelaxationReport restOf(const Model& m);

/// Of the walls with a servo: the largest unbalanced force over its load or contact force, 0 without such walls.
double unbalancedLoads(const Model& m);

}  // namespace dovetail::dem
