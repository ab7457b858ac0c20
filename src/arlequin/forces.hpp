// The verbs of a coupled step.
#pragma once

#include "dovetail/arlequin/stepper.hpp"

namespace dovetail::arlequin::detail {

/// v += a dt on the components that are free.
void kickSolid(Solid& solid, std::span<const Vec3> acceleration, double dt);
/// Impulse of the supports over dt.
Vec3 supportImpulse(const Solid& solid, std::span<const Vec3> acceleration, std::span<const Vec3> force, double dt);

/// What drives have done so far: work, J, and impulse on the particles, kg m/s.
struct Driven {
  double work;
  Vec3 impulse;
};
Driven driven(const Model& model);
/// Adds what drives have done since `before`.
void bookDrives(const Model& model, const Driven& before, StepSums& sums);

/// Gives the contacts of a new list their weights.
void weighNewContacts(Model& model);
/// Contacts and gravity → particles.f.
void particleForces(Model& model, double dt, StepSums& sums, Profile& profile);
/// Elastic forces and gravity → solid.internalForce.
void internalForces(Model& model, bool withEnergy, Profile& profile);

/// gap += the gap of the displacements in the last step.
void advanceGap(Model& model, double dt, std::span<const Vec3> particleMotion, std::span<const Vec3> nodeMotion);
/// λ from the state; forces on particles.f and coupling.nodeForce.
/// @param solidForce  N, without the coupling: for multipliers
void couplingForces(Model& model, double dt, std::span<const Vec3> solidForce, Profile& profile);
/// −½ (λ_before + λ)·Δgap of the last step.
double couplingWorkOfStep(const Coupling& coupling);

}  // namespace dovetail::arlequin::detail
