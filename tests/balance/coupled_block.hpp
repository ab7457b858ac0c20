// A small block of bricks on which particles bounce, and its books.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "dovetail/core/ledger.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/surface/coupling.hpp"
#include "dovetail/surface/stepper.hpp"

namespace dovetail::surface {

/// Average acceleration, lumped masses.
inline fem::ImplicitOptions newmarkLumped() {
  return {.scheme = fem::newmark(), .massShare = 0.0, .relativeTolerance = 1e-10, .energyEvery = 0};
}

struct BlockSetup {
  bool held = true;            ///< at the bottom
  double youngsModulus = 1e6;  ///< Pa
  double restitution = 1.0;
  double width = 0.0;      ///< of the kernel, m
  bool spread = false;     ///< the paper's transfer
  bool booksWork = false;  ///< of the contacts on the skin
  Vec3 gravity{0.0, 0.0, -9.81};
};

/// 0.3 × 0.3 × 0.2 m, top at z = 0; the limit of its mesh is 2.3 ms, a contact lasts about 20 ms.
inline fem::SolidMesh blockMesh() { return fem::boxOf(fem::CellShape::hex8, {3, 3, 2}, {0, 0, -0.2}, {0.3, 0.3, 0}); }

inline dem::Particles droppedParticles() {
  dem::Particles particles;
  dem::addParticle(particles, {0.06, 0.07, 0.043}, {0.05, 0.02, -0.3}, 0.04, dem::Mass{0.5});
  dem::addParticle(particles, {0.19, 0.13, 0.042}, {-0.02, 0.05, -0.2}, 0.04, dem::Mass{0.7});
  dem::addParticle(particles, {0.21, 0.24, 0.031}, {0.0, -0.05, -0.25}, 0.03, dem::Mass{0.3});
  return particles;
}

inline Skin blockSkin(const fem::SolidMesh& mesh, double width) {
  Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  coarseGrain(skin, {{cg::KernelShape::lucy, 2, width}, cg::KernelCorrection::none});
  return skin;
}

inline CoupledModel makeModel(const BlockSetup& setup, const fem::SolidMesh& mesh, Coupling seam,
                              dem::Particles particles) {
  const dem::LinearSpringDashpot normal{2e4, setup.restitution, true};
  const auto laws = dem::makeContactLaws(dem::ElasticLaw{normal});
  CoupledModel model{.discrete = {},
                     .wallLaw = laws,
                     .solid = std::make_unique<fem::Model>(fem::makeModel(mesh)),
                     .seam = std::move(seam),
                     .contact = {}};
  model.discrete.particles = std::move(particles);
  model.discrete.laws = laws;
  model.discrete.gravity = setup.gravity;
  model.discrete.pairs.setSkin(0.02);
  model.discrete.sortEvery = 0;
  const fem::StVenantKirchhoff law{setup.youngsModulus, 0.3, 1000.0};
  model.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law))));
  fem::addMass(*model.solid);
  if (setup.held) fem::fix(model.solid->nodes, mesh.nodeSets.at("z-"));
  return model;
}

inline CoupledModel flatModel(const BlockSetup& setup) {
  const fem::SolidMesh mesh = blockMesh();
  const auto faces = mesh.faceSets.at("skin");
  Coupling seam(blockSkin(mesh, setup.spread ? 0.0 : setup.width));
  if (setup.spread)
    seam.spreadLoad(SpreadLoad({{cg::KernelShape::lucy, 2, setup.width}, {}}, mesh.X, seam.skin(), faces));
  seam.bookWallWork(setup.booksWork);
  return makeModel(setup, mesh, std::move(seam), droppedParticles());
}

inline CoupledModel smoothModel(const BlockSetup& setup) {
  const fem::SolidMesh mesh = blockMesh();
  Coupling seam(makeSmoothSurface(blockSkin(mesh, setup.width)));
  seam.bookWallWork(setup.booksWork);
  return makeModel(setup, mesh, std::move(seam), droppedParticles());
}

/// Stored energy, J.
template <class Model>
double storedEnergy(const Model& model) {
  double height = 0.0;
  for (std::size_t i = 0; i < model.discrete.particles.size(); ++i)
    height -= model.discrete.particles.mass[i] * dot(model.discrete.gravity, model.discrete.particles.x[i]);
  return dem::kineticEnergy(model.discrete.particles) + model.contact.storedEnergy() + height +
         fem::kineticEnergy(model.solid->nodes) + model.strainEnergy;
}

struct Result {
  double initial = 0.0, worstDrift = 0.0, worstResidual = 0.0;  ///< J
  double dissipated = 0.0, made = 0.0;                          ///< J
  double largestStrainEnergy = 0.0;                             ///< J
  int withoutContact = 0, steps = 0;
};

/// Steps a model for `time`; window(model) makes one window of K dt and returns its sums.
template <class Model, class Window>
Result runFor(Model& model, double time, double dt, int K, Window&& window) {
  Profile profile;
  start(model, dt, profile);
  Result result;
  result.initial = storedEnergy(model);
  const auto windows = std::llround(time / (K * dt));
  for (long w = 0; w < windows; ++w) {
    const WindowSums sums = window(model, profile);
    result.dissipated += sums.dissipated;
    result.made += sums.madeByCoupling;
    result.withoutContact += sums.stepsWithoutContact;
    result.steps += K;
    const double drift = storedEnergy(model) - result.initial;
    result.worstDrift = std::max(result.worstDrift, std::abs(drift));
    result.worstResidual = std::max(result.worstResidual, std::abs(drift + result.dissipated - result.made));
    result.largestStrainEnergy = std::max(result.largestStrainEnergy, model.strainEnergy);
  }
  return result;
}

template <class Model>
Result runExplicit(Model model, double time, double dt, int K, const Scheme& scheme = {}) {
  return runFor(model, time, dt, K,
                [&](Model& m, Profile& profile) { return stepExplicit(m, dt, K, scheme, true, profile); });
}

template <class Model>
Result runImplicit(Model model, double time, double dt, int K, const Scheme& scheme = {}) {
  fem::ImplicitMotion solid(*model.solid, newmarkLumped());
  return runFor(model, time, dt, K,
                [&](Model& m, Profile& profile) { return stepImplicit(m, solid, dt, K, scheme, true, profile); });
}

template <class Model>
Result runStaggered(Model model, double time, double dt, int K, bool implicitSolid, const Scheme& scheme = {}) {
  std::unique_ptr<fem::ImplicitMotion> solid;
  if (implicitSolid) solid = std::make_unique<fem::ImplicitMotion>(*model.solid, newmarkLumped());
  return runFor(model, time, dt, K, [&](Model& m, Profile& profile) {
    return stepStaggered(m, solid.get(), dt, K, scheme, true, profile);
  });
}

inline double observedOrder(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace dovetail::surface
