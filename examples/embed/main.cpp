// A net of masses and springs, with a solver of its own, is hit by four particles of Dovetail. Nothing holds the net,
// so the momentum and the energy of both together must stay as they are.
#include <array>
#include <iostream>
#include <vector>

#include "dovetail/core/ledger.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"
#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/surface/surface_coupler.hpp"

using dovetail::Vec3;
namespace dem = dovetail::dem;
namespace fem = dovetail::fem;
namespace surface = dovetail::surface;

/// Our own solver: point masses, springs between them, an explicit step.
struct Net {
  double nodeMass = 0.01, stiffness = 400.0;  // kg, N/m
  std::vector<Vec3> X, u, v, f;
  std::vector<std::array<int, 2>> springs;
  std::vector<fem::Face> faces;  // the openings of the net, counter-clockwise from above

  Net(int n, double width) : u(n * n), v(n * n), f(n * n) {
    for (int k = 0; k < n * n; ++k) X.push_back(width / (n - 1) * Vec3{double(k % n), double(k / n), 0.0});
    for (int k = 0; k + 1 < n * n; ++k) {
      const bool right = k % n + 1 < n, back = k / n + 1 < n;
      if (right) springs.push_back({k, k + 1});
      if (back) springs.push_back({k, k + n});
      if (right && back) faces.push_back({fem::FaceShape::quad4, {k, k + 1, k + n + 1, k + n}});
    }
  }
  double addSpringForces() {  // gives their energy, J
    double energy = 0.0;
    for (const auto& [i, j] : springs) {
      const Vec3 d = X[j] + u[j] - X[i] - u[i];
      const double stretch = norm(d) - norm(X[j] - X[i]);
      f[i] += stiffness * stretch * normalized(d);
      f[j] -= stiffness * stretch * normalized(d);
      energy += 0.5 * stiffness * stretch * stretch;
    }
    return energy;
  }
  void kick(double dt) {
    for (std::size_t k = 0; k < v.size(); ++k) v[k] += dt / nodeMass * f[k];
  }
  void drift(double dt) {
    for (std::size_t k = 0; k < u.size(); ++k) u[k] += dt * v[k];
  }
};

int main() {
  Net net(11, 1.0);
  dem::Particles particles;
  for (int k = 0; k < 4; ++k)
    dem::addParticle(particles, {0.3 + 0.4 * (k % 2), 0.33 + 0.38 * (k / 2), 0.1}, {0.1, 0.0, -1.0 - 0.2 * k},
                     0.05 + 0.01 * k, dem::Density{150.0});
  const auto laws = dem::makeContactLaws(dem::ElasticLaw{{.stiffness = 2000.0}});
  surface::SurfaceCoupler seam(surface::makeSkin(net.X, net.faces));  // the net's nodes and openings become a skin

  dovetail::EnergyLedger ledger;
  const auto kinetic = ledger.addStored("kinetic"), strain = ledger.addStored("springs of the net"),
             contact = ledger.addStored("contacts");
  const auto findForces = [&](double dt) {
    dem::clearForces(particles);
    ledger.set(contact, seam.exchange(particles, net.u, net.v, *laws, dt).storedEnergy());
    net.f = seam.load().force;
    ledger.set(strain, net.addSpringForces());
  };
  const auto sumMomentum = [&] {
    Vec3 momentum = dem::momentum(particles);
    double energy = dem::kineticEnergy(particles);
    for (const Vec3& v : net.v) momentum += net.nodeMass * v;
    for (const Vec3& v : net.v) energy += 0.5 * net.nodeMass * dot(v, v);
    ledger.set(kinetic, energy);
    return momentum;
  };

  const double dt = 5e-5;
  findForces(dt);
  const Vec3 momentumAtStart = sumMomentum();
  ledger.open();
  Vec3 momentum;
  for (int step = 0; step < 8000; ++step) {
    dem::kick(particles, 0.5 * dt);
    net.kick(0.5 * dt);
    dem::drift(particles, dt);
    net.drift(dt);
    findForces(dt);
    dem::kick(particles, 0.5 * dt);
    net.kick(0.5 * dt);
    momentum = sumMomentum();
    ledger.close();
  }

  const double momentumLost = norm(momentum - momentumAtStart) / norm(momentumAtStart);
  const double energyLost = ledger.largestResidual() / ledger.storedAtOpening();
  std::cout << ledger << "momentum lost: " << momentumLost << " of it\nenergy lost:   " << energyLost << " of it\n";
  const bool hit = ledger.channels()[strain].joules > 0.01;
  const bool balanced = hit && momentumLost < 1e-13 && energyLost < 1e-5;
  std::cout << (balanced ? "balanced\n" : "NOT balanced\n");
  return balanced ? 0 : 1;
}
