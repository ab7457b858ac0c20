// Keys that several structures of a scene have.
#pragma once

#include "fields.hpp"

namespace dovetail::scene {

inline constexpr const char* axisNames[] = {"x", "y", "z"};
inline constexpr const char* sides[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
inline constexpr std::int64_t many = std::int64_t{1} << 40, anySeed = std::int64_t{1} << 53;

inline void poisson(Fields& f, double& value) {
  f.number({"poisson_ratio", "Poisson's ratio"}, value, between(-1.0, 0.5, true, true));
}
inline void young(Fields& f, double& value) {
  f.number({"youngs_modulus", "Young's modulus"}, value, positive(unit::pressure));
}
inline void density(Fields& f, double& value) {
  f.number({"density", "mass per volume"}, value, positive(unit::density));
}
inline void velocity(Fields& f, Vec3& value, const char* help) { f.vector({"velocity", help}, value, unit::velocity); }
inline void contactMaterial(Fields& f, std::string& value) {
  f.text({"contact_material", "used by \"contacts\"; if not given, the law of \"contact\" holds"}, value, false);
}
/// A steady or changing velocity, or a displacement in its place.
inline void path(Fields& f, TimeVector& velocity, std::optional<TimeVector>& displacement) {
  f.functions({"velocity", "may be expressions of the time t"}, velocity, unit::velocity);
  f.functions({"displacement", "in place of a velocity: expressions of the time t"}, displacement, unit::length);
}

}  // namespace dovetail::scene
