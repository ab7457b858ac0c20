// Contact laws, composed of parts. An absent part takes no memory and no instruction.
//
// A part is a plain structure of parameters with
//   static constexpr int memory         numbers (doubles) that a contact remembers for it; all zero in a new contact
//   static constexpr unsigned turns     bit c is set if number c changes its sign when the two particles change roles
//   static constexpr bool needs…        what of `Contact` it reads beyond overlap, separation, normal and dt
//   prepare()                           what the loop over contacts uses; roots, logarithms and checks are done here
//   Prepared::respond(contact, …, held) the answer; advances the memory by contact.dt. Straight-line code with
//                                       selections instead of branches, and inlined into the loop over contacts
//                                       whatever the compiler thinks of its size, so that the loop vectorises
//   Prepared::remembered(held)          J stored in the memory of a contact that ends, booked as lost
//   Prepared::slope(contact, normal)    stiffness and damping now, of all parts but the normal one and adhesion
// and, beside it, validate(part), which throws InputError for parameters that make no sense.
#pragma once

#include <cmath>
#include <numbers>

#include "dovetail/dem/laws/contact.hpp"

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

  static constexpr int memory = 0;
  static constexpr unsigned turns = 0;
  static constexpr bool needsMass = true, needsRadius = false;

  /// What the contact loop uses: logarithm and root are taken once per list.
  struct Prepared {
    double stiffness;
    double dampingPerRootMass;  ///< c/√m
    double leastForce;          ///< N; −∞ if the contact may pull
    double range;               ///< m; ∞ if bonded

    /// @param overlap    λ ≥ 0, m, the part of the overlap that the contact carries
    /// @param separating n·(v_particle − v_other), m/s, > 0 while the overlap closes
    /// @param engagement share in which the dashpot acts
    /// @return force along n on the particle, N
    double force(double overlap, double separating, double engagement, double rootMass) const {
      const double f = stiffness * overlap - dampingPerRootMass * rootMass * engagement * separating;
      return f < leastForce ? leastForce : f;
    }
    /// J; `engagement` = overlap / overlap of the two alone (see WallContacts)
    double energy(double overlap, double engagement) const { return 0.5 * stiffness * overlap * overlap / engagement; }
    double elasticForce(double overlap) const { return stiffness * overlap; }

    [[gnu::always_inline]] NormalResponse respond(const Contact& contact, double*) const {
      const double damping = dampingPerRootMass * contact.rootMass;
      const double elastic = stiffness * contact.overlap;
      const double whole = elastic - damping * contact.separating;
      const double force = whole < leastForce ? leastForce : whole;
      return {.force = force,
              .stiffness = stiffness,
              .damping = damping,
              .energy = 0.5 * elastic * contact.overlap,
              .dashpotPower = (elastic - force) * contact.separating};
    }
    /// Contacts act while overlap > −reach, m.
    double reach() const { return range; }
    bool usesMass() const { return dampingPerRootMass > 0.0; }
    double remembered(const double*) const { return 0.0; }
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

/// No tangential force; particles need not spin.
struct NoTangential {
  static constexpr int memory = 0;
  static constexpr unsigned turns = 0;
  static constexpr bool needsSlip = false;
  struct Prepared {
    [[gnu::always_inline]] TangentialResponse respond(const Contact&, const NormalResponse&, double*) const {
      return {};
    }
    Slope slope(const Contact&, const NormalResponse&) const { return {}; }
    double remembered(const double*) const { return 0.0; }
  };
  Prepared prepare() const { return {}; }
};

/// Turns a remembered tangential vector with the pair since the last step: into today's contact plane, and about the
/// normal by the mean spin of both. Its length stays (to the fourth power of the angle of one step).
[[gnu::always_inline]] inline Vec3 carried(Vec3 remembered, const Contact& contact) {
  const double before = squaredNorm(remembered);
  remembered += (contact.dt * contact.twist) * cross(contact.normal, remembered);
  remembered -= dot(remembered, contact.normal) * contact.normal;
  const double ratio = squaredNorm(remembered) / (before > 0.0 ? before : 1.0);
  return (1.5 - 0.5 * ratio) * remembered;  // 1/√ratio for a ratio near 1, and bounded for any
}

/// A spring, a dashpot beside it, and a slider before both.
struct Slider {
  Vec3 stretch, force;        ///< of the spring, and of both, along the stretch
  double energy = 0.0;        ///< J stored
  double slipWork = 0.0;      ///< J lost to sliding in this step
  double dampingPower = 0.0;  ///< W lost to the dashpot, ≥ 0

  /// The spring alone keeps below the limit; the dashpot adds what the limit leaves. (The other way round, a dashpot
  /// above the limit would stretch the spring backwards, with energy from nowhere.)
  [[gnu::always_inline]] Slider(const Vec3& stretched, const Vec3& rate, double stiffness, double damping,
                                double limit) {
    const double size = stiffness * norm(stretched);
    const bool slides = size > limit;
    stretch = (slides ? limit / (slides ? size : 1.0) : 1.0) * stretched;
    const Vec3 spring = stiffness * stretch, both = spring + damping * rate;
    const double whole = norm(both);
    const bool cut = damping > 0.0 ? whole > limit : false;
    force = (cut ? limit / (cut ? whole : 1.0) : 1.0) * both;
    energy = 0.5 * dot(spring, stretch);
    slipWork = dot(spring, stretched - stretch);
    dampingPower = dot(force - spring, rate);
  }
};

/// Tangential part: spring of stiffness k_t stretched by the relative tangential motion (Cundall & Strack 1979), with a
/// dashpot if asked for; the force is limited to μ times the repulsion of the normal part (Coulomb).
struct TangentialSpring {
  static constexpr int memory = 3;  // stretch, m
  static constexpr unsigned turns = 0b111;
  static constexpr bool needsSlip = true;
  double stiffness = 0.0;     ///< k_t, N/m
  double friction = 0.0;      ///< μ
  double dampingRatio = 0.0;  ///< coefficient of the tangential dashpot over that of the normal one

  struct Prepared {
    double stiffness, friction, dampingRatio;

    [[gnu::always_inline]] TangentialResponse respond(const Contact& contact, const NormalResponse& normal,
                                                      double* held) const {
      const Vec3 stretched = carried({held[0], held[1], held[2]}, contact) + contact.dt * contact.slip;
      const double limit = normal.force > 0.0 ? friction * normal.force : 0.0;
      const Slider now(stretched, contact.slip, stiffness, dampingRatio * normal.damping, limit);
      held[0] = now.stretch.x;
      held[1] = now.stretch.y;
      held[2] = now.stretch.z;
      return {.force = -now.force, .energy = now.energy, .slipPower = now.slipWork / contact.dt + now.dampingPower};
    }
    Slope slope(const Contact&, const NormalResponse& normal) const {
      return {stiffness, dampingRatio * normal.damping};
    }
    double remembered(const double* held) const {
      return 0.5 * stiffness * (held[0] * held[0] + held[1] * held[1] + held[2] * held[2]);
    }
  };
  Prepared prepare() const { return {stiffness, friction, dampingRatio}; }
};

/// No resistance to rolling and twisting.
struct NoRolling {
  static constexpr int memory = 0;
  static constexpr unsigned turns = 0;
  static constexpr bool needsSpin = false, needsRadius = false;
  struct Prepared {
    [[gnu::always_inline]] RollingResponse respond(const Contact&, const NormalResponse&, double*) const { return {}; }
    Slope slope(const Contact&, const NormalResponse&) const { return {}; }
    double remembered(const double*) const { return 0.0; }
  };
  Prepared prepare() const { return {}; }
};

/// Nothing pulls.
struct NoAdhesion {
  static constexpr bool needsRadius = false;
  struct Prepared {
    [[gnu::always_inline]] AdhesionResponse respond(const Contact&, const NormalResponse&) const { return {}; }
  };
  Prepared prepare() const { return {}; }
};

/// @throws InputError: stiffness not finite and > 0; restitution outside (0, 1]; friction, damping ratio or k_t not
/// finite and ≥ 0
void validate(const LinearSpringDashpot& part);
void validate(const TangentialSpring& part);
inline void validate(const NoTangential&) {}
inline void validate(const NoRolling&) {}
inline void validate(const NoAdhesion&) {}

/// A law for one pair of materials.
template <class Normal, class Tangential = NoTangential, class Rolling = NoRolling, class Adhesion = NoAdhesion>
struct ContactLaw {
  Normal normal;
  [[no_unique_address]] Tangential tangential = {};
  [[no_unique_address]] Rolling rolling = {};
  [[no_unique_address]] Adhesion adhesion = {};

  static constexpr int memory = Normal::memory + Tangential::memory + Rolling::memory;
  static_assert(memory <= 12, "a block of contacts has rows for twelve numbers");
  static constexpr unsigned turns =
      Normal::turns | Tangential::turns << Normal::memory | Rolling::turns << (Normal::memory + Tangential::memory);
  static constexpr bool needsMass = Normal::needsMass;
  static constexpr bool needsRadius = Normal::needsRadius || Rolling::needsRadius || Adhesion::needsRadius;
  static constexpr bool needsSlip = Tangential::needsSlip;
  static constexpr bool needsSpin = Rolling::needsSpin;
  /// Whether contacts exert torques, so that particles spin.
  static constexpr bool rotates = needsSlip || needsSpin;

  struct Prepared {
    typename Normal::Prepared normal;
    [[no_unique_address]] typename Tangential::Prepared tangential;
    [[no_unique_address]] typename Rolling::Prepared rolling;
    [[no_unique_address]] typename Adhesion::Prepared adhesion;

    double reach() const { return normal.reach(); }
    bool usesMass() const { return normal.usesMass(); }

    /// Answers of all parts; those of the normal part's memory come first, then the tangential one's, then the rolling
    /// one's.
    [[gnu::always_inline]] ContactResponse respond(const Contact& contact, double* held) const {
      const NormalResponse n = normal.respond(contact, held);
      const TangentialResponse t = tangential.respond(contact, n, held + Normal::memory);
      const RollingResponse r = rolling.respond(contact, n, held + Normal::memory + Tangential::memory);
      const AdhesionResponse a = adhesion.respond(contact, n);
      ContactResponse response{.force = (n.force + a.force) * contact.normal + t.force, .couple = r.couple, .work = {}};
      response.work.elasticEnergy = n.energy + a.energy;
      response.work.dissipatedPower = n.dashpotPower;
      response.work.plasticPower = n.plasticPower;
      response.work.tangentialEnergy = t.energy;
      response.work.frictionPower = t.slipPower;
      response.work.rollingEnergy = r.energy;
      response.work.rollingPower = r.lostPower;
      return response;
    }

    /// Stiffness and damping of all parts now; what is held is advanced.
    ContactSlopes slopes(const Contact& contact, double* held) const {
      const NormalResponse n = normal.respond(contact, held);
      return {{n.stiffness, n.damping}, tangential.slope(contact, n), rolling.slope(contact, n)};
    }

    /// What a contact that has ended takes with it.
    ContactWork ended(const double* held, double dt) const {
      ContactWork work;
      work.plasticPower = normal.remembered(held) / dt;
      work.frictionPower = tangential.remembered(held + Normal::memory) / dt;
      work.rollingPower = rolling.remembered(held + Normal::memory + Tangential::memory) / dt;
      return work;
    }
  };
  Prepared prepare() const { return {normal.prepare(), tangential.prepare(), rolling.prepare(), adhesion.prepare()}; }
};

using ElasticLaw = ContactLaw<LinearSpringDashpot>;
using FrictionalLaw = ContactLaw<LinearSpringDashpot, TangentialSpring>;

/// Checks all parts for which there is a validate(part), in this namespace or the part's own.
template <class Normal, class Tangential, class Rolling, class Adhesion>
void validate(const ContactLaw<Normal, Tangential, Rolling, Adhesion>& law) {
  const auto check = [](const auto& part) {
    if constexpr (requires { validate(part); }) validate(part);
  };
  check(law.normal);
  check(law.tangential);
  check(law.rolling);
  check(law.adhesion);
}

}  // namespace dovetail::dem
