// Time steps of particles and a solid that share an overlap volume.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dovetail/arlequin/coupling.hpp"
#include "dovetail/core/profile.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/fem/motion/implicit_motion.hpp"

namespace dovetail::arlequin {

/// All parts but the particles may be absent; an absent part costs nothing.
struct Model {
  /// Particles, masses weighted where there is a coupling; pairs, renewed in a step unless the laws bond them; laws,
  /// drives (dem::DriveTerm), time. Its gravity acts on the solid too, m/s².
  dem::Model discrete;
  std::optional<Solid> solid;
  std::optional<Coupling> coupling;

  std::vector<Vec3> slowForce;       ///< on the particles, N; only with multipliers and windows of several steps
  std::int64_t weighedRevision = 0;  ///< builds of the pair list whose contacts have been weighed
};

/// What steps did, to be booked. Work in J, impulses in kg m/s; sums over the steps since the object was made.
struct StepSums {
  double dissipated = 0.0;    ///< by contacts: dashpots, friction; trapezoidal
  double couplingWork = 0.0;  ///< of the coupling forces on both models together; minus the gain of the stored energy
                              ///< it is what the coupling lost or made
  double absorbed = 0.0;      ///< by the absorber
  double externalWork = 0.0;  ///< of the drive
  double handedOver = 0.0;    ///< left with changes of the weights
  Vec3 supportImpulse;        ///< of held nodes and driven particles
  Vec3 handedMomentum;        ///< left with changes of the weights
};

/// Forces at the start; call once. With multipliers, velocities are made to comply with the constraint.
/// @throws InputError if particles and coupling disagree, or if the particles' model sorts, lets in or loses particles,
/// or
///         has walls, bonds or other terms beside drives: the coupling could not follow
void start(Model& model, double dt, Profile& profile);

/// K steps of velocity Verlet with explicit FEM every K-th (impulse multiple time stepping: elastic forces kick the
/// nodes at the ends of the window; contacts and coupling act at every step, and the nodes drift with the particles).
/// Symplectic for a penalty and for multipliers.
///
/// For K > 1 the energy that the scheme conserves differs from the exact one by, to leading order in h = K dt,
///   h² [ v·V''v/12 − g·M⁻¹g_f/12 − g·M⁻¹g/24 ],
/// V the strain energy, g and g_f the gradients of V and of the energy that acts at every step
/// (Baker–Campbell–Hausdorff series of half kick · fast steps · half kick). It is a state function, kept in
/// solid.splittingEnergy.
void stepExplicit(Model& model, double dt, int K, StepSums& sums, bool withEnergy, Profile& profile);

/// K steps of velocity Verlet of the particles and one implicit step of K dt of the solid; the coupling kicks both at
/// the ends of the window. Multipliers keep the gap's rate at zero at those instants and are reversible; their
/// trapezoidal work is of second order in K dt without trend, and booked.
void stepImplicit(Model& model, fem::ImplicitMotion& solid, double dt, int K, StepSums& sums, bool withEnergy,
                  Profile& profile);

/// What the paper's authors ran: coupling forces from the increments of the last step, frozen; the solid's implicit
/// step; then the particles' step.
void stepStaggered(Model& model, fem::ImplicitMotion& solid, double dt, StepSums& sums, bool withEnergy,
                   Profile& profile);

/// Locates particles anew (see renew) and books what leaves.
void relocate(Model& model, StepSums& sums);

/// Stored energies of a model, J.
struct Energies {
  double kineticParticles = 0.0, elasticContacts = 0.0, kineticSolid = 0.0, elasticSolid = 0.0, coupling = 0.0,
         gravity = 0.0, splitting = 0.0;
  double total() const {
    return kineticParticles + elasticContacts + kineticSolid + elasticSolid + coupling + gravity + splitting;
  }
};
/// At full-step velocities. The solid's strain energy is that of the last step with `withEnergy`.
/// @param solid  if the solid is stepped by it: its mass matrix counts
Energies energies(const Model& model, const fem::ImplicitMotion* solid = nullptr);
/// Weighted momentum of both models, kg m/s.
Vec3 momentum(const Model& model);

/// @throws NumericalError naming the particle or node that is not finite
void requireFinite(const Model& model, const std::string& when);

}  // namespace dovetail::arlequin
