// A small block of bricks on which particles bounce, and its books.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "dovetail/coupling/run.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/surface/surface_contact.hpp"

namespace dovetail::surface {

using coupling::CoupledRun;
using coupling::Lag;
using coupling::Stepping;

struct BlockSetup {
  Stepping stepping = Stepping::explicitSteps;
  double massFraction = 0.0;
  bool held = true;            ///< at the bottom
  double youngsModulus = 1e6;  ///< Pa
  double restitution = 1.0;
  double width = 0.0;      ///< of the kernel, m
  bool smooth = false;     ///< patches in place of facets
  bool spread = false;     ///< the paper's transfer
  bool booksWork = false;  ///< of the contacts on the skin
  Vec3 gravity{0.0, 0.0, -9.81};
};

/// 0.3 × 0.3 × 0.2 m, top at z = 0; the limit of its mesh is 2.3 ms, a contact lasts about 20 ms.
inline fem::SolidMesh blockMesh(std::array<int, 3> cells = {3, 3, 2}) {
  return fem::boxOf(fem::ElementShape::hex8, cells, {0, 0, -0.2}, {0.3, 0.3, 0});
}

inline dem::Particles droppedParticles() {
  dem::Particles particles;
  dem::addParticle(particles, {0.06, 0.07, 0.043}, {0.05, 0.02, -0.3}, 0.04, dem::Mass{0.5});
  dem::addParticle(particles, {0.19, 0.13, 0.042}, {-0.02, 0.05, -0.2}, 0.04, dem::Mass{0.7});
  dem::addParticle(particles, {0.21, 0.24, 0.031}, {0.0, -0.05, -0.25}, 0.03, dem::Mass{0.3});
  return particles;
}

inline SurfaceCoupler makeSeam(const BlockSetup& setup, const fem::SolidMesh& mesh) {
  const cg::Kernel kernel{cg::KernelShape::lucy, 2, setup.width};
  const auto& faces = mesh.faceSets.at("skin");
  Skin skin = makeSkin(mesh.X, faces);
  if (!setup.spread) coarseGrain(skin, {kernel, cg::KernelCorrection::none});
  SurfaceCoupler seam = setup.smooth ? SurfaceCoupler(makeSmoothSurface(skin)) : SurfaceCoupler(skin);
  if (setup.spread) seam.spreadLoad(SpreadLoad({kernel, {}}, mesh.X, skin, faces));
  seam.bookWallWork(setup.booksWork);
  return seam;
}

inline std::unique_ptr<fem::Model> makeBlock(const BlockSetup& setup, const fem::SolidMesh& mesh) {
  auto block = std::make_unique<fem::Model>(fem::makeModel(mesh));
  const fem::StVenantKirchhoff law{setup.youngsModulus, 0.3, 1000.0};
  block->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law)), {.name = "elements"}));
  if (setup.held) fem::fix(block->nodes, mesh.nodeSets.at("z-"));
  return block;
}

inline std::unique_ptr<CoupledRun> makeRun(const BlockSetup& setup, const fem::SolidMesh& mesh = blockMesh(),
                                           dem::Particles particles = droppedParticles()) {
  auto run = std::make_unique<CoupledRun>();
  const auto laws = dem::makeContactLaws(dem::ElasticLaw{dem::LinearSpringDashpot{2e4, setup.restitution}});
  run->grains.particles = std::move(particles);
  run->grains.laws = laws;
  run->grains.gravity = setup.gravity;
  run->grains.pairs.setSkin(0.02);
  coupling::SolidSide& side = run->addSolid(
      makeBlock(setup, mesh), {.name = "block", .stepping = setup.stepping, .massFraction = setup.massFraction});
  run->grains.terms.add(SurfaceContact(side, makeSeam(setup, mesh), laws, "contacts"));
  return run;
}

inline const SurfaceCoupler& seamOf(const CoupledRun& run) {
  for (const auto& term : run.grains.terms)
    if (const auto* const contact = dynamic_cast<const SurfaceContact*>(term.get())) return contact->coupling();
  throw std::logic_error("there is no seam");
}

struct Result {
  double initial = 0.0, worstDrift = 0.0, worstResidual = 0.0;  ///< J; drift: of the exact energy
  double residualApart = 0.0;                                   ///< J, the worst while nobody touches the block
  double dissipated = 0.0, made = 0.0;                          ///< J
  double largestStrainEnergy = 0.0;                             ///< J
  int withoutContact = 0, macroSteps = 0;
};

/// Macro steps of h = K dt for `time`, looked at one by one.
inline Result runFor(const BlockSetup& setup, double time, double h, int K, Lag lag = Lag::none) {
  const auto run = makeRun(setup);
  run->start(h / K, {.stepsPerMacroStep = K, .lag = lag});
  const auto energy = [&] { return run->ledger().stored() - run->ledger().joules("block: time splitting"); };
  Result result;
  result.initial = energy();
  result.macroSteps = static_cast<int>(std::lround(time / h));
  for (int w = 0; w < result.macroSteps; ++w) {
    run->advance();
    result.worstDrift = std::max(result.worstDrift, std::abs(energy() - result.initial));
    result.largestStrainEnergy = std::max(result.largestStrainEnergy, run->ledger().joules("block: elements"));
    if (seamOf(*run).inContact()) continue;
    ++result.withoutContact;
    result.residualApart = std::max(result.residualApart, std::abs(run->ledger().residual()));
  }
  const EnergyLedger& ledger = run->ledger();
  result.worstResidual = ledger.largestResidual();
  result.dissipated = ledger.joules("particles: dashpots");
  result.made = -ledger.joules("contacts: lost") - ledger.joules("staggering error (minus what it made)");
  return result;
}

}  // namespace dovetail::surface
