// The cantilever and its sliding particles as a beam problem.
#pragma once

namespace dovetail::cantilever {

/// Cheng et al. 2023, section 6.1 and Table 1, SI. Axes: y from the clamp along the beam, z up, z = 0 on the beam's
/// axis.
struct BeamCase {
  double length = 12.0, width = 0.8, height = 0.8;  ///< along y, x, z, m
  double youngsModulus = 1e8;                       ///< Pa
  double poissonRatio = 0.0;
  double shearCorrection = 5.0 / 6.0;  ///< κ of Timoshenko's shear stiffness κGA
  double density = 1309.0;             ///< kg/m³; the beam has inertia but no weight
  double bendingFactor = 1.0;  ///< multiplies EI, for instance 1.125 for two locked linear bricks through the depth

  int particles = 2;                  ///< in lockstep; act as one body of their joint mass and contact stiffness
  double particleRadius = 0.1;        ///< m
  double particleDensity = 2e4;       ///< kg/m³
  double contactStiffness = 2e7;      ///< of one particle with the top surface, N/m
  double gravity = 9.81;              ///< along −z, m/s²
  double startX = 0.2, startY = 0.2;  ///< of the particles, x = ±startX, m
  double startVelocity = 0.1;         ///< along y, m/s
};

/// Mass of one particle, kg.
double beamParticleMass(const BeamCase& beam);
/// Weight of all particles together, N.
double totalWeight(const BeamCase& beam);
/// Height of the particles' centres above the axis at the start: on the undeformed top surface, at the static overlap,
/// m.
double startHeight(const BeamCase& beam);

/// Stiffness and inertia of the cross-section.
struct Section {
  double bending;     ///< EI times bendingFactor, N m²
  double shear;       ///< κGA, N
  double mass;        ///< ρA, kg/m
  double rotaryMass;  ///< ρI, kg m
};
/// @throws InputError naming the first impossible value of the case
Section makeSection(const BeamCase& beam);

}  // namespace dovetail::cantilever
