// Contact laws, composed of parts. An absent part takes no memory and no instruction.
#pragma once

#include <cmath>
#include <numbers>

#include "dovetail/core/vec3.hpp"

namespace dovetail::dem {

/// Normal part: linear spring and dashpot, F = k δ + c dδ/dt (> 0 pushes apart).
///
/// The inputs are k and the restitution e; with effective mass m = m₁m₂/(m₁ + m₂) (a wall counts as infinitely heavy)
///   t_c² = m (π² + ln²e)/k,   c = −2 m ln e/t_c,
/// so that e holds for every size, and the half period t_c grows with damping.
///
/// Which restitution: with `tension` (default) the contact lasts until the overlap has gone, its last part pulls, and
/// separation speed / approach speed = e exactly. Without tension the force is cut off at zero, the contact ends sooner
/// and the ratio is restitutionWithoutTension(e) ≥ e.
struct LinearSpringDashpot {
  double stiffness = 0.0;    ///< k, N/m
  double restitution = 1.0;  ///< e, in (0, 1]; 1 = no dashpot
  bool tension = true;       ///< whether the dashpot may pull while the overlap closes
  bool bonded = false;  ///< pairs only: every pair of the list holds together, F = k δ for δ < 0 too. The list is
                        ///< then made once, with the pairs that are to be bonds, and kept

  /// What the contact loop uses: logarithm and root are taken once per list.
  struct Prepared {
    double stiffness;
    double dampingPerRootMass;  ///< c/√m
    bool tension;
    bool bonded;

    /// @param overlap    λ ≥ 0, m, the part of the overlap that the contact carries
    /// @param separating n·(v_particle − v_other), m/s, > 0 while the overlap closes
    /// @param engagement share in which the dashpot acts
    /// @return force along n on the particle, N
    double force(double overlap, double separating, double engagement, double rootMass) const {
      const double f = stiffness * overlap - dampingPerRootMass * rootMass * engagement * separating;
      return !tension && f < 0.0 ? 0.0 : f;
    }
    /// J; `engagement` = overlap / overlap of the two alone (see WallContacts)
    double energy(double overlap, double engagement) const { return 0.5 * stiffness * overlap * overlap / engagement; }
    double elasticForce(double overlap) const { return stiffness * overlap; }
  };
  Prepared prepare() const;

  /// c, N s/m
  double damping(double effectiveMass) const;
  /// t_c, s
  double contactTime(double effectiveMass) const;
};

/// e^(1 − (2/π) arctan(−ln e/π)): what a linear spring-dashpot made for e does when it may not pull
/// (Schwager & Pöschel, Granular Matter 9, 2007).
double restitutionWithoutTension(double restitution);

/// No tangential force.
struct NoTangential {
  static constexpr bool hasHistory = false;
};

/// Tangential part: spring of stiffness k_t stretched by the relative tangential motion, limited to μ times the normal
/// force (Coulomb). Contacts remember their stretch (Cundall & Strack 1979).
struct TangentialSpring {
  static constexpr bool hasHistory = true;
  double stiffness = 0.0;  ///< k_t, N/m
  double friction = 0.0;   ///< μ

  struct Result {
    Vec3 force;       ///< on the particle, N
    double energy;    ///< stored, J
    double slipWork;  ///< lost to sliding in this step, J
  };
  /// @param stretch     m; on entry that of the last step, turned into the tangent plane and stretched here
  /// @param normal      unit
  /// @param velocity    v_particle − v_other at the contact, m/s; its tangential part stretches the spring
  /// @param normalForce N; tension (< 0) counts as zero
  Result respond(Vec3& stretch, const Vec3& normal, const Vec3& velocity, double normalForce, double dt) const;
};

template <class Normal, class Tangential = NoTangential>
struct ContactLaw {
  Normal normal;
  [[no_unique_address]] Tangential tangential = {};
  static constexpr bool hasHistory = Tangential::hasHistory;
};

using ElasticLaw = ContactLaw<LinearSpringDashpot>;
using FrictionalLaw = ContactLaw<LinearSpringDashpot, TangentialSpring>;

/// @throws InputError: stiffness not finite and > 0; restitution outside (0, 1]; friction or k_t not finite and ≥ 0
void validate(const LinearSpringDashpot& part);
void validate(const TangentialSpring& part);
inline void validate(const NoTangential&) {}
template <class Normal, class Tangential>
void validate(const ContactLaw<Normal, Tangential>& law) {
  validate(law.normal);
  validate(law.tangential);
}

}  // namespace dovetail::dem
