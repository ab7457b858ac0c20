// Resistance to rolling and twisting.
#pragma once

#include "dovetail/dem/laws/laws.hpp"

namespace dovetail::dem {

/// Rolling resistance of spring, dashpot and slider (Iwashita & Oda, J. Eng. Mech. 124, 1998; model C of Ai et al.,
/// Powder Technol. 206, 2011): a couple against the relative spin about axes in the contact plane, k_r = ratio · k_n
/// R*², limited to μ_r R* times the repulsion of the normal part.
struct RollingResistance {
  static constexpr const char* name = "rolling";
  static constexpr int memory = 4;  // angle, rad; k_r of the last step, N m/rad
  static constexpr unsigned turns = 0b0111, carries = 0b1;
  static constexpr bool needsSpin = true, needsRadius = true;
  double friction = 0.0;        ///< μ_r
  double stiffnessRatio = 0.0;  ///< k_r/(k_n R*²); Ai et al. take 2.25 μ_r²
  double dampingRatio = 0.0;    ///< coefficient of the dashpot over that of the normal one times R*²

  struct Prepared {
    double friction, stiffnessRatio, dampingRatio;

    [[gnu::always_inline]] RollingResponse respond(const Contact& contact, const NormalResponse& normal,
                                                   double* held) const {
      const Slope now = slope(contact, normal);
      const auto across = [&](const Vec3& a) { return a - dot(a, contact.normal) * contact.normal; };
      const double limit = normal.force > 0.0 ? friction * contact.effectiveRadius * normal.force : 0.0;
      const Slider<> slider =
          slideGrowing(Vec3{held[0], held[1], held[2]}, held[3], across(contact.turned), across(contact.spin),
                       now.stiffness, normal.firstMean, contact.engagement * now.damping, limit, contact.inverseDt);
      held[0] = slider.stretch.x;
      held[1] = slider.stretch.y;
      held[2] = slider.stretch.z;
      held[3] = now.stiffness;
      return {-slider.force, slider.energy, slider.slipPower, slider.dashpotPower};
    }
    Slope slope(const Contact& contact, const NormalResponse& normal) const {
      const double squared = contact.effectiveRadius * contact.effectiveRadius;
      return {stiffnessRatio * normal.stiffness * squared, dampingRatio * normal.damping * squared};
    }
    bool damps() const { return dampingRatio > 0.0; }
    double remembered(const double* held) const {
      return 0.5 * held[3] * (held[0] * held[0] + held[1] * held[1] + held[2] * held[2]);
    }
  };
  Prepared prepare() const { return {friction, stiffnessRatio, dampingRatio}; }
};

/// The same about the normal: a couple against drilling, k_o = ratio · k_n R*², limited to μ_o R* times the repulsion.
struct TwistingResistance {
  static constexpr const char* name = "twisting";
  static constexpr int memory = 2;      // angle, rad; k_o of the last step, N m/rad
  static constexpr unsigned turns = 0;  // relative spin and normal turn together
  static constexpr bool needsSpin = true, needsRadius = true;
  double friction = 0.0;        ///< μ_o
  double stiffnessRatio = 0.0;  ///< k_o/(k_n R*²)
  double dampingRatio = 0.0;    ///< coefficient of the dashpot over that of the normal one times R*²

  struct Prepared {
    double friction, stiffnessRatio, dampingRatio;

    [[gnu::always_inline]] RollingResponse respond(const Contact& contact, const NormalResponse& normal,
                                                   double* held) const {
      const Slope now = slope(contact, normal);
      const double limit = normal.force > 0.0 ? friction * contact.effectiveRadius * normal.force : 0.0;
      const auto slider =
          slideGrowing(held[0], held[1], dot(contact.turned, contact.normal), dot(contact.spin, contact.normal),
                       now.stiffness, normal.firstMean, contact.engagement * now.damping, limit, contact.inverseDt);
      held[0] = slider.stretch;
      held[1] = now.stiffness;
      return {-slider.force * contact.normal, slider.energy, slider.slipPower, slider.dashpotPower};
    }
    Slope slope(const Contact& contact, const NormalResponse& normal) const {
      const double squared = contact.effectiveRadius * contact.effectiveRadius;
      return {stiffnessRatio * normal.stiffness * squared, dampingRatio * normal.damping * squared};
    }
    bool damps() const { return dampingRatio > 0.0; }
    double remembered(const double* held) const { return 0.5 * held[1] * held[0] * held[0]; }
  };
  Prepared prepare() const { return {friction, stiffnessRatio, dampingRatio}; }
};

/// Both.
struct RollingAndTwisting {
  RollingResistance rolling;
  TwistingResistance twisting;
  static constexpr const char* name = "rolling and twisting";
  static constexpr int memory = RollingResistance::memory + TwistingResistance::memory;
  static constexpr unsigned turns = RollingResistance::turns | TwistingResistance::turns << RollingResistance::memory;
  static constexpr unsigned carries = RollingResistance::carries;
  static constexpr bool needsSpin = true, needsRadius = true;

  struct Prepared {
    RollingResistance::Prepared rolling;
    TwistingResistance::Prepared twisting;

    [[gnu::always_inline]] RollingResponse respond(const Contact& contact, const NormalResponse& normal,
                                                   double* held) const {
      const RollingResponse a = rolling.respond(contact, normal, held);
      const RollingResponse b = twisting.respond(contact, normal, held + RollingResistance::memory);
      return {a.couple + b.couple, a.energy + b.energy, a.slipPower + b.slipPower, a.dashpotPower + b.dashpotPower};
    }
    Slope slope(const Contact& contact, const NormalResponse& normal) const {
      const Slope a = rolling.slope(contact, normal), b = twisting.slope(contact, normal);
      return {a.stiffness > b.stiffness ? a.stiffness : b.stiffness, a.damping > b.damping ? a.damping : b.damping};
    }
    bool damps() const { return rolling.damps() || twisting.damps(); }
    double remembered(const double* held) const {
      return rolling.remembered(held) + twisting.remembered(held + RollingResistance::memory);
    }
  };
  Prepared prepare() const { return {rolling.prepare(), twisting.prepare()}; }
};

/// @throws InputError: stiffness ratio not finite and > 0; friction or damping ratio not finite and ≥ 0
void validate(const RollingResistance& part);
void validate(const TwistingResistance& part);
inline void validate(const RollingAndTwisting& part) {
  validate(part.rolling);
  validate(part.twisting);
}

}  // namespace dovetail::dem
