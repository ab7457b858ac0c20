// Contact laws of one's own, compiled: laws = dv.load_laws("own_laws.so").
#include "dovetail/dem/laws/own_laws.hpp"

#include "dovetail/dem/laws/law_library.hpp"

namespace {

using namespace dovetail::dem;

/// Normal part of grains with rough faces, which stiffen as they are pressed together: F = k δ (1 + δ²/h²) + c dδ/dt,
/// not below zero.
struct Stiffening {
  double stiffness;     ///< k of the first touch, N/m
  double height;        ///< h of the roughness, m
  double dampingRatio;  ///< ζ; c = 2 ζ √(k m*)
  static constexpr const char* name = "stiffening";
  static constexpr int memory = 0;
  static constexpr unsigned turns = 0;
  static constexpr bool needsMass = true, needsRadius = false;

  struct Prepared {
    double stiffness, perSquare, dampingPerRootMass;

    [[gnu::always_inline]] NormalResponse respond(const Contact& contact, double*) const {
      const double squared = perSquare * contact.overlap * contact.overlap;
      const double spring = stiffness * contact.overlap * (1.0 + squared);
      const double slope = stiffness * (1.0 + 3.0 * squared), damping = dampingPerRootMass * contact.rootMass;
      const double seen = seenBy(contact, slope), dashpot = contact.engagement * damping * seen;
      const double force = spring > dashpot ? spring - dashpot : 0.0;
      return {.force = force,
              .stiffness = slope,
              .damping = damping,
              .energy = 0.5 * stiffness * contact.overlap * contact.overlap * (1.0 + 0.5 * squared),
              .dashpotPower = (spring - force) * seen};
    }
    double reach() const { return 0.0; }
    bool usesMass() const { return dampingPerRootMass > 0.0; }
    double remembered(const double*) const { return 0.0; }
  };
  Prepared prepare() const { return {stiffness, 1.0 / (height * height), 2.0 * dampingRatio * std::sqrt(stiffness)}; }
};

void validate(const Stiffening& part) {
  if (part.stiffness > 0.0 && part.height > 0.0 && part.dampingRatio >= 0.0) return;
  throw dovetail::InputError("k and h must be > 0, and the damping ratio >= 0", "stiffening law", "give SI units");
}

/// The spring of the library, to show that laws compiled here are as fast as those compiled there.
struct SameSpring : LinearSpringDashpot {};

}  // namespace

DOVETAIL_LAWS(library) {
  library.add("stiffening", {{"k", 1e5}, {"height", 1e-4}, {"damping_ratio", 0.1}, {"friction", 0.0}},
              [](const LawParameters& p) {
                return makeContactLaws(ContactLaw<Stiffening, TangentialSpring>{
                    {p.at("k"), p.at("height"), p.at("damping_ratio")},
                    {.stiffness = 2.0 / 7.0 * p.at("k"), .friction = p.at("friction")}});
              });
  library.add("linear", {{"k", 1e5}, {"restitution", 1.0}, {"friction", 0.0}}, [](const LawParameters& p) {
    return makeContactLaws(
        ContactLaw<SameSpring, TangentialSpring>{{{.stiffness = p.at("k"), .restitution = p.at("restitution")}},
                                                 {.stiffness = 2.0 / 7.0 * p.at("k"), .friction = p.at("friction")}});
  });
}
