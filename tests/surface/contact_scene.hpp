// Grains with friction on a solid of any cells, stepped by verbs of both models with the connector between them.
#pragma once

#include <memory>
#include <vector>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/motion/motion.hpp"
#include "dovetail/surface/surface_contact.hpp"
#include "scenes.hpp"

namespace dovetail::surface {

using RollingLaw = dem::ContactLaw<dem::LinearSpringDashpot, dem::TangentialSpring, dem::RollingAndTwisting>;

inline std::shared_ptr<const dem::ContactLaws> rollingLaws(double restitution = 1.0, double friction = 0.4) {
  RollingLaw law;
  law.normal = {2e4, restitution};
  law.tangential = {.stiffness = 1.5e4, .friction = friction};
  law.rolling = {{.friction = 0.1, .stiffnessRatio = 0.2}, {.friction = 0.1, .stiffnessRatio = 0.1}};
  return dem::makeContactLaws(law);
}

/// A free block 0.6 × 0.6 × 0.2 m, top at z = 0.
inline fem::SolidMesh softBlock(fem::ElementShape shape, std::array<int, 3> cells = {3, 3, 1}) {
  return fem::boxOf(shape, cells, {0, 0, -0.2}, {0.6, 0.6, 0});
}

/// Grains that fall on the top at a slant, spinning.
inline dem::Particles slantingGrains(int count, unsigned seed) {
  Random random(seed);
  dem::Particles particles;
  for (int k = 0; k < count; ++k) {
    const double radius = random(0.025, 0.035);
    dem::addParticle(particles, {0.07 + 0.09 * (k % 6), 0.08 + 0.1 * (k / 6 % 6), 0.002 + radius * (1 + 2 * (k / 36))},
                     {random(-0.3, 0.3), random(-0.3, 0.3), random(-0.5, -0.2)}, radius, dem::Density{1500.0});
  }
  dem::switchOnRotation(particles);
  for (Vec3& omega : particles.omega) omega = random.vector(5.0);
  return particles;
}

/// Explicit, forces of both at every step.
class ContactScene {
public:
  ContactScene(const fem::SolidMesh& mesh, dem::Particles particles, std::shared_ptr<const dem::ContactLaws> laws,
               const Variant& variant = {"local"}) {
    solid = fem::makeModel(mesh);
    solid.add(fem::makeSolid(mesh, fem::pointMaterial(fem::Material(fem::StVenantKirchhoff{1e6, 0.3, 1000.0}))));
    fem::addMass(solid);
    motion = std::make_unique<fem::Motion>(solid);
    side.name = "block";
    side.model = &solid;
    side.mass = &motion->mass();
    side.load = coupling::NodalLoad(mesh.X.size());
    grains.particles = std::move(particles);
    grains.laws = laws;
    grains.pairs.setSkin(0.01);
    contact = &grains.terms.add(SurfaceContact(side, makeSeam(mesh, variant), laws, "contacts"));
  }
  ContactScene(const ContactScene&) = delete;

  void start(double dt) {
    side.load.clear();
    dem::findForces(grains);
    motion->forces(dt, true);
  }
  void step(double dt) {
    kick(0.5 * dt);
    dem::move(grains, dt);
    motion->drift(dt);
    dem::updateNeighbourList(grains);
    side.load.clear();
    dem::addForces(grains);
    strainEnergy = motion->forces(dt, true);
    dem::close(grains);
    kick(0.5 * dt);
  }

  /// What is stored and what was lost, J: constant.
  double ledger() const { return dem::energies(grains).balance() + fem::kineticEnergy(solid.nodes) + strainEnergy; }
  dem::Momenta momenta() const {
    dem::Momenta sums = dem::momenta(grains);
    sums.linear += fem::momentum(solid.nodes);
    sums.angular += fem::angularMomentum(solid.nodes);
    return sums;
  }

  dem::Model grains;
  fem::Model solid;
  std::unique_ptr<fem::Motion> motion;
  coupling::SolidSide side;
  SurfaceContact* contact = nullptr;
  double strainEnergy = 0.0;

private:
  void kick(double dt) {
    motion->kick(dt);
    for (int node : side.load.touched) solid.nodes.v[node] += (dt / solid.nodes.mass[node]) * side.load.force[node];
  }
};

}  // namespace dovetail::surface
