// A lattice of particles hands a wave over to a solver of our own, a net of masses and springs: an overlap with a
// stranger's solid, by a penalty and by multipliers. Momentum and energy of both together must stay as they are.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include "dovetail/arlequin/arlequin_coupling.hpp"
#include "dovetail/arlequin/constraint.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/ledger.hpp"
#include "dovetail/dem/laws/laws.hpp"
#include "dovetail/fem/model/model_mass.hpp"

using namespace dovetail;

constexpr double modulus = 1e8, density = 1500.0, edge = 0.1;  // Pa, kg/m³, m: of the net's cells
constexpr int across = 2, along = 20, overlapping = 6;         // cells

/// Our own solver. Its cells tell Dovetail where its nodes are; their springs and masses, of which it keeps the
/// fraction 1 − w, are its own affair.
struct Net {
  fem::SolidMesh mesh = fem::boxOf(fem::ElementShape::hex8, {across, across, along}, {0, 0, 0},
                                   {across * edge, across* edge, along* edge});
  std::vector<double> w;                   // the particles' fraction at the nodes
  fem::Model host = fem::makeModel(mesh);  // keeps u, v, f and masses
  fem::Nodes& nodes = host.nodes;
  struct Spring {
    std::size_t lower, upper;
    double stiffness;  // N/m, along z
  };
  std::vector<Spring> springs;

  Net() {
    std::vector<double> place;
    for (const Vec3& X : mesh.X) {
      const double s = X.z / (overlapping * edge);
      place.push_back(s > 1.0 + 1e-9 ? arlequin::beyondOverlap : std::min(s, 1.0));
    }
    w = arlequin::nodalWeights(place, {.profile = arlequin::WeightProfile::linear});
    const int layer = (across + 1) * (across + 1);
    const auto part = [&](int k, int n) { return k == 0 || k == n ? 0.5 : 1.0; };
    nodes.mass.assign(mesh.X.size(), 0.0);
    for (int n = 0; n < static_cast<int>(mesh.X.size()); ++n) {
      const auto i = static_cast<std::size_t>(n), above = static_cast<std::size_t>(n + layer);
      const double area = part(n % (across + 1), across) * part(n / (across + 1) % (across + 1), across) * edge * edge;
      nodes.mass[i] = density * area * part(n / layer, along) * edge * (1.0 - w[i]);
      if (above < mesh.X.size()) springs.push_back({i, above, modulus * area / edge * (1.0 - 0.5 * (w[i] + w[above]))});
    }
  }
  double findForces() {  // gives their energy, J
    double energy = 0.0;
    fem::clearForces(nodes);
    for (const auto& [i, j, k] : springs) {
      const double stretch = nodes.u[j].z - nodes.u[i].z;
      nodes.f[i].z += k * stretch;
      nodes.f[j].z -= k * stretch;
      energy += 0.5 * k * stretch * stretch;
    }
    return energy;
  }
};

/// A bonded lattice, four particles to a face of a cell, from below the net up to the end of the overlap; its lowest
/// layer starts with a velocity.
dem::Model makeLattice() {
  const double d = 0.5 * edge;
  dem::Model grains;
  for (int k = -40; k < 2 * overlapping; ++k)
    for (int j = 0; j < 2 * across; ++j)
      for (int i = 0; i < 2 * across; ++i)
        dem::addParticle(grains.particles, d * Vec3{i + 0.5, j + 0.5, k + 0.5}, {0, 0, k < -36 ? 0.1 : 0.0}, 0.5 * d,
                         dem::Mass{density * d * d * d});
  dem::ElasticLaw law;
  law.normal = {.stiffness = modulus * d};
  law.normal.bonded = true;
  grains.laws = dem::makeContactLaws(law);
  grains.pairs.setSkin(0.1 * d);
  return grains;
}

bool handOver(arlequin::ConstraintKind constraint, const char* name) {
  Net net;
  dem::Model grains = makeLattice();
  const fem::DofMap dofs(net.host.constraints, net.nodes);
  const fem::ModelMass mass(net.host, dofs, 0.0);
  coupling::SolidSide side;  // what Dovetail is told of our solver
  side.name = "net";
  side.model = &net.host;
  side.mass = &mass;
  side.load = coupling::NodalLoad(net.nodes.u.size());
  auto& tie = grains.terms.add(arlequin::makeArlequinCoupling(
      grains, net.mesh, net.w, side,
      {.constraint = constraint, .penalty = arlequin::automaticPenalty(modulus, edge), .leastWeight = 1e-3}));

  EnergyLedger ledger;
  const auto ofGrains = ledger.addStored("particles"), ofNet = ledger.addStored("net"),
             ofTie = ledger.addStored("overlap");
  double strain = 0.0;
  const auto kick = [&](double dt) {
    fem::kick(net.nodes, dt);
    for (const int n : side.load.touched)
      net.nodes.v[static_cast<std::size_t>(n)] += dt / net.nodes.mass[n] * side.load.force[static_cast<std::size_t>(n)];
  };
  const auto findForces = [&] {
    side.load.clear();
    strain = net.findForces();
    side.own = net.nodes.f;  // multipliers answer the sum of all forces
  };
  const auto momentum = [&] { return dem::momenta(grains).linear + fem::momentum(net.nodes); };
  const auto book = [&] {
    ledger.set(ofGrains, dem::energies(grains).balance());
    ledger.set(ofNet, fem::kineticEnergy(net.nodes) + strain);
    ledger.set(ofTie, tie.stored() + tie.lost());
  };

  const double dt = 5e-6;
  findForces();
  dem::findForces(grains);
  const Vec3 momentumAtStart = momentum();
  book();
  ledger.open();
  for (int step = 0; step < 2800; ++step) {
    dem::move(grains, dt);
    kick(0.5 * dt);
    fem::drift(net.nodes, dt);
    dem::updateNeighbourList(grains);
    findForces();
    dem::addForces(grains);
    dem::close(grains);
    kick(0.5 * dt);
    book();
    ledger.close();
  }
  const double momentumLost = norm(momentum() - momentumAtStart) / norm(momentumAtStart);
  const double energyLost = ledger.largestResidual() / ledger.storedAtOpening();
  const double arrived = ledger.joules("net") / ledger.storedAtOpening();
  std::cout << name << ": " << 100.0 * arrived << " % of the energy is in the net; lost: momentum " << momentumLost
            << ", energy " << energyLost << '\n';
  return arrived > 0.4 && momentumLost < 1e-12 && energyLost < 1e-2;
}

int main() {
  bool good = handOver(arlequin::ConstraintKind::penalty, "penalty");
  good = handOver(arlequin::ConstraintKind::multiplier, "multipliers") && good;
  std::cout << (good ? "balanced\n" : "NOT balanced\n");
  return good ? 0 : 1;
}
