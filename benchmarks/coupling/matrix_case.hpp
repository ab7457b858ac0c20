// The combinations of elements, materials, couplings, contact laws and macro steps that a coupled run may be made of.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace dovetail::coupling_matrix {

enum class Element { hex8, enhanced, hex20, tet4, tet10 };
enum class SolidLaw { stVenantKirchhoff, neoHookean, j2, druckerPrager };
enum class Joint { surface, penalty, multipliers };
enum class ContactKind { frictional, hertzMindlin, rolling };
enum class MacroSteps { explicit1, explicit4, implicit1, implicit4 };

/// One level of each factor.
struct Case {
  Element element = Element::hex8;
  SolidLaw law = SolidLaw::stVenantKirchhoff;
  Joint joint = Joint::surface;
  ContactKind contact = ContactKind::frictional;
  MacroSteps macroSteps = MacroSteps::explicit1;

  bool isImplicit() const { return macroSteps == MacroSteps::implicit1 || macroSteps == MacroSteps::implicit4; }
  int stepsPerMacroStep() const {
    return macroSteps == MacroSteps::explicit4 || macroSteps == MacroSteps::implicit4 ? 4 : 1;
  }
};

inline constexpr std::size_t factors = 5;
inline constexpr std::array<int, factors> levels{5, 4, 3, 3, 4};
inline constexpr std::array<const char*, factors> factorNames{"element", "material", "joint", "contact law",
                                                              "macro steps"};

/// Numbers of the levels, in the order of the factors, and back.
std::array<int, factors> levelsOf(const Case& c);
Case caseOf(const std::array<int, factors>& level);
std::string levelName(std::size_t factor, int level);
/// "hex8 StVK surface frictional explicit1"
std::string nameOf(const Case& c);

/// All 720, the last factor fastest.
std::vector<Case> allCases();
/// A few that hold every pair of levels of two factors: one after the other, always the first of those that hold most
/// pairs not held yet.
std::vector<Case> pairwiseCases();

}  // namespace dovetail::coupling_matrix
