// The state of a finite-element solid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dovetail/core/vec3.hpp"

namespace dovetail::fem {

/// Bits of Nodes::fixed and of fix().
enum Component : std::uint8_t { componentX = 1, componentY = 2, componentZ = 4, allComponents = 7 };

/// Nodal state, one entry per node. Time steps are written with the verbs of Motion (motion.hpp).
struct Nodes {
  std::vector<Vec3> X;              ///< reference position, m
  std::vector<Vec3> u;              ///< displacement, m; the node is at X + u
  std::vector<Vec3> v;              ///< velocity, m/s
  std::vector<Vec3> f;              ///< force on the node, N (at held components: minus the reaction)
  std::vector<double> mass;         ///< lumped mass, kg
  std::vector<double> bodyMass;     ///< row sums of the consistent mass, kg; empty where they are `mass`
  std::vector<std::uint8_t> fixed;  ///< bit c set: component c is held, it keeps its velocity whatever the force
};

/// Holds components of nodes: their velocity becomes zero and no force changes it. A velocity that is set afterwards
/// is a prescribed motion.
/// @throws InputError for an empty set, a node number out of range, or components outside 1…7
void fix(Nodes& nodes, std::span<const int> set, unsigned components = allComponents);

/// f = 0.
void clearForces(Nodes& nodes);
/// v += f/m dt, except held components, s.
void kick(Nodes& nodes, double dt);
/// u += v dt.
void drift(Nodes& nodes, double dt);

/// ½ Σ m v², J.
double kineticEnergy(const Nodes& nodes);
/// Σ m v, kg m/s.
Vec3 momentum(const Nodes& nodes);
/// Σ m (X + u) × v about the origin, kg m²/s.
Vec3 angularMomentum(const Nodes& nodes);

/// @throws InputError naming the first node without mass that is not held in all components
void requireMass(const Nodes& nodes);

}  // namespace dovetail::fem
