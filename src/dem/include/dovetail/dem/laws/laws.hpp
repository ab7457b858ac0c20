// Contact laws, composed of parts. An absent part takes no memory and no instruction.
//
// A part is a plain structure of parameters with
//   static constexpr const char* name   what it is called in names of laws, may be left out
//   static constexpr int memory         numbers (doubles) that a contact remembers for it; all zero in a new contact
//   static constexpr unsigned turns     bit c is set if number c changes its sign when the two particles change roles
//   static constexpr bool needs…        what of `Contact` it reads beyond overlap, separation, normal and dt
//   Prepared::damps()                   of other than normal parts: whether it has a dashpot; may be left out
//   Prepared::pulls()                   of normal parts: whether dashpots act until the contact ends; may be left out
//   Prepared::engagement(θ)             of normal parts: Contact::engagement where the part θ of a step is in touch.
//                                       Left out where damping does not grow with the overlap: ½ + θ, as the kick in
//                                       the step of the first touch is one for the time since touch and the half step
//                                       that follows, that of the last for the half step before and the time left
//   prepare()                           what the loop over contacts uses; roots, logarithms and checks are done here
//   static constexpr unsigned carries   bit c is set if numbers c, c + 1 and c + 2 are a tangential vector, which is
//                                       turned with the contact before `respond` is asked (`carried`, contact.hpp);
//                                       may be left out
//   Prepared::respond(contact, …, held) the answer; advances the memory by contact.dt. Straight-line code with
//                                       selections instead of branches, and inlined into the loop over contacts
//                                       whatever the compiler thinks of its size, so that the loop vectorises
//   Prepared::remembered(held)          J stored in the memory of a contact that ends, booked as lost
//   Prepared::slope(contact, normal)    stiffness and damping now, of all parts but the normal one and adhesion
// and, beside it, validate(part), which throws InputError for parameters that make no sense.
#pragma once

#include <cmath>
#include <numbers>
#include <type_traits>

#include "dovetail/dem/laws/contact.hpp"
#include "dovetail/dem/laws/slider.hpp"

namespace dovetail::dem {

/// Velocity that the dashpot beside a spring of slope k sees, m/s: `separating` knows the acceleration of the last step
/// only; the spring has changed it since by −(k/m) times what has closed of the overlap. (dt² k/m ≤ 4 in stable steps.)
[[gnu::always_inline]] inline double seenBy(const Contact& contact, double stiffness) {
  const double turned = 0.5 * stiffness * contact.dt * contact.inverseMass, most = 2.0 * contact.inverseDt;
  return contact.separating - (turned < most ? turned : most) * contact.separated;
}

/// Normal part: linear spring and dashpot, F = k δ + c dδ/dt (> 0 pushes apart).
///
/// The inputs are k and the restitution e. With effective mass m = m₁m₂/(m₁ + m₂) (a wall counts as infinitely heavy)
/// the dashpot is c = 2 ζ √(k m), so that e holds for every size and speed.
///
/// Which restitution: separation speed / approach speed is e, with and without `tension`. Without it (default) the
/// force is cut off at zero, which ends the contact sooner, and ζ is chosen for that (see restitution.hpp). With it the
/// contact lasts until the overlap has gone, its last part pulls, and ζ = −ln e/√(π² + ln²e). With `nominal` and
/// without tension ζ is that of a contact with tension, as in codes that cut the force off afterwards; the rebound is
/// then restitutionWithoutTension(e) ≥ e.
struct LinearSpringDashpot {
  double stiffness = 0.0;    ///< k, N/m
  double restitution = 1.0;  ///< e, in (0, 1]; 1 = no dashpot
  bool tension = false;      ///< whether the force may be tensile while particles separate
  bool bonded = false;   ///< pairs only: every pair of the list holds together, F = k δ for δ < 0 too. The list is
                         ///< then made once, with the pairs that are to be bonds, and kept
  bool nominal = false;  ///< without tension: e is that of a contact with tension
  static constexpr const char* name = "linear spring-dashpot";
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
    /// @param engagement fraction in which the dashpot acts
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
      const double elastic = stiffness * contact.overlap, seen = seenBy(contact, stiffness);
      const double whole = elastic - contact.engagement * damping * seen;
      const double force = whole < leastForce ? leastForce : whole;
      return {.force = force,
              .stiffness = stiffness,
              .damping = damping,
              .energy = 0.5 * elastic * contact.overlap,
              .dashpotPower = (elastic - force) * seen};
    }
    /// Contacts act while overlap > −reach, m.
    double reach() const { return range; }
    bool pulls() const { return leastForce < 0.0; }
    bool usesMass() const { return dampingPerRootMass > 0.0; }
    double remembered(const double*) const { return 0.0; }
  };
  Prepared prepare() const;

  /// c, N s/m
  double damping(double effectiveMass) const;
  /// ζ
  double dampingRatio() const;
  /// How long a contact lasts, s; with `nominal` one that is not cut off.
  double contactTime(double effectiveMass) const;
};

/// e^(1 − (2/π) arctan(−ln e/π)): what a spring-dashpot made for e does when it may not pull
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

/// Tangential part: spring of stiffness k_t stretched by the relative tangential motion (Cundall & Strack 1979), with a
/// dashpot if asked for; the force is limited to μ times the repulsion of the normal part (Coulomb).
struct TangentialSpring {
  static constexpr const char* name = "friction";
  static constexpr int memory = 3;  // stretch, m
  static constexpr unsigned turns = 0b111, carries = 0b1;
  static constexpr bool needsSlip = true;
  double stiffness = 0.0;     ///< k_t, N/m
  double friction = 0.0;      ///< μ
  double dampingRatio = 0.0;  ///< coefficient of the tangential dashpot over that of the normal one

  template <bool dashpot>
  struct PreparedSpring {
    double stiffness, friction, dampingRatio;

    [[gnu::always_inline]] TangentialResponse respond(const Contact& contact, const NormalResponse& normal,
                                                      double* held) const {
      const Vec3 old{held[0], held[1], held[2]};
      const double limit = normal.force > 0.0 ? friction * normal.force : 0.0;
      const Slider<dashpot> now(old, stiffness * old, contact.slipped, contact.slip, stiffness,
                                dampingRatio * contact.engagement * normal.damping, limit, contact.inverseDt);
      held[0] = now.stretch.x;
      held[1] = now.stretch.y;
      held[2] = now.stretch.z;
      return {.force = -now.force, .energy = now.energy, .slipPower = now.slipPower, .dashpotPower = now.dashpotPower};
    }
    Slope slope(const Contact&, const NormalResponse& normal) const {
      return {stiffness, dampingRatio * normal.damping};
    }
    double remembered(const double* held) const {
      return 0.5 * stiffness * (held[0] * held[0] + held[1] * held[1] + held[2] * held[2]);
    }
    bool damps() const { return dampingRatio > 0.0; }
    PreparedSpring<false> withoutDashpot() const { return {stiffness, friction, 0.0}; }
  };
  using Prepared = PreparedSpring<true>;
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

namespace detail {
/// Numbers that a part remembers, if it says so.
template <class Part>
constexpr int numbersOf() {
  if constexpr (requires { Part::memory; })
    return Part::memory;
  else
    return 0;
}
template <class Part>
inline constexpr int memoryOf = numbersOf<Part>();
/// Whether a part has a dashpot, if it says so.
template <class Prepared>
bool dampsIn(const Prepared& part) {
  if constexpr (requires { part.damps(); })
    return part.damps();
  else
    return false;
}
/// Vectors that turn with the contact, if it says so.
template <class Part>
constexpr unsigned carriesOf() {
  if constexpr (requires { Part::carries; })
    return Part::carries;
  else
    return 0;
}
}  // namespace detail

/// A law for one pair of materials. A part in the place of adhesion that remembers something also says how far beyond
/// touch it reaches, m (`Prepared::reach`), and gets its memory as third argument of respond.
template <class Normal, class Tangential = NoTangential, class Rolling = NoRolling, class Adhesion = NoAdhesion>
struct ContactLaw {
  Normal normal;
  [[no_unique_address]] Tangential tangential = {};
  [[no_unique_address]] Rolling rolling = {};
  [[no_unique_address]] Adhesion adhesion = {};

  static constexpr int pullMemory = detail::memoryOf<Adhesion>;  // of what pulls, behind all others
  static constexpr int touchMemory = Normal::memory + Tangential::memory + Rolling::memory;
  static constexpr int memory = touchMemory + pullMemory;
  static_assert(memory <= 12, "a block of contacts has rows for twelve numbers");
  static constexpr unsigned turns =
      Normal::turns | Tangential::turns << Normal::memory | Rolling::turns << (Normal::memory + Tangential::memory);
  static constexpr unsigned carries = detail::carriesOf<Tangential>() << Normal::memory |
                                      detail::carriesOf<Rolling>() << (Normal::memory + Tangential::memory);
  /// How many numbers each part remembers, in four bits each, the normal part's lowest: memory of another kind means
  /// something else, whatever its size.
  static constexpr unsigned memoryKind =
      static_cast<unsigned>(Normal::memory | Tangential::memory << 4 | Rolling::memory << 8 | pullMemory << 12);
  static constexpr bool needsMass = Normal::needsMass;
  static constexpr bool needsRadius = Normal::needsRadius || Rolling::needsRadius || Adhesion::needsRadius;
  static constexpr bool needsSlip = Tangential::needsSlip;
  static constexpr bool needsSpin = Rolling::needsSpin;
  /// Whether forces begin or end at once.
  static constexpr bool jumps = !std::is_same_v<Adhesion, NoAdhesion>;
  /// Whether contacts exert torques, so that particles spin.
  static constexpr bool rotates = needsSlip || needsSpin;

  /// Velocities that a contact remembers, as numbers: n·v, or the relative velocity and spin.
  static constexpr int recalled(Recall recall) {
    return recall == Recall::nothing ? 0 : recall == Recall::approach ? 1 : needsSpin ? 6 : 3;
  }

  template <class PreparedTangential>
  struct PreparedParts {
    typename Normal::Prepared normal;
    [[no_unique_address]] PreparedTangential tangential;
    [[no_unique_address]] typename Rolling::Prepared rolling;
    [[no_unique_address]] typename Adhesion::Prepared adhesion;

    double reach() const {
      if constexpr (pullMemory > 0)
        return adhesion.reach();
      else
        return normal.reach();
    }
    bool usesMass() const { return normal.usesMass(); }

    /// What the dashpots need of the last step. Normal parts use the mass for their dashpots.
    Recall recall() const {
      if (detail::dampsIn(tangential) || detail::dampsIn(rolling)) return Recall::motion;
      return usesMass() ? Recall::approach : Recall::nothing;
    }
    /// Where the tangential part has no dashpot: the same answers with fewer instructions.
    auto withoutDashpot() const {
      if constexpr (requires { tangential.withoutDashpot(); })
        return PreparedParts<decltype(tangential.withoutDashpot())>{normal, tangential.withoutDashpot(), rolling,
                                                                    adhesion};
      else
        return *this;
    }

    /// Answers of all parts; those of the normal part's memory come first, then the tangential one's, then the rolling
    /// one's, then that of what pulls.
    [[gnu::always_inline]] ContactResponse respond(const Contact& contact, double* held) const {
      if constexpr (pullMemory > 0)
        return respondWithin(contact, held);
      else
        return combined(contact, held, [&](const NormalResponse& n) { return adhesion.respond(contact, n); });
    }

    /// Where something pulls beyond touch: all other parts see the contact only while the two touch.
    ContactResponse respondWithin(const Contact& contact, double* held) const {
      const auto pull = [&](const NormalResponse& n) { return adhesion.respond(contact, n, held + touchMemory); };
      if (contact.overlap > 0.0) return combined(contact, held, pull);
      Contact touch = contact;
      touch.overlap = 0.0;
      double none[touchMemory + 1] = {};
      ContactResponse apart;
      apart.work = endedTouch(held, contact.inverseDt);
      for (int c = 0; c < touchMemory; ++c) held[c] = 0.0;
      const AdhesionResponse a = pull(normal.respond(touch, none));
      apart.force = a.force * contact.normal;
      apart.work.elasticEnergy = a.energy;
      return apart;
    }

    template <class Pull>
    [[gnu::always_inline]] ContactResponse combined(const Contact& contact, double* held, const Pull& pull) const {
      const NormalResponse n = normal.respond(contact, held);
      const TangentialResponse t = tangential.respond(contact, n, held + Normal::memory);
      const RollingResponse r = rolling.respond(contact, n, held + Normal::memory + Tangential::memory);
      const AdhesionResponse a = pull(n);
      ContactResponse response{.force = (n.force + a.force) * contact.normal + t.force, .couple = r.couple, .work = {}};
      response.work.elasticEnergy = n.energy + a.energy;
      response.work.dissipatedPower = n.dashpotPower + t.dashpotPower + r.dashpotPower;
      response.work.plasticPower = n.plasticPower;
      response.work.tangentialEnergy = t.energy;
      response.work.frictionPower = t.slipPower;
      response.work.rollingEnergy = r.energy;
      response.work.rollingPower = r.slipPower;
      return response;
    }

    /// Stiffness and damping of all parts now; what is held is advanced. A dashpot that sees the velocity of its own
    /// instant, extrapolated from the half steps, weighs twice in the limit of the step: that of a mode of frequency ω
    /// and damping ratio ζ is then (2/ω)(√(1 + 4ζ²) − 2ζ).
    ContactSlopes slopes(const Contact& contact, double* held) const {
      const NormalResponse n = normal.respond(contact, held);
      ContactSlopes all{{n.stiffness, n.damping}, tangential.slope(contact, n), rolling.slope(contact, n)};
      if (recall() != Recall::nothing)
        for (Slope* const slope : {&all.normal, &all.tangential, &all.rolling}) slope->damping *= 2.0;
      return all;
    }

    /// What a contact that has ended takes with it.
    ContactWork ended(const double* held, double inverseDt) const {
      ContactWork work = endedTouch(held, inverseDt);
      if constexpr (pullMemory > 0) work.fracturePower = adhesion.remembered(held + touchMemory) * inverseDt;
      return work;
    }
    /// The same of the parts that need touch.
    ContactWork endedTouch(const double* held, double inverseDt) const {
      ContactWork work;
      work.plasticPower = normal.remembered(held) * inverseDt;
      work.frictionPower = tangential.remembered(held + Normal::memory) * inverseDt;
      work.rollingPower = rolling.remembered(held + Normal::memory + Tangential::memory) * inverseDt;
      return work;
    }
  };
  using Prepared = PreparedParts<typename Tangential::Prepared>;
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
