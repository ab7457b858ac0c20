// Elastic spheres: Hertz's normal force with restitution, Mindlin's tangential stiffness with Coulomb's limit.
#pragma once

#include "dovetail/dem/laws/laws.hpp"

namespace dovetail::dem {

/// Elastic spheres: force over slope and overlap, and energy over force and overlap.
inline constexpr double hertzForce = 2.0 / 3.0, hertzEnergy = 0.4;

/// Normal part: F = (4/3) E* √(R* δ) δ + c dδ/dt with c = √(10/3) ζ √(m k_n), k_n = 2 E* √(R* δ) being the slope of the
/// elastic force (Tsuji, Tanaka & Ishida, Powder Technol. 71, 1992). In the phase plane this is a linear damped
/// oscillator of damping ratio ζ in δ^(5/4) (Antypov & Elliott, EPL 94, 2011), so e is the same for every speed and
/// size, exactly.
///
/// Which restitution: separation speed / approach speed is e, with and without tension; ζ is chosen accordingly (see
/// restitution.hpp). With `nominal` and without tension ζ is the one for which a contact with tension has e; the
/// rebound is then restitutionWithoutTension(e) ≥ e, as in codes that cut the force off afterwards.
struct HertzDashpot {
  double effectiveModulus = 0.0;  ///< E*, Pa, see effectiveModulus() in materials.hpp
  double restitution = 1.0;       ///< e, in (0, 1]; 1 = no dashpot
  bool tension = false;           ///< whether the force may be tensile while particles separate
  bool nominal = false;           ///< without tension: e is that of a contact with tension

  static constexpr const char* name = "Hertz";
  static constexpr int memory = 0;
  static constexpr unsigned turns = 0;
  static constexpr bool needsMass = true, needsRadius = true;

  struct Prepared {
    double twiceModulus;   ///< 2 E*, Pa
    double dampingFactor;  ///< c/√(m k_n)
    double leastForce;     ///< N; −∞ if the contact may pull

    [[gnu::always_inline]] NormalResponse respond(const Contact& contact, double*) const {
      const double stiffness = twiceModulus * std::sqrt(contact.effectiveRadius * contact.overlap);
      const double damping = dampingFactor * contact.rootMass * std::sqrt(stiffness);
      const double elastic = hertzForce * stiffness * contact.overlap;
      const double seen = seenBy(contact, stiffness), whole = elastic - contact.engagement * damping * seen;
      const double force = whole < leastForce ? leastForce : whole;
      return {.force = force,
              .stiffness = stiffness,
              .firstMean = 2.0 / 3.0,
              .damping = damping,
              .energy = hertzEnergy * elastic * contact.overlap,
              .dashpotPower = (elastic - force) * seen};
    }
    /// Damping grows from touch as t^¼: what the sum over steps lacks of the integral is ζ(−¼, θ), Hurwitz's zeta
    /// function (Navot, J. Math. Phys. 40, 1961), so this is −ζ(−¼, 1 + θ)/θ^¼, to 2e-4.
    static double engagement(double fraction) {
      const double t = fraction > 1e-12 ? fraction : 1e-12;
      return (0.32027438 + t * (0.8641871 + t * (0.16402912 - t * 0.02817562))) / std::sqrt(std::sqrt(t));
    }
    bool pulls() const { return leastForce < 0.0; }
    double reach() const { return 0.0; }
    bool usesMass() const { return dampingFactor > 0.0; }
    double remembered(const double*) const { return 0.0; }
  };
  Prepared prepare() const;

  /// ζ
  double dampingRatio() const;
  /// Largest overlap of an elastic impact at speed v, m: (15 m v²/(16 E* √R*))^(2/5).
  double largestOverlap(double effectiveMass, double effectiveRadius, double speed) const;
  /// Duration of an elastic impact at speed v, s: 2.9432… δ_max/v.
  double contactTime(double effectiveMass, double effectiveRadius, double speed) const;
};

/// Tangential part without micro-slip: k_t = 8 G* √(R* δ) (Mindlin, J. Appl. Mech. 16, 1949), which is in a fixed ratio
/// to the normal part's slope k_n; so this part goes with any normal part. The force is limited to μ times the
/// repulsion of the normal part (Coulomb).
///
/// As k_t changes, energy must not appear: see slideGrowing (Walton; Thornton, Cummins & Cleary, Powder Technol. 233,
/// 2013, the rule for decreasing load). The spring energy that this takes is booked with sliding. A dashpot adds at
/// most what the limit leaves, so that spring and dashpot never give back more than went in.
struct MindlinSpring {
  static constexpr const char* name = "Mindlin";
  static constexpr int memory = 4;  // stretch, m; k_t of the last step, N/m
  static constexpr unsigned turns = 0b0111, carries = 0b1;
  static constexpr bool needsSlip = true;
  double stiffnessRatio = 0.0;  ///< k_t/k_n = 4 G*/E*, see mindlinRatio() in materials.hpp
  double friction = 0.0;        ///< μ
  double dampingRatio = 0.0;    ///< coefficient of the tangential dashpot over that of the normal one

  template <bool dashpot>
  struct PreparedSpring {
    double stiffnessRatio, friction, dampingRatio;

    [[gnu::always_inline]] TangentialResponse respond(const Contact& contact, const NormalResponse& normal,
                                                      double* held) const {
      const double limit = normal.force > 0.0 ? friction * normal.force : 0.0;
      const double stiffness = stiffnessRatio * normal.stiffness;
      const Slider<dashpot> now = slideGrowing<dashpot>(
          Vec3{held[0], held[1], held[2]}, held[3], contact.slipped, contact.slip, stiffness, normal.firstMean,
          dampingRatio * contact.engagement * normal.damping, limit, contact.inverseDt);
      held[0] = now.stretch.x;
      held[1] = now.stretch.y;
      held[2] = now.stretch.z;
      held[3] = stiffness;
      return {.force = -now.force, .energy = now.energy, .slipPower = now.slipPower, .dashpotPower = now.dashpotPower};
    }
    Slope slope(const Contact&, const NormalResponse& normal) const {
      return {stiffnessRatio * normal.stiffness, dampingRatio * normal.damping};
    }
    double remembered(const double* held) const {
      return 0.5 * held[3] * (held[0] * held[0] + held[1] * held[1] + held[2] * held[2]);
    }
    bool damps() const { return dampingRatio > 0.0; }
    PreparedSpring<false> withoutDashpot() const { return {stiffnessRatio, friction, 0.0}; }
  };
  using Prepared = PreparedSpring<true>;
  Prepared prepare() const { return {stiffnessRatio, friction, dampingRatio}; }
};

/// @throws InputError: E* not > 0; restitution outside (0, 1]; tension together with nominal; ratio not > 0; friction
/// or damping ratio not finite and ≥ 0
void validate(const HertzDashpot& part);
void validate(const MindlinSpring& part);

using HertzLaw = ContactLaw<HertzDashpot>;
using HertzMindlinLaw = ContactLaw<HertzDashpot, MindlinSpring>;

}  // namespace dovetail::dem
