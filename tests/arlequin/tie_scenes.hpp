// A small explicit run of particles, a solid and an overlap, and scenes for it.
#pragma once

#include <memory>

#include "dovetail/arlequin/overlap_tie.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "scenes.hpp"

namespace dovetail::arlequin::test {

/// kick · drift · forces · kick of both models.
struct TieRun {
  dem::Model grains;
  std::unique_ptr<fem::Model> solid;
  std::unique_ptr<fem::Motion> motion;
  coupling::SolidSide side;
  OverlapTie* tie = nullptr;
  std::vector<Vec3> own, acceleration;
  double strain = 0.0, supportWork = 0.0;
  Vec3 supportImpulse;
  double openStep = 0.0;

  void couple(const fem::SolidMesh& mesh, const std::vector<double>& weight, const CouplingOptions& options,
              double massShare = 0.0) {
    fem::addMass(*solid);
    motion = std::make_unique<fem::Motion>(*solid, massShare);
    side = {"solid", solid.get(), &motion->mass(), coupling::NodalLoad(mesh.X.size()), {}};
    auto made = makeOverlapTie(grains, mesh, weight, side, options);
    tie = made.get();
    grains.terms.add(std::unique_ptr<dem::Term>(std::move(made)));
  }

  void solidForces() {
    side.load.clear();
    strain = motion->forces(0.0, true);
    for (std::size_t n = 0; n < solid->nodes.f.size(); ++n) solid->nodes.f[n] += solid->nodes.mass[n] * grains.gravity;
    own = solid->nodes.f;
    side.own = own;
  }
  void accelerate() {
    acceleration = own;
    for (const int n : side.load.touched) acceleration[static_cast<std::size_t>(n)] += side.load.force[n];
    solid->nodes.f = acceleration;
    motion->accelerate(acceleration);
  }
  void kick(double dt) {
    motion->kick(acceleration, dt);
    supportImpulse += dt * motion->supportForce(acceleration, solid->nodes.f);
  }
  void start() {
    solidForces();
    dem::findForces(grains);
    accelerate();
  }
  void step(double dt) {
    dem::move(grains, dt);
    kick(0.5 * dt);
    motion->drift(dt);
    solidForces();
    dem::renew(grains);
    dem::addForces(grains);
    accelerate();
    dem::close(grains);
    kick(0.5 * dt);
  }
  double energy() const {
    double gravity = 0.0;
    for (std::size_t n = 0; n < solid->nodes.X.size(); ++n)
      gravity -= solid->nodes.mass[n] * dot(grains.gravity, solid->nodes.X[n] + solid->nodes.u[n]);
    return dem::energies(grains).balance() + motion->kineticEnergy() + strain + gravity + tie->stored() + tie->lost();
  }
  /// What entered and left taken into account.
  Vec3 momentum() const {
    return dem::momenta(grains).linear + fem::momentum(solid->nodes) + grains.left.momentum - grains.entered.momentum -
           supportImpulse;
  }
  Vec3 angularMomentum() const { return dem::momenta(grains).angular + fem::angularMomentum(solid->nodes); }
  double mass() const {
    double sum = grains.left.mass - grains.entered.mass;
    for (std::size_t i = 0; i < grains.particles.size(); ++i)
      sum += grains.particles.weightOf(i) * grains.particles.mass[i];
    for (const double m : solid->nodes.mass) sum += m;
    return sum;
  }
};

/// The bar of makeBar, in cells of any shape.
inline TieRun tieBar(const SceneOptions& o, fem::CellShape shape = fem::CellShape::hex8) {
  const double half = 0.5 * o.across * edge, d = edge / o.particlesPerEdge;
  TieRun run;
  run.grains.particles = lattice({-half, 0.0, -half}, {half, particleEnd(o), half}, o.particlesPerEdge);
  run.grains.pairs.setSkin(0.1 * d);
  dem::ElasticLaw law;
  law.normal.stiffness = modulus * d;
  law.normal.bonded = true;
  run.grains.laws = dem::makeContactLaws(law);
  run.grains.sortEvery = 0;
  dem::findPairs(run.grains.particles, run.grains.pairs);
  const fem::SolidMesh mesh = fem::boxOf(shape, {o.across, o.solidElements, o.across}, {-half, solidStart(o), -half},
                                         {half, solidStart(o) + o.solidElements * edge, half});
  std::vector<double> weight = barWeights(mesh, o);
  levelMidNodes(mesh, weight);
  run.solid = std::make_unique<fem::Model>(fem::makeModel(mesh));
  if (o.holdEnd) fem::fix(run.solid->nodes, fem::nodeSet(mesh, "y+"));
  const fem::StVenantKirchhoff law3{modulus, 0.0, bulk};
  run.solid->add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(law3)), {.share = solidWeights(weight)}));
  run.couple(mesh, weight, o.coupling, o.massShare);
  return run;
}

}  // namespace dovetail::arlequin::test
