#include "dovetail/dem/model/impact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "dovetail/dem/bodies/body_term.hpp"
#include "dovetail/dem/model/loads.hpp"
#include "dovetail/dem/setup/streams.hpp"

namespace dovetail::dem {

namespace {

constexpr double immovable = 1e200;  // kg

struct Hitter {
  double inverseMass = -1.0, radius = 0.0;  // 1/kg; < 0: nobody
  int number = -1;                          // −1: a newcomer
  SolidPart part{};

  std::string name(const Particles& p) const {
    return number < 0 ? "inserted grains" : "particle " + std::to_string(p.id[static_cast<std::size_t>(number)]);
  }
};
/// The two of each kind that are moved most easily.
/// Points of each solid stand apart: those of one solid never meet each other.
struct Kind {
  int material = 0, solid = -1;
  bool operator==(const Kind&) const = default;
  bool operator<(const Kind& other) const {
    return std::pair(material, solid) < std::pair(other.material, other.solid);
  }
};
using Hitters = std::map<Kind, std::array<Hitter, 2>>;

void offer(Hitters& hitters, const Kind& kind, const Hitter& one) {
  auto& [first, second] = hitters[kind];
  if (one.inverseMass > first.inverseMass) {
    second = std::exchange(first, one);
  } else if (one.inverseMass > second.inverseMass) {
    second = one;
  }
}

/// 1/kg that each particle moves with: clumps by their lever, driven ones not at all.
std::vector<double> mobilities(const Model& m) {
  const Particles& p = m.particles;
  ContactDemand demand;
  for (const BodyTerm* bodies : m.terms.all<BodyTerm>()) dem::addDemand(demand, p, bodies->bodies, bodies->clumps);
  std::vector<double> inverse(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) inverse[i] = (demand.lever.empty() ? 1.0 : demand.lever[i]) / p.mass[i];
  for (const DriveTerm* drive : m.terms.all<DriveTerm>())
    for (const std::int64_t id : drive->ids())
      if (const int i = find(p, id); i >= 0) inverse[static_cast<std::size_t>(i)] = 0.0;
  return inverse;
}

/// Who is there and who comes, how fast; and those of them that touch nobody yet, and from how high these may fall.
struct Crowd {
  Hitters free, all;
  geometry::Box places, velocities;
  bool empty = true, nobodyFree = true;

  void add(const geometry::Box& where, const Vec3& v, bool isFree) {
    const auto widen = [](geometry::Box& box, const geometry::Box& by, bool& isEmpty) {
      for (int c = 0; c < 3; ++c) {
        box.lower[c] = isEmpty ? by.lower[c] : std::min(box.lower[c], by.lower[c]);
        box.upper[c] = isEmpty ? by.upper[c] : std::max(box.upper[c], by.upper[c]);
      }
      isEmpty = false;
    };
    widen(velocities, {v, v}, empty);
    if (isFree) widen(places, where, nobodyFree);
  }
  double largestSpeed() const {
    Vec3 most;
    for (int c = 0; c < 3; ++c) most[c] = std::max(std::abs(velocities.lower[c]), std::abs(velocities.upper[c]));
    return norm(most);
  }
};

void addNewcomers(const InsertionOptions& s, Crowd& crowd) {
  constexpr double lever = 3.0;  // of members at the ends of clumps
  crowd.add(s.region, s.velocity, true);
  const auto offerTwo = [&](double inverse, double radius) {
    for (Hitters* const table : {&crowd.free, &crowd.all, &crowd.all}) offer(*table, {s.material}, {inverse, radius});
  };
  for (const ClumpShape& shape : s.shapes)
    offerTwo(lever / shape.properties.mass, *std::min_element(shape.radius.begin(), shape.radius.end()));
  if (!s.shapes.empty()) return;
  const double r = boundsOf(s.sizes).smallest;
  offerTwo(1.0 / (s.density.value * 4.0 / 3.0 * std::numbers::pi * r * r * r), r);
}

Crowd crowdOf(const Model& m, const ContactDemand& demand, const ImpactOptions& settings) {
  Crowd crowd;
  const Particles& p = m.particles;
  const std::vector<double> inverse = mobilities(m);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const bool isFree = i >= demand.stiffness.size() || demand.stiffness[i] == 0.0;
    crowd.add({p.x[i], p.x[i]}, p.v[i], isFree);
    const SolidPart part = settings.parts.empty() ? SolidPart{p.isOfSolid(i) ? 0 : -1} : settings.parts[i];
    const Kind kind{p.material.empty() ? 0 : int{p.material[i]}, part.solid};
    const Hitter hitter{inverse[i], p.radius[i], static_cast<int>(i), part};
    offer(crowd.all, kind, hitter);
    if (isFree) offer(crowd.free, kind, hitter);
  }
  for (const InsertionTerm* insertion : m.terms.all<InsertionTerm>())
    addNewcomers(insertion->insertion.settings, crowd);
  return crowd;
}

/// Two spheres that meet head on, nothing else.
class Meeting {
public:
  Meeting(const ContactLaws& laws, const Hitter& a, const Hitter& b, std::array<int, 2> materials, bool rotates)
      : laws_(laws), least_(std::min(a.radius, b.radius)) {
    const auto massOf = [](const Hitter& hitter) {
      return hitter.inverseMass > 0.0 ? 1.0 / hitter.inverseMass : immovable;
    };
    addParticle(pair_, {}, {}, a.radius, Mass{massOf(a)});
    addParticle(pair_, {a.radius + b.radius, 0.0, 0.0}, {}, b.radius, Mass{massOf(b)});
    if (laws.materials() > 1)
      pair_.material = {static_cast<std::uint8_t>(materials[0]), static_cast<std::uint8_t>(materials[1])};
    if (rotates) switchOnRotation(pair_);
    effectiveMass_ = pair_.mass[0] * pair_.mass[1] / (pair_.mass[0] + pair_.mass[1]);
    list_.setSkin(1e-3 * least_);
    findPairs(pair_, list_);
  }

  ContactDemand demandAt(double overlap) const {
    ContactDemand demand;
    laws_.addDemand(demand, pair_, list_, std::max(overlap, 1e-9 * least_));
    return demand;
  }
  double limitOf(const ContactDemand& demand) const { return criticalStep(demand, pair_).dt; }
  /// With what solids ask of those that are parts of them.
  double limitAt(double overlap, const Hitter& a, const Hitter& b, int macroStep) const {
    ContactDemand demand = demandAt(overlap);
    demand.macroStep = macroStep;
    if (a.part.solid >= 0) addOwnForces(demand, 0, pair_.mass[0], a.part.ownRate);
    if (b.part.solid >= 0) addOwnForces(demand, 1, pair_.mass[1], b.part.ownRate);
    return limitOf(demand);
  }

  /// The overlap at which springs have taken up the energy of a speed, or a force's work, m: by at most both radii.
  double depth(double speed, double effectiveMass) const {
    const double energy = 0.5 * effectiveMass * speed * speed;
    double shallow = 0.0, deep = 2.0 * least_;
    for (int k = 0; k < 30; ++k) {
      const double middle = 0.5 * (shallow + deep);
      (workTo(middle) < energy ? shallow : deep) = middle;
    }
    return deep;
  }
  double effectiveMass() const { return effectiveMass_; }
  double leastRadius() const { return least_; }

private:
  /// ∫ (δ − s) k(s) ds, J, by Gauss's rule of 4 points on the square root of s, of which Hertz's law is a polynomial.
  double workTo(double overlap) const {
    constexpr std::array<double, 4> at{0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558},
        weight{0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226};
    double work = 0.0;
    for (std::size_t g = 0; g < 4; ++g) {
      const double s = overlap * at[g] * at[g];
      const ContactDemand demand = demandAt(s);
      if (!demand.links.empty())
        work += weight[g] * 2.0 * at[g] * overlap * (overlap - s) * demand.links.front().stiffness;
    }
    return work;
  }

  const ContactLaws& laws_;
  Particles pair_;
  PairList list_;
  double least_, effectiveMass_ = 0.0;
};

void note(ImpactLimit& limit, double dt, double overlap, const std::string& owner) {
  limit.lower({dt, owner});
  if (overlap > limit.overlap) limit.overlap = overlap, limit.deepest = owner;
}

double fallen(double speed, double height, double gravity) {
  return std::sqrt(speed * speed + 2.0 * gravity * std::max(0.0, height));
}

/// @return extent along gravity, m
double heightOf(const geometry::Box& box, const Vec3& gravity) {
  const double g = norm(gravity);
  double height = 0.0;
  for (int c = 0; c < 3; ++c) height += g > 0.0 ? std::abs(gravity[c]) / g * (box.upper[c] - box.lower[c]) : 0.0;
  return height;
}

/// How far down the partner is from the highest particle, m.
double dropTo(const ImpactPartner& partner, const geometry::Box& places, const Vec3& gravity) {
  const double g = norm(gravity);
  double drop = 0.0;
  for (int c = 0; c < 3 && g > 0.0; ++c) {
    const double down = gravity[c] / g;
    drop +=
        down > 0.0 ? down * (partner.box.upper[c] - places.lower[c]) : down * (partner.box.lower[c] - places.upper[c]);
  }
  return std::max(drop, heightOf(places, gravity));
}

void meetEachOther(const Model& m, const Crowd& crowd, int macroStep, ImpactLimit& limit) {
  const double g = norm(m.gravity);
  const double speed =
      fallen(norm(crowd.velocities.upper - crowd.velocities.lower), heightOf(crowd.places, m.gravity), g);
  for (const auto& [kind, hitters] : crowd.free)
    for (const auto& [other, candidates] : crowd.all) {
      if (kind.solid >= 0 && kind.solid == other.solid) continue;
      const Hitter& first = hitters[0];
      const bool same = kind == other && first.number == candidates[0].number && first.number >= 0;
      const Hitter& second = candidates[same ? 1 : 0];
      if (second.inverseMass < 0.0 || first.inverseMass + second.inverseMass == 0.0) continue;
      const Meeting meeting(*m.laws, first, second, {kind.material, other.material}, m.particles.rotates());
      const double depth = meeting.depth(speed, meeting.effectiveMass());
      note(limit, meeting.limitAt(depth, first, second, macroStep), depth / meeting.leastRadius(),
           "an impact of " + first.name(m.particles) + " with " + second.name(m.particles));
    }
}

void meetPartner(const Model& m, const Crowd& crowd, const ImpactPartner& partner, const ImpactOptions& settings,
                 ImpactLimit& limit) {
  constexpr double flat = 1e6;  // radii
  const ContactLaws& laws = partner.laws ? *partner.laws : *m.laws;
  if (std::isinf(laws.reach())) return;
  const double speed =
      fallen(crowd.largestSpeed() + partner.speed, dropTo(partner, crowd.places, m.gravity), norm(m.gravity));
  for (const auto& [kind, two] : crowd.free) {
    const Hitter& hitter = two[0];
    if (hitter.inverseMass <= 0.0 && partner.inverseMass <= 0.0) continue;
    const Hitter wall{0.0, flat * hitter.radius};
    const Meeting meeting(laws, hitter, wall, {kind.material, partner.material}, m.particles.rotates());
    const double depth = meeting.depth(speed, meeting.effectiveMass());
    ContactDemand demand = meeting.demandAt(depth);
    if (partner.inverseMass > 0.0 && !demand.links.empty()) {
      demand.links.front().shifting = demand.stiffness.front();
      demand.links.front().shiftingDamping = demand.damping.front();
      demand.standOn(0, partner.of, partner.inverseMass);
      demand.sides.front().inMacroSteps = partner.inMacroSteps;
      if (settings.ownRate) demand.sides.front().ownRate = settings.ownRate(partner.of);
    }
    demand.macroStep = settings.macroStep;
    if (hitter.part.solid >= 0 && hitter.inverseMass > 0.0)
      addOwnForces(demand, 0, 1.0 / hitter.inverseMass, hitter.part.ownRate);
    note(limit, meeting.limitOf(demand), depth / hitter.radius,
         "an impact of " + hitter.name(m.particles) + " with " + partner.name);
  }
}

}  // namespace

void addOwnForces(ContactDemand& demand, std::size_t particle, double mass, double ownRate) {
  if (particle >= demand.stiffness.size() || !(demand.stiffness[particle] > 0.0)) return;
  const double K = demand.macroStep, own = ownRate * mass;
  if (ownRate == 0.0) {
    demand.stiffness[particle] *= K * K;
    demand.damping[particle] *= K;
  } else if (K > 1.0) {
    demand.atMacroSteps.resize(demand.stiffness.size(), 0.0);
    demand.atMacroSteps[particle] += own;
  } else {
    demand.stiffness[particle] += own;
  }
}

ImpactLimit impactLimit(const Model& m, const ContactDemand& demand, const ImpactOptions& settings) {
  ImpactLimit limit;
  if (!m.laws) return limit;
  const Crowd crowd = crowdOf(m, demand, settings);
  if (crowd.free.empty()) return limit;
  if (!std::isinf(m.laws->reach())) meetEachOther(m, crowd, settings.macroStep, limit);
  std::vector<ImpactPartner> partners;
  for (const auto& term : m.terms) term->addPartners(m, partners);
  for (const ImpactPartner& partner : partners) meetPartner(m, crowd, partner, settings, limit);
  return limit;
}

}  // namespace dovetail::dem
