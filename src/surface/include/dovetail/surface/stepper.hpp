// Time steps of particles and a solid coupled through a surface.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "dovetail/core/profile.hpp"
#include "dovetail/core/vec3.hpp"
#include "dovetail/coupling/nodal_load.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/laws/contact_work.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/fem/motion/implicit_motion.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "dovetail/surface/coupling.hpp"

namespace dovetail::surface {

/// Particles, a solid and their seam.
struct CoupledModel {
  dem::Model discrete;                              ///< particles with laws and gravity, no terms of its own: see start
  std::shared_ptr<const dem::ContactLaws> wallLaw;  ///< between particles and skin
  /// hex8 of one elastic law that the hand-written kernels know, see start; nodes.f holds the internal forces of the
  /// last FEM step.
  std::unique_ptr<fem::Model> solid;
  Coupling seam;

  std::optional<fem::Motion> motion{};  ///< of the solid, lumped masses; made by start
  double strainEnergy = 0.0;            ///< J, at the end of the last window that asked for it
  dem::ContactWork contact;             ///< of the last force evaluation
  coupling::NodalLoad loadBefore{};     ///< staggered steps only: the load of the evaluation before the last
};

/// What a window did, to be booked.
struct WindowSums {
  double dissipated = 0.0;      ///< J, dashpots and friction, trapezoidal
  double madeByCoupling = 0.0;  ///< J, work of the loads on the nodes minus work of the contacts on the skin; 0 for an
                                ///< adjoint pair at the same instant
  int stepsWithoutContact = 0;  ///< of the DEM steps
};

/// @throws InputError naming what of the solid a coupling through a surface cannot take yet: other elements than one
///         solid of hex8 with an elastic law of the hand-written kernels, loads, contact, constraints
void requireCoupledSolid(const fem::Model& solid);

/// v += f/m dt on the touched nodes; held components stay.
void kickTouched(const coupling::NodalLoad& load, fem::Nodes& nodes, double dt);
/// The same for an implicit solid: by its mass matrix where that couples nodes.
void kickTouched(const coupling::NodalLoad& load, fem::ImplicitMotion& solid, double dt);
/// Σ f · du over the touched nodes, J.
double workOf(const coupling::NodalLoad& load, std::span<const Vec3> displacement, double scale);

/// What the impulses of a window of K > 1 DEM steps store, J: the leading term that does not vanish at rest of the
/// energy that the multiple-time-step scheme conserves in place of the exact one,
///   −h² Σ_i [ g_s·g_c / 12 + g_s·g_s / 24 ] / m_i,   h = K dt,
/// with g_s and g_c the gradients of strain and contact energy at node i. (From the Baker–Campbell–Hausdorff series of
/// half kick · fast steps · half kick; the term in the velocities, h² v·V''v / 12, is left out.) A state function: it
/// comes back when the load goes. Elastic forces are those in nodes.f.
double splittingEnergy(const fem::Nodes& nodes, const coupling::NodalLoad& contact, double h);

/// The places at which the schemes differ.
struct Scheme {
  bool booksCoupling = false;  ///< the pair is not adjoint, or not at the same instant
  bool skinLags = false;       ///< staggered: the particles see the skin as it was before the solid's step
};

namespace detail {

/// Forces on the particles and load on the nodes at the present positions, dt after the last ones; dt = 0: no time has
/// passed for the particles.
template <class Model>
void evaluateContacts(Model& model, std::span<const Vec3> u, std::span<const Vec3> v, double dt, WindowSums& sums,
                      Profile& profile) {
  const double lostBefore = model.contact.lostPower();
  {
    Profile::Stage stage(profile, "particle contacts");
    if (dt > 0.0) {
      dem::renew(model.discrete);
      dem::addForces(model.discrete);
    } else {
      dem::findForces(model.discrete);
    }
    model.contact = model.discrete.work;
  }
  Profile::Stage stage(profile, "surface contacts");
  model.contact += model.seam.exchange(model.discrete.particles, u, v, *model.wallLaw, dt);
  sums.dissipated += 0.5 * dt * (lostBefore + model.contact.lostPower());
  sums.stepsWithoutContact += model.seam.inContact() ? 0 : 1;
}

template <class Model>
double wallWork(const Model& model) {
  if constexpr (requires { model.seam.wallWork(); })
    return model.seam.wallWork();
  else
    return 0.0;
}

}  // namespace detail

/// Forces at the start; call once before the first window.
/// @throws InputError if the particles' model sorts, lets in or loses particles, or has terms of its own (walls,
/// bonds):
///         the seam could not follow
template <class Model>
void start(Model& model, double dt, Profile&) {
  dem::requirePlain(model.discrete, "surface coupling");
  requireCoupledSolid(*model.solid);
  model.motion.emplace(*model.solid);
  model.strainEnergy = model.motion->forces(dt, true);
  dem::findForces(model.discrete);
  model.contact = model.discrete.work;
  model.contact +=
      model.seam.exchange(model.discrete.particles, model.solid->nodes.u, model.solid->nodes.v, *model.wallLaw, dt);
  model.loadBefore = model.seam.load();
}

/// One window of K DEM steps and one explicit FEM step, all forces at the same instant (impulse multiple-time-step
/// velocity Verlet; Tuckerman, Berne & Martyna, J. Chem. Phys. 97, 1992): the elastic forces kick the nodes at the
/// ends of the window, the contacts kick nodes and particles at every DEM step. Symplectic for every K, so the pair
/// creates no energy; K dt must stay below the limit of the mesh, and away from half the period of the contacts.
template <class Model>
WindowSums stepExplicit(Model& model, double dt, int K, const Scheme& scheme, bool withEnergy, Profile& profile) {
  WindowSums sums;
  const double before = detail::wallWork(model);
  fem::Nodes& nodes = model.solid->nodes;
  {
    Profile::Stage stage(profile, "solid kick and drift");
    model.motion->kick(0.5 * K * dt);
  }
  for (int k = 0; k < K; ++k) {
    {
      Profile::Stage stage(profile, "solid kick and drift");
      dem::move(model.discrete, dt);
      kickTouched(model.seam.load(), nodes, 0.5 * dt);
      model.motion->drift(dt);
    }
    if (scheme.booksCoupling) sums.madeByCoupling += workOf(model.seam.load(), nodes.v, 0.5 * dt);
    detail::evaluateContacts(model, nodes.u, nodes.v, dt, sums, profile);
    if (scheme.booksCoupling) sums.madeByCoupling += workOf(model.seam.load(), nodes.v, 0.5 * dt);
    dem::close(model.discrete);
    kickTouched(model.seam.load(), nodes, 0.5 * dt);
  }
  {
    Profile::Stage stage(profile, "solid internal forces");
    const double energy = model.motion->forces(K * dt, withEnergy);
    if (withEnergy) model.strainEnergy = energy;
  }
  Profile::Stage stage(profile, "solid kick and drift");
  model.motion->kick(0.5 * K * dt);
  if (scheme.booksCoupling) sums.madeByCoupling -= detail::wallWork(model) - before;
  return sums;
}

namespace detail {

/// Particles and contacts for `steps` DEM steps on a skin that stands still; the nodes only gather momentum.
template <class Model>
void holdSkinAndStep(Model& model, fem::ImplicitMotion& solid, double dt, int steps, WindowSums& sums,
                     Profile& profile) {
  for (int k = 0; k < steps; ++k) {
    dem::move(model.discrete, dt);
    kickTouched(model.seam.load(), solid, 0.5 * dt);
    evaluateContacts(model, model.solid->nodes.u, model.solid->nodes.v, dt, sums, profile);
    dem::close(model.discrete);
    kickTouched(model.seam.load(), solid, 0.5 * dt);
  }
}

}  // namespace detail

/// One window of K DEM steps and one implicit FEM step of K dt, all forces at the same instant (Strang splitting):
/// ⌊K/2⌋ DEM steps on the standing skin · solid moves freely · ⌊K/2⌋ DEM steps on the standing skin. For odd
/// K the solid moves inside the middle DEM step, together with the particles' drift and between the halves of its kick.
/// The window is symmetric in time for every K, so the energy error is second order. Even K needs one more contact
/// evaluation, in which no DEM time passes: laws with history refuse it, they need odd K.
template <class Model>
WindowSums stepImplicit(Model& model, fem::ImplicitMotion& solid, double dt, int K, const Scheme& scheme,
                        bool withEnergy, Profile& profile) {
  WindowSums sums;
  const double before = detail::wallWork(model);
  fem::Nodes& nodes = model.solid->nodes;
  const bool insideStep = K % 2 == 1;
  detail::holdSkinAndStep(model, solid, dt, K / 2, sums, profile);
  if (insideStep) {
    dem::move(model.discrete, dt);
    kickTouched(model.seam.load(), solid, 0.5 * dt);
  }
  std::vector<Vec3> moved;
  if (scheme.booksCoupling) moved = nodes.u;
  {
    Profile::Stage stage(profile, "solid implicit step");
    solid.step(K * dt);
  }
  if (scheme.booksCoupling) {
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = nodes.u[i] - moved[i];
    sums.madeByCoupling += workOf(model.seam.load(), moved, 0.5);
  }
  detail::evaluateContacts(model, nodes.u, nodes.v, insideStep ? dt : 0.0, sums, profile);
  if (scheme.booksCoupling) sums.madeByCoupling += workOf(model.seam.load(), moved, 0.5);
  if (insideStep) {
    dem::close(model.discrete);
    kickTouched(model.seam.load(), solid, 0.5 * dt);
  } else {
    sums.stepsWithoutContact -= model.seam.inContact() ? 0 : 1;  // no DEM step of its own
  }
  detail::holdSkinAndStep(model, solid, dt, K / 2, sums, profile);
  if (withEnergy) model.strainEnergy = fem::storedEnergy(*model.solid, {model.solid->t, dt});
  if (scheme.booksCoupling) sums.madeByCoupling -= detail::wallWork(model) - before;
  return sums;
}

namespace detail {

/// The solid's equation of motion at the end of a step holds with the load of the last contact evaluation, that at its
/// start with the load of the evaluation before: over the step this is the mean of the two, one step late.
template <class Model>
coupling::NodalLoad laggingLoad(const Model& model) {
  coupling::NodalLoad load(model.solid->nodes.X.size());
  for (const coupling::NodalLoad* part : {&model.loadBefore, &model.seam.load()})
    for (int node : part->touched) load.add(node, 0.5 * part->force[node]);
  return load;
}

template <class Model>
void stepSolid(Model& model, fem::ImplicitMotion* implicit, const coupling::NodalLoad& load, double dt) {
  if (implicit) {
    kickTouched(load, *implicit, 0.5 * dt);
    implicit->step(dt);
    kickTouched(load, *implicit, 0.5 * dt);
    return;
  }
  model.motion->kick(0.5 * dt);
  kickTouched(load, model.solid->nodes, 0.5 * dt);
  model.motion->drift(dt);
  model.motion->forces(dt);
  model.motion->kick(0.5 * dt);
  kickTouched(load, model.solid->nodes, 0.5 * dt);
}

}  // namespace detail

/// The staggered window (paper, Fig. 8): the solid makes its step under a load one step old (detail::laggingLoad), then
/// the particles make K steps on the skin that moves from its old to its new place, or stays at the old one
/// (Scheme::skinLags). A load that lags gives energy to a solid that gives way as a mass, and takes it from one that
/// gives way as a spring; what it makes, first order in the step, is returned in madeByCoupling, for which the seam
/// must book its wall work.
/// @param implicit  null: the solid steps explicitly
template <class Model>
WindowSums stepStaggered(Model& model, fem::ImplicitMotion* implicit, double dt, int K, const Scheme& scheme,
                         bool withEnergy, Profile& profile) {
  WindowSums sums;
  const double before = detail::wallWork(model);
  fem::Nodes& nodes = model.solid->nodes;
  const std::vector<Vec3> oldU = nodes.u;
  const coupling::NodalLoad load = detail::laggingLoad(model);
  model.loadBefore = model.seam.load();
  {
    Profile::Stage stage(profile, "solid step, load one step old");
    detail::stepSolid(model, implicit, load, K * dt);
  }
  for (int node : load.touched) sums.madeByCoupling += dot(load.force[node], nodes.u[node] - oldU[node]);
  std::vector<Vec3> skin = oldU;
  for (int k = 0; k < K; ++k) {
    dem::move(model.discrete, dt);
    if (!scheme.skinLags)
      for (std::size_t i = 0; i < skin.size(); ++i)
        skin[i] = oldU[i] + (static_cast<double>(k + 1) / K) * (nodes.u[i] - oldU[i]);
    detail::evaluateContacts(model, skin, nodes.v, dt, sums, profile);
    dem::close(model.discrete);
  }
  if (withEnergy) model.strainEnergy = fem::storedEnergy(*model.solid, {model.solid->t, dt});
  sums.madeByCoupling -= detail::wallWork(model) - before;
  return sums;
}

}  // namespace dovetail::surface
