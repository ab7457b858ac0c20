// One instant of a model as plain arrays, for continuum fields and averages.
//
//     const dem::Snapshot now = dem::takeSnapshot(model);
//     const cg::Fields fields = cg::sample(kernel, points, cg::viewOf(now));
#pragma once

#include <vector>

#include "dovetail/dem/model/sample.hpp"

namespace dovetail::dem {

/// Masses and forces. Members of clumps are represented by their bodies: one entry at the centre of mass, with the sum
/// of the members' spheres as its volume, and forces that end there. Walls have no mass, free ones neither.
struct Snapshot {
  double time = 0.0;                 ///< s
  std::vector<Vec3> x, v;            ///< free particles by number, then bodies of clumps, m, m/s
  std::vector<double> mass, volume;  ///< kg and m³ of the fraction that is modelled here (Particles::weight)
  std::vector<Vec3> from, to;        ///< contacts and bonds, see ContactSample, m
  std::vector<Vec3> force;           ///< on the first, N; forces too carry their fraction
  std::vector<Vec3> wallPoint;       ///< of those of these contacts that are with walls, m
  std::vector<Vec3> wallForce;       ///< of the walls on the particles, N
  geometry::Periodicity space;
};

/// A model as it is now, with all its contacts and bonds.
/// @throws InputError if forces have not been found yet (those of bonds not since a restart either: call findForces),
/// or
///         between advance and close, when velocities lag behind
Snapshot takeSnapshot(const Model& m);

}  // namespace dovetail::dem
