// Keys of sizes of grains.
#include "keys.hpp"

namespace dovetail::scene {

namespace {
void bounds(Fields& f, double& smallest, double& largest) {
  f.number({"smallest", "radius; smaller ones do not occur"}, smallest, positive(unit::length));
  f.number({"largest", "radius; larger ones do not occur"}, largest, positive(unit::length));
}
}  // namespace

void describe(Fields& f, SizeRange& v) { bounds(f, v.smallest, v.largest); }
void describe(Fields& f, NormalSizes& v) {
  f.number({"mean", "radius"}, v.mean, positive(unit::length));
  f.number({"deviation", "standard deviation of the radius"}, v.deviation, notNegative(unit::length));
  bounds(f, v.smallest, v.largest);
}
void describe(Fields& f, LogNormalSizes& v) {
  f.number({"median", "radius"}, v.median, positive(unit::length));
  f.number({"log_deviation", "standard deviation of the natural logarithm of the radius"}, v.logDeviation,
           notNegative(unit::none));
  bounds(f, v.smallest, v.largest);
}
void describe(Fields& f, SizeClass& v) {
  f.number({"radius", "of all grains of the class"}, v.radius, positive(unit::length));
  f.number({"number", "of grains, relative to the other classes"}, v.number, positive(unit::none));
}
void describe(Fields& f, SizeClasses& v) { f.list({"classes", "radii and relative numbers"}, v.classes, true); }
void describe(Fields& f, Sieve& v) {
  f.number({"opening", "diameter of the largest grains that pass"}, v.opening, positive(unit::length));
  f.number({"passing", "fraction of the mass that passes"}, v.passing, between(0.0, 1.0));
}
void describe(Fields& f, SieveCurve& v) {
  f.list({"sieves", "the finest first, passing from 0 to 1; between two the mass is even in the logarithm of the size"},
         v.sieves, true);
}
void describe(Fields& f, Sizes& v) {
  static constexpr const char* kinds[] = {"uniform", "normal", "log-normal", "classes", "sieves"};
  f.oneOf({"distribution", "of the radii: the first three by number between two bounds; sieves: by mass"},
          v.distribution, kinds, false);
}

}  // namespace dovetail::scene
