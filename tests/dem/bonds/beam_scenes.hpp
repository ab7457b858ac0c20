// Bonds and scenes that several tests share.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "dovetail/dem/bonds/bonds.hpp"
#include "dovetail/dem/model/contact_step.hpp"
#include "dovetail/dem/particles/damping.hpp"
#include "walls/wall_scenes.hpp"

namespace dovetail::dem {

inline constexpr double pi = std::numbers::pi, infinity = std::numeric_limits<double>::infinity();

inline BondMaterial unbreakable(double youngsModulus = 1e7) {
  BondMaterial material;
  material.youngsModulus = youngsModulus;
  material.poissonRatio = 0.25;
  material.radiusRatio = 0.8;
  material.tensileStrength = material.shearStrength = infinity;
  return material;
}

struct Bonded {
  Particles particles;
  Bonds bonds;
  geometry::Periodicity space;
};

/// The stable step with bonds alone, s.
inline double bondStep(const Particles& particles, const Bonds& bonds) {
  ContactDemand demand;
  addDemand(demand, particles, bonds);
  return criticalStep(demand, particles).dt;
}

/// A clamped row of spheres along x, brought to rest under a load. Returns how far its tip has gone.
struct Row {
  double length = 1.0, radius = 0.0, shearCorrection = 0.0;  // of the beam
  double E = 1e7;

  double area() const { return pi * radius * radius; }
  double inertia() const { return 0.25 * area() * radius * radius; }

  Bonded make(int elements) const {
    Bonded scene;
    const double h = length / elements;
    for (int i = 0; i <= elements; ++i) addParticle(scene.particles, {i * h, 0, 0}, {}, 0.5 * h, Density{1000.0});
    switchOnRotation(scene.particles);
    BondMaterial material = unbreakable(E);
    material.radiusRatio = radius / (0.5 * h);
    material.shearCorrection = shearCorrection;
    for (int i = 0; i < elements; ++i) addBond(scene.bonds, scene.particles, {}, i, i + 1, material);
    return scene;
  }

  /// @param load per particle, N
  Vec3 settle(int elements, const std::vector<Vec3>& load) const {
    Bonded scene = make(elements);
    Particles& p = scene.particles;
    const double dt = 0.9 * bondStep(p, scene.bonds);
    double mass = 0.0;
    for (const double m : p.mass) mass += m;
    const double slowest = 3.516 * std::sqrt(E * inertia() / (mass * length * length * length));
    const auto steps = static_cast<int>(60.0 / (slowest * dt));
    for (int s = 0; s < steps; ++s) {
      kick(p, 0.5 * dt);
      drift(p, dt);
      clearForces(p);
      exchangeBonds(p, scene.bonds, {}, dt);
      for (std::size_t i = 0; i < load.size(); ++i) p.f[i] += load[i];
      applyViscousDamping(p, 2.0 * slowest);
      p.f[0] = p.torque[0] = {};
      kick(p, 0.5 * dt);
    }
    return p.x.back() - Vec3{length, 0, 0};
  }
};

}  // namespace dovetail::dem
