// Contact laws of a scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <type_traits>

#include "dovetail/core/finite.hpp"
#include "dovetail/dem/laws/materials.hpp"
#include "dovetail/dem/laws/rolling.hpp"
#include "dovetail/dem/model/model.hpp"
#include "dovetail/scene/laws_in_place.hpp"
#include "keys/advice.hpp"
#include "law_kinds.hpp"
#include "parts.hpp"
#include "sizes.hpp"

namespace dovetail::scene {

namespace {

template <class Part>
Part resistance(const Rolling& rolling) {
  return {.friction = rolling.friction, .stiffnessRatio = rolling.stiffnessRatio, .dampingRatio = rolling.dampingRatio};
}

/// A law as the scene has it, and the elasticity of the second surface if it is another one.
struct Entry {
  const ContactLaw* law;
  const HertzContact* second = nullptr;
};
/// Entries for pairs of rows, row by row.
struct Table {
  int rows = 1;
  std::vector<Entry> entries;
  const Entry& at(int a, int b) const { return entries[static_cast<std::size_t>(a * rows + b)]; }
  bool any(const auto& holds) const {
    return std::any_of(entries.begin(), entries.end(), [&](const Entry& entry) { return holds(*entry.law); });
  }
};

/// Without friction, where others of the table have some.
const Rolling freely{0.0, 1.0, 0.0};

/// Calls use(of) with the part of a law against rolling and twisting, of one type for the whole table.
template <class Use>
auto withRolling(const Table& table, const Use& use) {
  using dem::RollingResistance, dem::TwistingResistance, dem::RollingAndTwisting;
  const bool rolls = table.any([](const ContactLaw& law) { return law.rolling.has_value(); });
  const bool twists = table.any([](const ContactLaw& law) { return law.twisting.has_value(); });
  const auto rolling = [](const ContactLaw& law) {
    return resistance<RollingResistance>(law.rolling.value_or(freely));
  };
  const auto twisting = [](const ContactLaw& law) {
    return resistance<TwistingResistance>(law.twisting.value_or(freely));
  };
  if (rolls && twists)
    return use([&](const ContactLaw& law) { return RollingAndTwisting{rolling(law), twisting(law)}; });
  if (rolls) return use(rolling);
  if (twists) return use(twisting);
  return use([](const ContactLaw&) { return dem::NoRolling{}; });
}

dem::Cohesion cohesionOf(const ContactLaw& law) {
  const Adhesion pull = law.adhesion.value_or(Adhesion{});
  return {pull.force, pull.stiffness, pull.pressure, pull.work};
}
/// Where only others of the table are wet, a bridge that does not pull.
dem::LiquidBridge bridgeOf(const ContactLaw& law) {
  constexpr double dropletVolume = 1e-30;
  if (!law.liquidBridge) return {0.0, dropletVolume, 0.0};
  const LiquidBridge& bridge = *law.liquidBridge;
  return {bridge.surfaceTension, bridge.volume, bridge.contactAngle};
}

bool isWet(const ContactLaw& law) { return law.liquidBridge.has_value(); }
bool isSticky(const ContactLaw& law) { return law.adhesion.has_value(); }

/// The same with what pulls. Elastic-plastic grains have no liquid bridges.
template <class Normal, class Use>
auto withPull(const Table& table, const Use& use) {
  if constexpr (!std::is_same_v<Normal, dem::ElasticPlastic>)
    if (table.any(isWet)) return use(bridgeOf);
  if (table.any(isSticky)) return use(cohesionOf);
  return use([](const ContactLaw&) { return dem::NoAdhesion{}; });
}

/// The parts that some law of the table has, for all of them.
template <class Normal, class Tangential, class PartsOf>
std::shared_ptr<const dem::ContactLaws> withParts(const Table& table, const PartsOf& partsOf) {
  const auto make = [&]<class Across>(const Across&, const auto& rollingOf, const auto& pullOf) {
    return dem::makeContactLaws(dem::makeLawTable(table.rows, [&](int a, int b) {
      const Entry& entry = table.at(a, b);
      const auto [normal, tangential] = atPlace(entry.law->where, [&] { return partsOf(entry); });
      const auto rolling = rollingOf(*entry.law);
      const auto pull = pullOf(*entry.law);
      using Law = dem::ContactLaw<Normal, Across, std::decay_t<decltype(rolling)>, std::decay_t<decltype(pull)>>;
      if constexpr (std::is_same_v<Across, Tangential>)
        return Law{normal, tangential, rolling, pull};
      else
        return Law{normal, {}, rolling, pull};
    }));
  };
  const bool isSmooth = !table.any([](const ContactLaw& law) {
    return law.friction > 0.0 || law.rolling.has_value() || law.twisting.has_value() || isWet(law);
  });
  if (isSmooth)
    return withPull<dem::ElasticPlastic>(table, [&](const auto& pullOf) {  // without bridges
      return make(
          dem::NoTangential{}, [](const ContactLaw&) { return dem::NoRolling{}; }, pullOf);
    });
  return withRolling(table, [&](const auto& rollingOf) {
    return withPull<Normal>(table, [&](const auto& pullOf) { return make(Tangential{}, rollingOf, pullOf); });
  });
}

auto partsOf(const LinearContact& linear, const Entry& entry) {
  const ContactLaw& law = *entry.law;
  return std::pair{dem::LinearSpringDashpot{.stiffness = linear.stiffness,
                                            .restitution = law.restitution,
                                            .tension = linear.tension,
                                            .bonded = linear.bonded},
                   dem::TangentialSpring{.stiffness = linear.tangentialStiffness.value_or(2.0 / 7.0 * linear.stiffness),
                                         .friction = law.friction,
                                         .dampingRatio = law.tangentialDampingRatio}};
}
dem::Material materialOf(const HertzContact& hertz) { return {hertz.youngsModulus, hertz.poissonRatio, 0.0}; }
auto partsOf(const HertzContact& hertz, const Entry& entry) {
  const ContactLaw& law = *entry.law;
  const dem::HertzMindlinLaw both =
      dem::hertzMindlin(materialOf(hertz), materialOf(entry.second ? *entry.second : hertz),
                        {law.restitution, law.friction, law.tangentialDampingRatio});
  return std::pair{both.normal, both.tangential};
}

auto partsOf(const ElasticPlasticContact& springs, const Entry& entry) {
  const ContactLaw& law = *entry.law;
  return std::pair{
      dem::ElasticPlastic{springs.stiffness, springs.unloadingStiffness, springs.cohesionStiffness,
                          springs.dampingRatio},
      dem::TangentialSpring{.stiffness = springs.tangentialStiffness.value_or(2.0 / 7.0 * springs.stiffness),
                            .friction = law.friction,
                            .dampingRatio = law.tangentialDampingRatio}};
}

template <class Kind, class Normal, class Tangential>
std::shared_ptr<const dem::ContactLaws> lawsOf(const Table& table) {
  return withParts<Normal, Tangential>(
      table, [](const Entry& entry) { return partsOf(std::get<Kind>(entry.law->normal), entry); });
}

std::shared_ptr<const dem::ContactLaws> lawsOf(const Table& table) {
  if (std::holds_alternative<LinearContact>(table.entries.front().law->normal))
    return lawsOf<LinearContact, dem::LinearSpringDashpot, dem::TangentialSpring>(table);
  if (std::holds_alternative<ElasticPlasticContact>(table.entries.front().law->normal))
    return lawsOf<ElasticPlasticContact, dem::ElasticPlastic, dem::TangentialSpring>(table);
  return lawsOf<HertzContact, dem::HertzDashpot, dem::MindlinSpring>(table);
}

/// What cannot be in one law.
void requirePossible(const ContactLaw& law) {
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw InputError(what, law.where, remedy);
  };
  if (law.adhesion && law.liquidBridge)
    refuse("a contact has adhesion and a liquid bridge", "leave one of them out: a bridge pulls touching grains too");
  const auto* const linear = std::get_if<LinearContact>(&law.normal);
  if (linear && linear->bonded && (law.adhesion || law.liquidBridge))
    refuse("bonded springs cannot have adhesion or liquid bridges, as they pull already", "leave one of them out");
  if (linear && law.adhesion && law.adhesion->stiffness >= linear->stiffness)
    refuse("the adhesion grows faster than the spring: grains would sink into each other",
           "give adhesion.stiffness a value below that of the contact");
  const dem::Cohesion pull = cohesionOf(law);
  if (law.adhesion && pull.force + pull.stiffness + pull.pressure + pull.work == 0.0)
    refuse("the adhesion is zero", "give it a force, stiffness, pressure or work, or leave it out");
  const auto* const springs = std::get_if<ElasticPlasticContact>(&law.normal);
  if (springs && law.liquidBridge)
    refuse("elastic-plastic contacts cannot have liquid bridges", "write \"law\": \"linear\", or give it adhesion");
  if (springs && law.restitution != 1.0)
    refuse("an elastic-plastic contact has the restitution √(stiffness/unloading_stiffness) = " +
               formatNumber(std::sqrt(springs->stiffness / springs->unloadingStiffness)),
           "leave restitution out");
}

double stiffnessOf(const LinearContact& linear, const Entry&, double) { return linear.stiffness; }
double stiffnessOf(const ElasticPlasticContact& springs, const Entry&, double) { return springs.unloadingStiffness; }
double stiffnessOf(const HertzContact& hertz, const Entry& entry, double radius) {
  const double modulus = dem::effectiveModulus(materialOf(hertz), materialOf(entry.second ? *entry.second : hertz));
  return 2.0 * modulus * std::sqrt(0.5 * radius * 0.05 * radius);
}

/// Under slowly growing weight.
double softnessOf(const auto& kind, const Entry& entry, double radius) {
  if constexpr (requires { kind.unloadingStiffness; })
    return kind.stiffness;
  else
    return stiffnessOf(kind, entry, radius);
}

/// Names of contact materials; the first, of what names none, is empty.
std::vector<std::string> rowsOf(const Scene& scene) {
  std::vector<std::string> rows{""};
  for (const PairLaw& pair : scene.contacts)
    for (const std::string& name : {pair.first, pair.second})
      if (std::find(rows.begin(), rows.end(), name) == rows.end()) rows.push_back(name);
  return rows;
}

/// Contact materials of what can meet: grains, and all.
struct Meeting {
  std::set<std::string> grains, all;
  bool meet(const std::string& a, const std::string& b) const {
    return (grains.contains(a) && all.contains(b)) || (grains.contains(b) && all.contains(a));
  }
};
Meeting meetingIn(const Scene& scene) {
  Meeting found;
  for (const Particles& one : scene.particles) found.grains.insert(one.contactMaterial);
  for (const Clump& one : scene.clumps) found.grains.insert(one.contactMaterial);
  for (const Insertion& one : scene.insertions) found.grains.insert(one.contactMaterial);
  found.all = found.grains;
  for (const Wall& one : scene.walls) found.all.insert(one.contactMaterial);
  for (const Coupling& one : scene.couplings)
    if (const auto* const surface = std::get_if<SurfaceContact>(&one.kind); surface && !surface->contact)
      found.all.insert(surface->contactMaterial);
    else if (const auto* const points = std::get_if<PointSpheres>(&one.kind))
      found.grains.insert(points->contactMaterial), found.all.insert(points->contactMaterial);
  return found;
}

void requireAlike(const ContactLaw& law, const ContactLaw& first) {
  requireSameNormal(law, first);
  if ((isWet(law) && isSticky(first)) || (isWet(first) && isSticky(law)))
    throw InputError("adhesion and liquid bridges cannot be mixed in one scene", law.where, "take one for all pairs");
}

void requireBondedAlone(const Scene& scene) {
  const auto isBonded = [](const ContactLaw& law) {
    const auto* const linear = std::get_if<LinearContact>(&law.normal);
    return linear && linear->bonded;
  };
  const bool any = (scene.contact && isBonded(*scene.contact)) ||
                   std::any_of(scene.contacts.begin(), scene.contacts.end(),
                               [&](const PairLaw& pair) { return isBonded(pair.law); });
  if (!any) return;
  const std::string where = scene.contact ? scene.contact->where : scene.contacts.front().law.where;
  if (!scene.contacts.empty())
    throw InputError("bonded springs cannot be used with \"contacts\"", where, "leave contacts out");
  if (!scene.insertions.empty())
    throw InputError("insertions cannot be used with bonded springs: inserted grains would have no contacts", where,
                     "leave bonded or insertions out");
}

bool hasDents(const ContactLaw& law) { return std::holds_alternative<ElasticPlasticContact>(law.normal); }

/// Where facets share a contact, the dent of each would grow with the way of the contact over them.
void requireDentsWithoutFacets(const Scene& scene) {
  const bool any = (scene.contact && hasDents(*scene.contact)) ||
                   std::ranges::any_of(scene.contacts, [](const PairLaw& pair) { return hasDents(pair.law); });
  for (const Wall& wall : scene.walls)
    if (any && std::holds_alternative<SurfaceFile>(wall.shape))
      throw InputError("elastic-plastic contacts do not keep their energy on facets", wall.where,
                       "take another law, or walls without facets: planes, boxes, cylinders, spheres");
  for (const Coupling& coupling : scene.couplings)
    if (const auto* const surface = std::get_if<SurfaceContact>(&coupling.kind);
        surface && (surface->contact ? hasDents(*surface->contact) : any))
      throw InputError("elastic-plastic contacts do not keep their energy on facets", coupling.where,
                       "give the coupling a contact with another law");
}

void put(Table& table, const PairLaw& pair, const std::vector<std::string>& rows) {
  const auto row = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(rows.begin(), rows.end(), name) - rows.begin());
  };
  const std::size_t a = row(pair.first), b = row(pair.second), n = rows.size();
  if (table.entries[a * n + b].law)
    throw InputError("the law between \"" + pair.first + "\" and \"" + pair.second + "\" is there twice",
                     pair.law.where, "leave one of them out");
  if (pair.ofSecond && !std::holds_alternative<HertzContact>(pair.law.normal))
    throw InputError("a linear spring has no second modulus", pair.law.where, "leave \"second\" out");
  table.entries[a * n + b] = table.entries[b * n + a] = {&pair.law, pair.ofSecond ? &*pair.ofSecond : nullptr};
}

/// @throws InputError for laws of two kinds, a pair twice, or pairs that can meet and have no law
Table tableOf(const Scene& scene) {
  const std::vector<std::string> rows = rowsOf(scene);
  Table table{static_cast<int>(rows.size()), std::vector<Entry>(rows.size() * rows.size(), Entry{nullptr})};
  if (rows.size() > 256)
    throw InputError("more than 255 contact materials", scene.contacts.back().law.where, "take fewer");
  const ContactLaw& first = scene.contact ? *scene.contact : scene.contacts.front().law;
  requirePossible(first);
  for (const PairLaw& pair : scene.contacts) {
    requirePossible(pair.law);
    requireAlike(pair.law, first);
    put(table, pair, rows);
  }
  const Meeting meeting = meetingIn(scene);
  for (std::size_t a = 0; a < rows.size(); ++a)
    for (std::size_t b = 0; b < rows.size(); ++b) {
      Entry& entry = table.entries[a * rows.size() + b];
      if (entry.law) continue;
      if (!scene.contact && meeting.meet(rows[a], rows[b]))
        throw InputError("there is no law between \"" + rows[a] + "\" and \"" + rows[b] + "\"", first.where,
                         rows[a].empty() || rows[b].empty()
                             ? "give every group of grains, wall and surface a contact_material, or the scene a contact"
                             : "add it to contacts, or give the scene a contact for all other pairs");
      entry.law = &first;
    }
  return table;
}

}  // namespace

namespace {

std::string namesOf(const std::vector<std::string>& rows, int a, int b) {
  if (rows.size() == 1) return "";
  std::ostringstream text;
  const auto write = [&](int row) {
    const std::string& given = rows[static_cast<std::size_t>(row)];
    given.empty() ? text << "unnamed" : text << '"' << given << '"';
  };
  text << " (";
  write(a);
  text << " on ";
  write(b);
  text << ")";
  return text.str();
}

}  // namespace

std::shared_ptr<const dem::ContactLaws> makeLaws(const ContactLaw& law) {
  requirePossible(law);
  return atPlace(law.where, [&] { return lawsOf(Table{1, std::vector<Entry>{Entry{&law}}}); });
}

std::shared_ptr<const dem::ContactLaws> makeLaws(const Scene& scene) {
  requireBondedAlone(scene);
  requireDentsWithoutFacets(scene);
  const Table table = tableOf(scene);
  return atPlace(table.entries.front().law->where, [&] { return lawsOf(table); });
}

void requireSameNormal(const ContactLaw& law, const ContactLaw& first) {
  static const std::array names{"linear", "Hertz", "elastic-plastic"};
  const std::string own = names.at(law.normal.index()), others = names.at(first.normal.index());
  if (own != others)
    throw InputError(others + " and " + own + " laws cannot be mixed in one scene", law.where,
                     "write \"law\": \"" + others + "\"");
}

int contactRow(const Scene& scene, const std::string& name) {
  const std::vector<std::string> rows = rowsOf(scene);
  const auto found = std::find(rows.begin(), rows.end(), name);
  if (found == rows.end())
    throw InputError("\"contacts\" has no law for the contact material \"" + name + "\"", "",
                     scene.contacts.empty() ? "add one to contacts" : adviceFor(name, {rows.begin() + 1, rows.end()}));
  return static_cast<int>(found - rows.begin());
}

double softestSpring(const Scene& scene, int row, double radius) {
  const Table table = tableOf(scene);
  double softest = std::numeric_limits<double>::infinity();
  for (int other = 0; other < table.rows; ++other) {
    const Entry& entry = table.at(row, other);
    const auto of = [&](const auto& kind) { return softnessOf(kind, entry, radius); };
    softest = std::min(softest, std::visit(of, entry.law->normal));
  }
  return softest;
}

Impact briefestImpact(const Scene& scene, const dem::Particles& particles) {
  Impact briefest;
  if (!scene.contact && scene.contacts.empty()) return {impactInPlace(scene, particles), ""};
  const Table table = tableOf(scene);
  const std::vector<std::string> rows = rowsOf(scene);
  const auto look = [&](int row, double radius, double mass) {
    double stiffness = 0.0;
    int stiffest = 0;
    for (int other = 0; other < table.rows; ++other) {
      const Entry& entry = table.at(row, other);
      const auto of = [&](const auto& kind) { return stiffnessOf(kind, entry, radius); };
      const double found = std::visit(of, entry.law->normal);
      if (found > stiffness) stiffest = other;
      stiffness = std::max(stiffness, found);
    }
    const double limit = 2.0 * std::sqrt(0.5 * mass / stiffness);
    if (limit < briefest.limit) briefest = {limit, namesOf(rows, row, stiffest)};
  };
  for (std::size_t i = 0; i < particles.size(); ++i)
    look(particles.material.empty() ? 0 : particles.material[i], particles.radius[i], particles.mass[i]);
  for (const Insertion& in : scene.insertions) {
    const Entering grains = enteringOf(in);
    look(contactRow(scene, in.contactMaterial), grains.smallest, grains.lightest);
  }
  return briefest;
}

}  // namespace dovetail::scene
