// What supports and ties give to a solid.
#pragma once

#include <span>

#include "dovetail/core/impulses.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/model/nodes.hpp"

namespace dovetail::fem {

/// What supports and ties have given.
struct SupportKick {
  Momenta impulse;    ///< kg m/s, kg m²/s
  double work = 0.0;  ///< J, by those that move
  SupportKick& operator+=(const SupportKick& b) {
    impulse += b.impulse;
    work += b.work;
    return *this;
  }
};

/// r = M (v − before) − dt f of the components that are not free (with ties, or if M is not lumped, of all), at the
/// present places: what supports and ties have given in a kick by f over dt, and its work against the mean velocities.
/// @param before  velocities before the kick, m/s; may be left empty if M is lumped and held components have kept
/// theirs
SupportKick supportKick(const Nodes& nodes, const ModelMass& mass, std::span<const Vec3> before,
                        std::span<const Vec3> f, double dt);

/// Momentum and angular momentum with the mass in use.
Momenta momentaOf(const Nodes& nodes, const ModelMass& mass);
/// Sum of forces on the nodes, N, or impulses, and of their moments at the present places.
Momenta momentaOf(const Nodes& nodes, std::span<const Vec3> force);

}  // namespace dovetail::fem
