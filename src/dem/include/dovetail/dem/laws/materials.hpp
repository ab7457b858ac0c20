// From materials to laws.
#pragma once

#include <span>
#include <string>

#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/laws/law_table.hpp"

namespace dovetail::dem {

/// What a grain or a wall is made of.
struct Material {
  double youngsModulus = 0.0;  ///< E, Pa; infinite = rigid
  double poissonRatio = 0.0;   ///< ν, −1 < ν ≤ 0.5
  double density = 0.0;        ///< kg/m³; of no concern to walls
};

/// How values of two materials become one of the pair.
enum class Mean { harmonic, geometric, arithmetic, smaller, larger };
/// harmonic: 2ab/(a + b); geometric: √(ab); a, b ≥ 0.
double mean(Mean rule, double a, double b);

/// E*, Pa: 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂. Infinite if both are rigid.
double effectiveModulus(const Material& a, const Material& b);
/// G*, Pa: 1/G* = (2 − ν₁)/G₁ + (2 − ν₂)/G₂, G = E/(2 (1 + ν)).
double effectiveShearModulus(const Material& a, const Material& b);
/// Mindlin's k_t/k_n = 4 G*/E*; of equal materials 2 (1 − ν)/(2 − ν).
double mindlinRatio(const Material& a, const Material& b);

/// What belongs to a pair of surfaces rather than to a material.
struct Surface {
  double restitution = 1.0;             ///< e, in (0, 1]
  double friction = 0.0;                ///< μ
  double tangentialDampingRatio = 0.0;  ///< see MindlinSpring
};
/// Restitution and friction of a pair from those that both have with their like; `rule` is the caller's choice, no
/// theory's.
Surface mean(Mean rule, const Surface& a, const Surface& b);

/// Hertz–Mindlin law of two materials.
/// @throws InputError naming the field: E not > 0, ν outside (−1, 0.5], both materials rigid, or what validate refuses
HertzMindlinLaw hertzMindlin(const Material& a, const Material& b, const Surface& surface);

/// Stiffness of the linear spring with which an elastic impact at speed v goes as deep as Hertz's, N/m:
/// k = (16/15) √R* E* (15 m v²/(16 √R* E*))^(1/5). Take the largest speed expected.
double equivalentStiffness(const Material& a, const Material& b, double effectiveRadius, double effectiveMass,
                           double speed);

/// Laws for all pairs, lawOf(a, b) for materials a ≤ b; override single pairs by LawTable::set.
/// @throws InputError if there is no material or more than 256
template <class LawOf>
auto makeLawTable(int materials, LawOf&& lawOf) {
  LawTable table(materials, lawOf(0, 0));
  for (int a = 0; a < materials; ++a)
    for (int b = a; b < materials; ++b) table.set(a, b, lawOf(a, b));
  return table;
}

/// Hertz–Mindlin laws of all pairs; surfaces[a] is that of material a with its like, mixed by the rule.
/// Two rigid materials count as walls, which never meet: their entry is that of a rigid one and the first that is not.
/// @throws InputError naming the material and the field; if the spans differ in length or all materials are rigid
LawTable<HertzMindlinLaw> hertzMindlinTable(std::span<const Material> materials, std::span<const Surface> surfaces,
                                            Mean rule = Mean::geometric);

/// @throws InputError: E not > 0, ν outside (−1, 0.5], density not finite and ≥ 0
void validate(const Material& material, const std::string& name = "material");

}  // namespace dovetail::dem
