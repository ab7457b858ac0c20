// The laws that the library compiles, and which of them stands for a law that leaves parts of it out.
#pragma once

#include <string>
#include <type_traits>

#include "dovetail/dem/laws/adhesion.hpp"
#include "dovetail/dem/laws/elastic_plastic.hpp"
#include "dovetail/dem/laws/hertz_mindlin.hpp"
#include "dovetail/dem/laws/law_table.hpp"
#include "dovetail/dem/laws/liquid_bridge.hpp"
#include "dovetail/dem/laws/rolling.hpp"

namespace dovetail::dem {

template <class... Laws>
struct LawList {
  template <class Law>
  static constexpr bool has = (std::is_same_v<Law, Laws> || ...);
};

/// Every combination of a normal part and a tangential part with and without resistance to rolling and cohesion.
template <class Normal, class Tangential>
using FrictionalLaws = LawList<ContactLaw<Normal, Tangential>, ContactLaw<Normal, Tangential, RollingAndTwisting>,
                               ContactLaw<Normal, Tangential, NoRolling, Cohesion>,
                               ContactLaw<Normal, Tangential, RollingAndTwisting, Cohesion>>;
template <class Normal>
using SmoothLaws = LawList<ContactLaw<Normal>, ContactLaw<Normal, NoTangential, NoRolling, Cohesion>>;

template <class Normal, class Tangential>
using WetLaws = LawList<ContactLaw<Normal, Tangential, NoRolling, LiquidBridge>,
                        ContactLaw<Normal, Tangential, RollingAndTwisting, LiquidBridge>>;

template <class Law>
inline constexpr bool isListed =
    SmoothLaws<LinearSpringDashpot>::has<Law> || FrictionalLaws<LinearSpringDashpot, TangentialSpring>::has<Law> ||
    SmoothLaws<HertzDashpot>::has<Law> || FrictionalLaws<HertzDashpot, MindlinSpring>::has<Law> ||
    SmoothLaws<ElasticPlastic>::has<Law> || FrictionalLaws<ElasticPlastic, TangentialSpring>::has<Law> ||
    FrictionalLaws<ElasticPlastic, MindlinSpring>::has<Law> ||
    WetLaws<LinearSpringDashpot, TangentialSpring>::has<Law> || WetLaws<HertzDashpot, MindlinSpring>::has<Law>;

namespace detail {

inline RollingAndTwisting bothSpins(const RollingResistance& part) { return {part, {}}; }
inline RollingAndTwisting bothSpins(const TwistingResistance& part) { return {{}, part}; }
template <class Part>
Part bothSpins(const Part& part) {
  return part;
}

inline Cohesion allPulls(const ConstantCohesion& part) { return part; }
inline Cohesion allPulls(const LinearCohesion& part) { return part; }
inline Cohesion allPulls(const DmtAdhesion& part) { return part; }
template <class Part>
Part allPulls(const Part& part) {
  return part;
}

}  // namespace detail

/// The law itself, or the listed one that does the same: resistance to rolling and twisting for either alone, cohesion
/// for each kind of it.
template <class Normal, class Tangential, class Rolling, class Adhesion>
auto listedFor(const ContactLaw<Normal, Tangential, Rolling, Adhesion>& law) {
  using Whole = ContactLaw<Normal, Tangential, decltype(detail::bothSpins(law.rolling)),
                           decltype(detail::allPulls(law.adhesion))>;
  if constexpr (isListed<Whole>)
    return Whole{law.normal, law.tangential, detail::bothSpins(law.rolling), detail::allPulls(law.adhesion)};
  else
    return law;
}
template <class Law>
using ListedFor = decltype(listedFor(std::declval<const Law&>()));

namespace detail {
template <class Part>
std::string partName() {
  if constexpr (requires { Part::name; })
    return Part::name;
  else
    return "a part of one's own";
}
}  // namespace detail

/// The parts, joined by " + "; those left out are not named.
template <class Law>
std::string lawName() {
  std::string name = detail::partName<decltype(Law::normal)>();
  const auto add = [&](bool absent, const std::string& part) {
    if (!absent) name += " + " + part;
  };
  using Tangential = decltype(Law::tangential);
  using Rolling = decltype(Law::rolling);
  using Adhesion = decltype(Law::adhesion);
  add(std::is_same_v<Tangential, NoTangential>, detail::partName<Tangential>());
  add(std::is_same_v<Rolling, NoRolling>, detail::partName<Rolling>());
  add(std::is_same_v<Adhesion, NoAdhesion>, detail::partName<Adhesion>());
  return name;
}

}  // namespace dovetail::dem
