// Attraction of touching particles. It adds to the normal part; friction and rolling resistance are limited by the
// repulsion of the normal part alone, so that pressed and attracted grains have the friction that their overlap gives.
#pragma once

#include <numbers>

#include "dovetail/dem/laws/laws.hpp"

namespace dovetail::dem {

/// F = −F₀ while particles touch; energy −F₀ δ.
struct ConstantCohesion {
  double force = 0.0;  ///< F₀ ≥ 0, N
  static constexpr const char* name = "constant cohesion";
  static constexpr bool needsRadius = false;
  struct Prepared {
    double force;
    [[gnu::always_inline]] AdhesionResponse respond(const Contact& contact, const NormalResponse&) const {
      return {-contact.engagementUntilEnd * force, -force * contact.overlap};
    }
  };
  Prepared prepare() const { return {force}; }
};

/// F = −(k_c + p π R*) δ, a pull in proportion to the overlap, or to the area π R* δ of Hertz's contact; energy ½ F δ.
/// Linear normal parts must be stiffer than it, or particles sink into each other.
struct LinearCohesion {
  double stiffness = 0.0;  ///< k_c ≥ 0, N/m
  double pressure = 0.0;   ///< p ≥ 0, Pa (energy per volume, J/m³)
  static constexpr const char* name = "linear cohesion";
  static constexpr bool needsRadius = true;
  struct Prepared {
    double stiffness, pressureTimesPi;
    [[gnu::always_inline]] AdhesionResponse respond(const Contact& contact, const NormalResponse&) const {
      const double force = -(stiffness + pressureTimesPi * contact.effectiveRadius) * contact.overlap;
      return {force, 0.5 * force * contact.overlap};
    }
  };
  Prepared prepare() const { return {stiffness, std::numbers::pi * pressure}; }
};

/// F = −2π w R* while particles touch (Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53, 1975): small, stiff
/// grains, on Hertz's normal part.
struct DmtAdhesion {
  double work = 0.0;  ///< w ≥ 0, J/m², to separate the surfaces; twice the surface energy of equal materials
  static constexpr const char* name = "DMT";
  static constexpr bool needsRadius = true;
  struct Prepared {
    double forcePerRadius;
    [[gnu::always_inline]] AdhesionResponse respond(const Contact& contact, const NormalResponse&) const {
      const double force = -forcePerRadius * contact.effectiveRadius;
      return {contact.engagementUntilEnd * force, force * contact.overlap};
    }
  };
  Prepared prepare() const { return {2.0 * std::numbers::pi * work}; }
};

/// All of these in one: F = −(F₀ + 2π w R*) − (k_c + p π R*) δ.
struct Cohesion {
  double force = 0.0;      ///< F₀ ≥ 0, N
  double stiffness = 0.0;  ///< k_c ≥ 0, N/m
  double pressure = 0.0;   ///< p ≥ 0, Pa
  double work = 0.0;       ///< w ≥ 0, J/m²
  static constexpr const char* name = "cohesion";
  static constexpr bool needsRadius = true;

  Cohesion() = default;
  Cohesion(double f, double k, double p, double w) : force(f), stiffness(k), pressure(p), work(w) {}
  Cohesion(const ConstantCohesion& part) : force(part.force) {}
  Cohesion(const LinearCohesion& part) : stiffness(part.stiffness), pressure(part.pressure) {}
  Cohesion(const DmtAdhesion& part) : work(part.work) {}

  struct Prepared {
    double force, stiffness, pressureTimesPi, forcePerRadius;
    [[gnu::always_inline]] AdhesionResponse respond(const Contact& contact, const NormalResponse&) const {
      const double always = -(force + forcePerRadius * contact.effectiveRadius);
      const double growing = -(stiffness + pressureTimesPi * contact.effectiveRadius) * contact.overlap;
      return {contact.engagementUntilEnd * always + growing, (always + 0.5 * growing) * contact.overlap};
    }
  };
  Prepared prepare() const { return {force, stiffness, std::numbers::pi * pressure, 2.0 * std::numbers::pi * work}; }
};

/// @throws InputError: a parameter not finite and ≥ 0
void validate(const ConstantCohesion& part);
void validate(const LinearCohesion& part);
void validate(const DmtAdhesion& part);
void validate(const Cohesion& part);

}  // namespace dovetail::dem
