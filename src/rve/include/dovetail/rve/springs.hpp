// Linear springs between grains of a cell.
#pragma once

namespace dovetail::rve {

/// A contact of overlap δ > 0 presses with k_n δ, and resists sliding with a spring k_t that slips at the friction
/// coefficient times the normal force; it may resist rolling with a spring k_r that slips at η r_min times that force.
/// Liang & Zhao, Int. J. Numer. Anal. Methods Geomech. 43, 2019, eqs 20–28; with one stiffness for all contacts Liu,
/// thesis TU Eindhoven 2018, eq. 2.6.
struct Springs {
  double modulus = 0.0;       ///< E, Pa: k_n = 2 E r_i r_j / (r_i + r_j); 0: `stiffness` counts
  double stiffness = 0.0;     ///< k_n of all contacts, N/m; 0: `modulus` counts
  double tangential = 0.8;    ///< k_t / k_n, ≥ 0
  double friction = 0.5;      ///< coefficient, ≥ 0; infinite: nothing slides
  double rolling = 0.0;       ///< β in k_r = β k_t r_i r_j, ≥ 0, discs only; 0: grains roll freely
  double rollingLimit = 0.0;  ///< η, ≥ 0

  friend bool operator==(const Springs&, const Springs&) = default;
  bool slides() const { return friction > 0.0 && tangential > 0.0; }
  bool rolls() const { return rolling > 0.0 && rollingLimit > 0.0 && tangential > 0.0; }
};

/// k_n, N/m, of two grains with radii a and b, m.
inline double normalStiffness(const Springs& springs, double a, double b) {
  return springs.stiffness + 2.0 * springs.modulus * a * b / (a + b);
}

/// @throws InputError unless one of modulus and stiffness is given, and all are finite (friction excepted) and ≥ 0
void validate(const Springs& springs);

}  // namespace dovetail::rve
