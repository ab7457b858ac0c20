// Particles sliding along the vibrating cantilever: the dynamic reference.
#pragma once

#include <vector>

#include "reference/beam_modes.hpp"

namespace dovetail::cantilever {

struct ModalOptions {
  BeamTheory theory;             ///< supports must be clampedFree
  int modes = 24;                ///< kept; 24 leave within 15 ms of where very many do
  bool surfaceOffset = true;     ///< the top surface turns with the section; off: it only follows the axis
  bool largeRotations = true;    ///< inextensible axis (see ModeTable); off: the axis moves along z only
  int tableCells = 60;           ///< of the mode shapes along the beam
  double dt = 1e-4;              ///< s
  double sampleInterval = 1e-3;  ///< s, rounded up to whole steps
  double maxTime = 100.0;        ///< s
};

struct BeamPosition {
  double y, z, vy, vz;  ///< of the particles' centres, m, m/s
};

/// Trajectory of the particles' centres until they have passed the free end.
struct DynamicReference {
  std::vector<double> time, y, z, vy, vz;  ///< one entry per sample, SI; the last one is just after leaving
  double leaveTime = 0.0;                  ///< when y = length, s
  double startEnergy = 0.0;                ///< kinetic + contact, heights counted from the start, J
  double energyDriftRelative = 0.0;        ///< max |E(t) − E(0)| / E(0) over all steps
  double separatedFraction = 0.0;          ///< fraction of the steps without contact

  /// By cubic Hermite interpolation. @throws InputError outside time.front() … time.back()
  BeamPosition at(double t) const;
  /// When and where the particles have the given y, which grows all the time.
  /// @throws InputError outside y.front() … y.back()
  double timeAtY(double position) const;
  BeamPosition atY(double position) const;
};

/// Symplectic (velocity Verlet) integration of modes and particles, which act as one sphere of their joint mass and
/// contact stiffness in the (y, z) plane. Starts with the beam at rest and undeformed, the particles at their static
/// overlap. Left out: the beam's axial inertia and stretch, and the local dent of the surface under a particle.
/// @throws InputError for impossible settings (a dt that is unstable for the highest mode among them); NumericalError
/// if the particles have not left by maxTime, or the closest point of the surface is lost
DynamicReference simulateMovingMassBeam(const BeamCase& beam, const ModalOptions& settings);

}  // namespace dovetail::cantilever
