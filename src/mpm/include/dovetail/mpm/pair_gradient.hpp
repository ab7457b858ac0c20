// Energy of the gradient of F between material points: gives bands of softening bodies a width of their own.
#pragma once

#include <memory>
#include <string>

#include "dovetail/mpm/point_solid.hpp"

namespace dovetail::mpm {

struct PairGradientOptions {
  double modulus = 0.0;                ///< D, N, > 0
  std::string name = "gradient of F";  ///< its channel in the ledger
};

/// W = ½ Σ k_pq |F_p − F_q|² over pairs of points nearer than 2 d at the start, d being their mean distance, with k_pq
/// = a D √(V_p V_q)/d² (1 − ξ²/4d²)², ξ the distance of the two at the start. a is such that points on a square or
/// cubic lattice store ½ D |∇F|² per volume of a linear F: what fem::gradientEnergy stores in elements, without a mesh.
/// Pairs stay for ever: they hold a body together that flows apart, and a gap narrower than 2 d does not part them.
///
/// The force is linear in the displacements between renewals, which leave the energy as it is; it is objective, and
/// uniform F has none. Points at free faces have fewer neighbours: there it is one-sided.
/// @param start  as makePoints got them
/// @throws InputError for a modulus that is not positive, other points than the solid has, or after a renewal
std::shared_ptr<fem::Term> pairGradient(std::shared_ptr<const PointSolid> points, const MaterialPoints& start,
                                        const PairGradientOptions& options);

}  // namespace dovetail::mpm
