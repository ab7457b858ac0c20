// Liquid between wet grains: a pull beyond touch.
#pragma once

#include <numbers>

#include "dovetail/dem/laws/laws.hpp"

namespace dovetail::dem {

/// A pendular bridge between equal spheres of radius R, or others with R = 2 R*, a distance S apart, in closed form:
///   F = −2π R γ cos θ/(1 + 1.05 s + 2.5 s²),   s = S √(R/V)
/// (Willett, Adams, Johnson & Seville, Langmuir 16, 2000, eq. 12), and −2π R γ cos θ while the grains touch. It forms
/// when they touch and ruptures at S = (1 + θ/2) V^(1/3) (Lian, Thornton & Adams, J. Colloid Interface Sci. 161, 1993).
/// Its energy counts from touch; what it holds at rupture is lost and booked as fracture.
struct LiquidBridge {
  double surfaceTension = 0.0;  ///< γ ≥ 0, N/m
  double volume = 0.0;          ///< V > 0 of each bridge, m³
  double contactAngle = 0.0;    ///< θ, rad, in [0, π/2)

  static constexpr const char* name = "liquid bridge";
  static constexpr int memory = 1;  // what it will hold at rupture, J; 0: there is none
  static constexpr bool needsRadius = true;

  struct Prepared {
    double pullPerRadius;  ///< 4π γ cos θ, N/m: on R*
    double inverseVolume;  ///< 1/V
    double rupture;        ///< m

    /// @param held  > 0 once they have touched
    AdhesionResponse respond(const Contact& contact, const NormalResponse&, double* held) const {
      const double pull = pullPerRadius * contact.effectiveRadius;
      const double scale = std::sqrt(2.0 * contact.effectiveRadius * inverseVolume);
      const bool touches = contact.overlap > 0.0;
      const double atRupture = pull / scale * work(scale * rupture);
      const bool formed = held[0] > 0.0, again = formed && touches && !(contact.overlapBefore > 0.0);
      const double engagement = again ? 1.0 : contact.engagementUntilEnd;
      held[0] = touches || formed ? atRupture : 0.0;
      if (!(held[0] > 0.0)) return {};
      if (touches) return {-engagement * pull, -pull * contact.overlap};
      const double s = -scale * contact.overlap;
      return {-engagement * pull / (1.0 + s * (a + b * s)), pull / scale * work(s)};
    }
    double reach() const { return rupture; }
    double remembered(const double* held) const { return held[0]; }

  private:
    static constexpr double a = 1.05, b = 2.5;
    /// ∫ ds/(1 + a s + b s²) from 0 to s
    static double work(double s) {
      static const double root = std::sqrt(4.0 * b - a * a), start = std::atan(a / root);
      return 2.0 / root * (std::atan((2.0 * b * s + a) / root) - start);
    }
  };
  Prepared prepare() const {
    return {4.0 * std::numbers::pi * surfaceTension * std::cos(contactAngle), 1.0 / volume,
            (1.0 + 0.5 * contactAngle) * std::cbrt(volume)};
  }
};

/// @throws InputError: γ not finite and ≥ 0, V not finite and > 0, θ outside [0, π/2)
void validate(const LiquidBridge& part);

}  // namespace dovetail::dem
