// Springs between grains of a cell: linear ones, and those of elastic spheres.
#pragma once

#include <cmath>

namespace dovetail::rve {

/// A contact of overlap δ > 0 presses with k_n δ, and resists sliding with a spring k_t that slips at the friction
/// coefficient times the normal force; it may resist rolling with a spring k_r that slips at η r_min times that force.
/// Liang & Zhao, Int. J. Numer. Anal. Methods Geomech. 43, 2019, eqs 20–28; with one stiffness for all contacts Liu,
/// thesis TU Eindhoven 2018, eq. 2.6.
///
/// Elastic spheres (Hertz and Mindlin): the normal force is ⅔ k_n δ with k_n = 2 E* √(R* δ), R* = r_i r_j / (r_i +
/// r_j), and k_t grows with k_n: the tangential force changes by k_t per slip (Liu, Sun, Yuan & Fish 2015, eqs 53–55).
/// So that no energy appears, it falls with k_t while the contact is unloaded (Thornton, Cummins & Cleary, Powder
/// Technol. 233, 2013); what springs lose by k_t's changes is booked as friction.
struct Springs {
  double modulus = 0.0;       ///< E, Pa: k_n = 2 E r_i r_j / (r_i + r_j); 0: another one counts
  double stiffness = 0.0;     ///< k_n of all contacts, N/m; 0: another one counts
  double hertz = 0.0;         ///< E* of elastic spheres, Pa; 0: the springs are linear
  double tangential = 0.8;    ///< k_t / k_n, ≥ 0
  double friction = 0.5;      ///< coefficient, ≥ 0; infinite: nothing slides
  double rolling = 0.0;       ///< β in k_r = β k_t r_i r_j, ≥ 0, discs only; 0: grains roll freely
  double rollingLimit = 0.0;  ///< η, ≥ 0

  friend bool operator==(const Springs&, const Springs&) = default;
  bool elasticSpheres() const { return hertz > 0.0; }
  bool slides() const { return friction > 0.0 && tangential > 0.0; }
  bool rolls() const { return rolling > 0.0 && rollingLimit > 0.0 && tangential > 0.0; }
};

/// k_n, N/m, of two grains with radii a and b, m; of elastic spheres k_n/√δ, N/m^(3/2).
inline double normalStiffness(const Springs& springs, double a, double b) {
  const double both = a * b / (a + b);
  return springs.stiffness + 2.0 * springs.modulus * both + 2.0 * springs.hertz * std::sqrt(both);
}

/// k_n, N/m, at an overlap, m.
inline double slopeAt(const Springs& springs, double normalStiffness, double overlap) {
  return springs.elasticSpheres() ? normalStiffness * std::sqrt(overlap) : normalStiffness;
}

/// Springs of elastic spheres of one material: E* = G/(1 − ν), k_t/k_n = 2 (1 − ν)/(2 − ν).
/// @param shearModulus  G, Pa
/// @param poisson  ν, above −1, at most 0.5
/// @throws InputError if they are not valid
Springs hertzMindlin(double shearModulus, double poisson, double friction);

/// @throws InputError unless one of modulus, stiffness and hertz is given, and all are finite (friction excepted) and ≥
/// 0
void validate(const Springs& springs);

}  // namespace dovetail::rve
