// Energy of a model by channel.
#pragma once

#include <cstdint>

#include "dovetail/core/impulses.hpp"
#include "dovetail/dem/laws/contact_work.hpp"

namespace dovetail::dem {

/// Energy by channel, J. `balance` is constant but for the error of the integrator.
struct Energies {
  double kinetic = 0.0, gravity = 0.0, contacts = 0.0;  ///< stored now; contacts with those at walls and bonds
  ContactWork lost;       ///< its …Power members hold what has been lost so far, J; its energies are not used
  double damping = 0.0;   ///< taken by viscous and local damping
  double walls = 0.0;     ///< done by moving walls and drives on what they touch
  double external = 0.0;  ///< done by external forces, and by those who strain a periodic cell
  double entered = 0.0;   ///< brought in by particles, and by terms and laws that were exchanged between steps
  double left = 0.0;      ///< taken out with particles that were removed or escaped
  double lifted = 0.0;    ///< gravity work across periodic boundaries
  double stored() const { return kinetic + gravity + contacts; }
  /// stored + lost + damping + left − what came in
  double balance() const { return stored() + lost.lostPower() + damping + left - walls - external - entered - lifted; }
};

using dovetail::Momenta;

/// Mass and momenta that have entered or left the scene.
struct Exchanged {
  std::int64_t count = 0;
  double mass = 0.0;     ///< kg
  Vec3 momentum;         ///< kg m/s
  Vec3 angularMomentum;  ///< about the origin, kg m²/s
};

}  // namespace dovetail::dem
