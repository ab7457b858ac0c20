// Keys of contact laws.
#include "keys.hpp"

namespace dovetail::scene {

void describe(Fields& f, Rolling& v) {
  f.number({"friction", "coefficient: largest moment over (effective radius × normal force)"}, v.friction,
           notNegative(unit::none));
  f.number({"stiffness_ratio", "angular stiffness over (normal stiffness × effective radius²)"}, v.stiffnessRatio,
           positive(unit::none));
  f.number({"damping_ratio", "the same ratio of the damping coefficients"}, v.dampingRatio, notNegative(unit::none));
}
void describe(Fields& f, LinearContact& v) {
  f.number({"stiffness", "of the normal spring"}, v.stiffness, positive(unit::stiffness));
  f.number({"tangential_stiffness", "of the tangential spring; 2/7 of the normal one if not given"},
           v.tangentialStiffness, positive(unit::stiffness));
  f.flag({"bonded", "contacts at the start are bonded springs, as in a lattice; no other contacts form"}, v.bonded);
  f.flag({"tension",
          "whether the normal force may be tensile while grains separate; the restitution is the same either way"},
         v.tension);
}
void describe(Fields& f, HertzContact& v) {
  young(f, v.youngsModulus);
  poisson(f, v.poissonRatio);
}
void describe(Fields& f, ElasticPlasticContact& v) {
  f.number({"stiffness", "of first loading"}, v.stiffness, positive(unit::stiffness));
  f.number({"unloading_stiffness", "of unloading and reloading; the restitution is √(stiffness/unloading_stiffness)"},
           v.unloadingStiffness, positive(unit::stiffness));
  f.number({"cohesion_stiffness", "the pull ends at this times the overlap"}, v.cohesionStiffness,
           notNegative(unit::stiffness));
  f.number({"damping_ratio", "of a dashpot beside the spring of unloading"}, v.dampingRatio, notNegative(unit::none));
  f.number({"tangential_stiffness", "of the tangential spring; 2/7 of the first loading's if not given"},
           v.tangentialStiffness, positive(unit::stiffness));
}
void describe(Fields& f, Adhesion& v) {
  f.number({"force", "constant pull"}, v.force, notNegative(unit::force));
  f.number({"stiffness", "pull over overlap"}, v.stiffness, notNegative(unit::stiffness));
  f.number({"pressure", "pull over π × effective radius × overlap, an energy density"}, v.pressure,
           notNegative(unit::pressure));
  f.number({"work", "w, to separate surfaces, per area: the pull is 2π w × effective radius (DMT)"}, v.work,
           notNegative(unit::stiffness));
}
void describe(Fields& f, LiquidBridge& v) {
  f.number({"surface_tension", "of the liquid"}, v.surfaceTension, notNegative(unit::stiffness));
  f.number({"volume", "of each bridge, which ruptures at a distance of (1 + angle/2) × its cube root"}, v.volume,
           positive(unit::volume));
  f.number({"contact_angle", "of the liquid on the grains"}, v.contactAngle, {unit::angle, 0.0, 1.5});
}
void describe(Fields& f, ContactLaw& v) {
  static constexpr const char* laws[] = {"linear", "Hertz", "elastic-plastic"};
  f.where(v.where);
  f.oneOf({"law", "normal force: a linear spring, Hertz's with Mindlin's tangential stiffness, or springs with a dent"},
          v.normal, laws);
  f.number({"restitution", "speed after a normal impact over speed before"}, v.restitution, between(0.0, 1.0, true));
  f.number({"friction", "Coulomb's coefficient"}, v.friction, notNegative(unit::none));
  f.number({"tangential_damping_ratio", "tangential over normal damping coefficient"}, v.tangentialDampingRatio,
           notNegative(unit::none));
  f.object({"rolling", "resistance to rolling"}, v.rolling);
  f.object({"twisting", "resistance to twisting"}, v.twisting);
  f.object({"adhesion", "attraction while grains touch: the sum of its parts; friction counts the repulsion only"},
           v.adhesion);
  f.object({"liquid_bridge", "pendular bridge of wet grains, formed when they touch (linear, Hertz)"}, v.liquidBridge);
}
void describe(Fields& f, PairLaw& v) {
  f.text(
      {"between", "first contact material: a name, for \"contact_material\" of grains, walls and surfaces of solids"},
      v.first, true);
  f.text({"and", "second contact material, which may be the first"}, v.second, true);
  describe(f, v.law);
  f.object({"second", "elastic constants of the second material (Hertz); those of the first if not given"}, v.ofSecond);
}

}  // namespace dovetail::scene
