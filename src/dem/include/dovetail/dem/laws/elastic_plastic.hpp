// Contacts with plastic deformation.
#pragma once

#include "dovetail/dem/laws/laws.hpp"

namespace dovetail::dem {

/// Normal part, linear elastic–plastic with optional cohesion (Walton & Braun, J. Rheol. 30, 1986; Luding, Granular
/// Matter 10, 2008). A spring k₂ pulls on a plastic overlap δ₀ that follows within bounds:
///   F = k₂ (δ − δ₀),   (1 − k₁/k₂) δ ≤ δ₀, and with cohesion δ₀ ≤ (1 + k_c/k₂) δ
/// so that first loading runs along k₁ δ, unloading and reloading along k₂, and the pull ends on −k_c δ. Without
/// cohesion F ≥ 0, and the dent δ₀ = (1 − k₁/k₂) δ_max stays until the contact ends.
///
/// ½ F²/k₂ is recoverable; the work of δ₀, F dδ₀ ≥ 0, is booked as plastic. From k₁ and k₂ alone the restitution is
/// √(k₁/k₂), at every speed; a dashpot of damping ratio ζ (of k₂) may damp motion below yield.
struct ElasticPlastic {
  double loadingStiffness = 0.0;    ///< k₁, N/m
  double unloadingStiffness = 0.0;  ///< k₂ ≥ k₁, N/m
  double cohesionStiffness = 0.0;   ///< k_c ≥ 0, N/m
  double dampingRatio = 0.0;        ///< ζ ≥ 0

  static constexpr const char* name = "elastic-plastic";
  static constexpr int memory = 1;  // δ₀, m
  static constexpr unsigned turns = 0;
  static constexpr bool needsMass = true, needsRadius = false;

  struct Prepared {
    double stiffness;             ///< k₂
    double lower, upper;          ///< bounds of δ₀/δ
    double yield, yieldCohesion;  ///< plastic work per ½ δ₀², N/m
    double leastElastic;          ///< N; 0 without cohesion, else −∞
    double dampingPerRootMass;    ///< c/√m

    [[gnu::always_inline]] NormalResponse respond(const Contact& contact, double* held) const {
      const double before = held[0], least = lower * contact.overlap, most = upper * contact.overlap;
      const double raised = before < least ? least : before;
      const double plastic = raised > most ? most : raised;
      held[0] = plastic;
      const double spring = stiffness * (contact.overlap - plastic);
      const double elastic = spring < leastElastic ? leastElastic : spring;
      const double damping = dampingPerRootMass * contact.rootMass;
      const double seen = seenBy(contact, stiffness), whole = elastic - contact.engagement * damping * seen;
      // The dashpot alone neither pulls nor deepens the pull.
      const double floor = elastic < 0.0 ? elastic : 0.0;
      const double force = whole < floor ? floor : whole;
      const double change = plastic * plastic - before * before;
      return {.force = force,
              .stiffness = stiffness,
              .damping = damping,
              .energy = 0.5 * elastic * elastic / stiffness,
              .dashpotPower = (elastic - force) * seen,
              .plasticPower = 0.5 * (change > 0.0 ? yield * change : -yieldCohesion * change) * contact.inverseDt};
    }
    double reach() const { return 0.0; }
    bool usesMass() const { return dampingPerRootMass > 0.0; }
    /// What closing the rest of the dent along −k_c δ takes.
    double remembered(const double* held) const { return 0.5 * yieldCohesion * held[0] * held[0]; }
  };
  Prepared prepare() const;

  /// √(k₁/k₂), without cohesion and dashpot
  double restitution() const { return std::sqrt(loadingStiffness / unloadingStiffness); }
};

/// @throws InputError: k₁ not finite and > 0; k₂ < k₁; k_c or ζ not finite and ≥ 0
void validate(const ElasticPlastic& part);

}  // namespace dovetail::dem
