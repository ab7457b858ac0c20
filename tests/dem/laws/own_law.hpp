// A law that the library does not list: its normal part is a cubic spring.
#pragma once

#include <memory>

#include "dovetail/dem/laws/contact_laws.hpp"

namespace dovetail::dem {

struct CubicSpring {
  double stiffness = 0.0;  // F = k δ³, N/m³
  static constexpr int memory = 0;
  static constexpr unsigned turns = 0;
  static constexpr bool needsMass = false, needsRadius = false;
  struct Prepared {
    double stiffness;
    [[gnu::always_inline]] NormalResponse respond(const Contact& contact, double*) const {
      const double d = contact.overlap, force = stiffness * d * d * d;
      return {.force = force, .stiffness = 3.0 * stiffness * d * d, .energy = 0.25 * force * d};
    }
    double reach() const { return 0.0; }
    bool usesMass() const { return false; }
    double remembered(const double*) const { return 0.0; }
  };
  Prepared prepare() const { return {stiffness}; }
};

std::shared_ptr<const ContactLaws> makeOwnLaws(const ContactLaw<CubicSpring, MindlinSpring>& law);

}  // namespace dovetail::dem
