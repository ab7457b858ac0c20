#include "dovetail/dem/model/contact_step.hpp"

#include <numbers>

#include "contact_directions.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"

namespace dovetail::dem {

namespace detail {

void addContact(ContactDemand& demand, const Particles& particles, int particle, int partner,
                const ContactSlopes& slopes, double scale, double effectiveMass) {
  demand.stiffness.resize(particles.size(), 0.0);
  demand.damping.resize(particles.size(), 0.0);
  const double roundness = particles.rotates() ? 0.4 : std::numeric_limits<double>::infinity();
  ContactDemand::Link link{particle, partner, StepOwner::contact, scale * slopes.normal.stiffness};
  for (const int k : {particle, partner}) {
    if (k < 0) continue;
    const auto i = static_cast<std::size_t>(k);
    const double radius = particles.radius[i];
    demand.stiffness[i] += scale * detail::strongest(slopes.normal.stiffness, slopes.tangential.stiffness,
                                                     slopes.rolling.stiffness, radius, roundness);
    demand.damping[i] += scale * detail::strongest(slopes.normal.damping, slopes.tangential.damping,
                                                   slopes.rolling.damping, radius, roundness);
  }
  if (partner >= 0) {  // as it is across its normal: see Directions
    link.shiftingDamping = scale * slopes.normal.damping;
    link.turning = scale * std::max(slopes.tangential.stiffness, slopes.rolling.stiffness);
    link.turningDamping = scale * std::max(slopes.tangential.damping, slopes.rolling.damping);
  } else {
    const double radius = particles.radius[static_cast<std::size_t>(particle)];
    link.shifting = scale * std::max(slopes.normal.stiffness, slopes.tangential.stiffness);
    link.shiftingDamping = scale * std::max(slopes.normal.damping, slopes.tangential.damping);
    link.turning = scale * slopes.rolling.stiffness / (radius * radius);
    link.turningDamping = scale * slopes.rolling.damping / (radius * radius);
  }
  demand.links.push_back(link);
  demand.twoBody = std::min(demand.twoBody, verletLimit(scale * slopes.normal.stiffness / effectiveMass,
                                                        scale * slopes.normal.damping / effectiveMass));
}

double macroLimit(const LinkRates& r, int K) {
  if (K == 1 || (r.macroStiff == 0.0 && r.macroDamped == 0.0))
    return verletLimit(r.stiff + r.macroStiff, r.damped + r.macroDamped);
  const auto bears = [&](double dt) {
    const double macroStep = K * dt, sine = 0.5 * dt * std::sqrt(r.stiff);
    const double half = sine < 1.0 ? std::asin(sine) : std::numbers::pi;  // φ/2
    if (!(K * half < 0.5 * std::numbers::pi)) return false;
    const double left = 1.0 - sine * sine - 0.5 * dt * r.damped;
    const double fraction = half > 0.0 ? K * std::tan(half) / std::tan(K * half) : 1.0;
    return macroStep * (macroStep * r.macroStiff + 2.0 * r.macroDamped) <= 4.0 * left * fraction;
  };
  double least = 0.0, most = verletLimit(r.macroStiff, r.macroDamped) / K;
  most = std::min(most, verletLimit(r.stiff, r.damped));
  for (int halving = 0; halving < 48; ++halving) {
    const double middle = 0.5 * (least + most);
    (bears(middle) ? least : most) = middle;
  }
  return least;
}

}  // namespace detail

int ContactDemand::sideOf(const void* of, std::span<const double> inverseMass) {
  for (std::size_t s = 0; s < sides.size(); ++s)
    if (sides[s].of == of) return static_cast<int>(s);
  sides.push_back({of, masses.size(), masses.size() + inverseMass.size()});
  for (const double inverse : inverseMass) masses.push_back({.inverse = inverse});
  return static_cast<int>(sides.size()) - 1;
}

void ContactDemand::standOn(std::size_t first, const void* of, double inverseMass) {
  const int side = sideOf(of, {&inverseMass, 1});
  const std::size_t mass = sides[static_cast<std::size_t>(side)].first;
  masses[mass].inverse = std::max(masses[mass].inverse, inverseMass);
  const Fraction whole{static_cast<int>(mass), 1.0};
  for (std::size_t k = first; k < links.size(); ++k) {
    links[k].side = side;
    links[k].shifted = add({&whole, 1});
  }
}

ContactDemand::Range ContactDemand::add(std::span<const Fraction> some) {
  const std::size_t first = fractions.size();
  fractions.insert(fractions.end(), some.begin(), some.end());
  return {first, fractions.size()};
}

namespace {

/// What is asked over the mass that answers, per particle: 1/s² and 1/s.
struct Rates {
  std::vector<double> stiff, tied, damped, atMacroSteps;
  std::vector<double> inverse;  // 1/kg, 0 of members of bodies
};

Rates ratesOf(const ContactDemand& demand, const Particles& particles) {
  Rates rates{demand.stiffness, demand.byTies, demand.damping, demand.atMacroSteps,
              std::vector<double>(demand.stiffness.size(), 0.0)};
  rates.tied.resize(rates.stiff.size(), 0.0);
  rates.atMacroSteps.resize(rates.stiff.size(), 0.0);
  const std::size_t n = rates.stiff.size();
  const auto bodyOf = [&](std::size_t i) { return i < demand.body.size() ? demand.body[i] : -1; };
  std::vector<std::array<double, 2>> ofBody;
  for (std::size_t i = 0; i < n; ++i) {
    const int body = bodyOf(i);
    const double inverse = (body < 0 ? 1.0 : demand.lever[i]) / (particles.weightOf(i) * particles.mass[i]);
    rates.stiff[i] *= inverse;
    rates.tied[i] *= inverse;
    rates.damped[i] *= inverse;
    rates.atMacroSteps[i] *= inverse;
    if (body < 0) rates.inverse[i] = inverse;
    if (body < 0) continue;
    const auto b = static_cast<std::size_t>(body);
    if (b >= ofBody.size()) ofBody.resize(b + 1, {0.0, 0.0});
    ofBody[b][0] += rates.stiff[i];
    ofBody[b][1] += rates.damped[i];
  }
  for (std::size_t i = 0; i < n; ++i)
    if (const int body = bodyOf(i); body >= 0) {
      rates.stiff[i] = ofBody[static_cast<std::size_t>(body)][0];
      rates.damped[i] = ofBody[static_cast<std::size_t>(body)][1];
    }
  return rates;
}

std::span<const ContactDemand::Fraction> fractionsIn(const ContactDemand& demand, const ContactDemand::Range& range) {
  return std::span(demand.fractions).subspan(range.first, range.end - range.first);
}

/// What all ties, or all other links, ask of each mass, over it.
std::vector<ContactDemand::Mass> massesUnder(const ContactDemand& demand, bool ties) {
  std::vector<ContactDemand::Mass> masses = demand.masses;
  const auto ask = [&](const ContactDemand::Range& range, double stiffness, double damping) {
    for (const auto& [mass, fraction] : fractionsIn(demand, range)) {
      masses[static_cast<std::size_t>(mass)].stiffness += stiffness * fraction;
      masses[static_cast<std::size_t>(mass)].damping += damping * fraction;
    }
  };
  for (const ContactDemand::Link& link : demand.links) {
    if ((link.owner == StepOwner::tie) != ties) continue;
    ask(link.shifted, link.shifting, link.shiftingDamping);
    ask(link.turned, link.turning, link.turningDamping);
  }
  for (const ContactDemand::Mass& point : masses) ask(point.carriedBy, point.stiffness, point.damping);
  for (ContactDemand::Mass& mass : masses) mass.stiffness *= mass.inverse, mass.damping *= mass.inverse;
  for (ContactDemand::Mass& point : masses)
    for (const auto& [mass, fraction] : fractionsIn(demand, point.carriedBy)) {
      point.stiffness += fraction * masses[static_cast<std::size_t>(mass)].stiffness;
      point.damping += fraction * masses[static_cast<std::size_t>(mass)].damping;
    }
  return masses;
}

class LinkReader {
public:
  LinkReader(const ContactDemand& demand, const Particles& particles)
      : demand_(demand),
        ofParticles_(ratesOf(demand, particles)),
        masses_(massesUnder(demand, false)),
        tiedMasses_(massesUnder(demand, true)),
        directions_(demand, particles) {}

  /// @param lead  how much more of the masses links get in common with ties
  detail::LinkRates operator()(std::size_t number, double lead) const {
    const ContactDemand::Link& link = demand_.links[number];
    const bool ties = link.owner == StepOwner::tie;
    const double ofTies = ties ? 1.0 : 1.0 / lead, ofOthers = ties ? lead : 1.0;
    detail::LinkRates rates;
    for (const int k : {link.particle, link.partner}) {
      if (k < 0) continue;
      const auto i = static_cast<std::size_t>(k);
      const Directions::Slopes spared = directions_.spared(number, i);
      rates.stiff += ofOthers * (ofParticles_.stiff[i] - ofParticles_.tied[i] - ofParticles_.inverse[i] * spared[0]) +
                     ofTies * ofParticles_.tied[i];
      rates.damped += ofOthers * (ofParticles_.damped[i] - ofParticles_.inverse[i] * spared[1]);
      rates.macroStiff += ofTies * ofParticles_.atMacroSteps[i];
    }
    if (link.side < 0) return rates;
    const auto meets = [&](const ContactDemand::Range& range) {
      std::array<double, 2> sum{};
      for (const auto& [mass, fraction] : fractionsIn(demand_, range)) {
        const ContactDemand::Mass &others = masses_[static_cast<std::size_t>(mass)],
                                  &tied = tiedMasses_[static_cast<std::size_t>(mass)];
        sum[0] += fraction * (ofOthers * others.stiffness + ofTies * tied.stiffness);
        sum[1] += fraction * (ofOthers * others.damping + ofTies * tied.damping);
      }
      return sum;
    };
    const auto [shift, turn] = std::pair{meets(link.shifted), meets(link.turned)};
    const double stiff = std::max(shift[0], turn[0]), damped = std::max(shift[1], turn[1]);
    const ContactDemand::Side& side = demand_.sides[static_cast<std::size_t>(link.side)];
    (side.inMacroSteps ? rates.macroStiff : rates.stiff) += stiff;
    (side.inMacroSteps ? rates.macroDamped : rates.damped) += damped;
    rates.macroStiff += side.ownRate;
    return rates;
  }

private:
  const ContactDemand& demand_;
  Rates ofParticles_;
  std::vector<ContactDemand::Mass> masses_, tiedMasses_;
  Directions directions_;
};

std::string nameOf(const ContactDemand::Link& link, const ContactDemand& demand, const Particles& particles) {
  const auto name = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return "particle " + std::to_string(k < particles.id.size() ? particles.id[k] : std::int64_t{i});
  };
  return std::string(link.owner == StepOwner::bond  ? "the bond"
                     : link.owner == StepOwner::tie ? "the tie"
                                                    : "the contact") +
         " of " + name(link.particle) + " with " +
         (link.partner >= 0  ? name(link.partner)
          : link.surface < 0 ? "a wall"
                             : "\"" + demand.surfaces[static_cast<std::size_t>(link.surface)] + "\"");
}

ContactStep stepWith(const ContactDemand& demand, const Particles& particles, const LinkReader& ratesOf, double lead) {
  ContactStep step;
  const ContactDemand::Link* setter = nullptr;
  for (std::size_t number = 0; number < demand.links.size(); ++number) {
    const ContactDemand::Link& link = demand.links[number];
    const detail::LinkRates rates = ratesOf(number, lead);
    const double dt = detail::macroLimit(rates, demand.macroStep);
    if (!(dt < step.dt)) continue;
    step.dt = dt;
    setter = &link;
    const double own = link.side < 0 ? 0.0 : demand.sides[static_cast<std::size_t>(link.side)].ownRate;
    const double K = demand.macroStep;
    step.byOwnForces = K * K * (2.0 * own - rates.macroStiff) > rates.stiff;
  }
  if (!setter) return step;
  step.particle = setter->particle;
  step.partner = setter->partner;
  step.kind = setter->owner;
  step.owner = nameOf(*setter, demand, particles);
  return step;
}

}  // namespace

ContactStep criticalStep(const ContactDemand& demand, const Particles& particles) {
  const LinkReader ratesOf(demand, particles);
  ContactStep step = stepWith(demand, particles, ratesOf, 1.0);
  // Any fractions are safe. In proportion to what is asked, a weak contact of two members meets the stiff ties of both.
  if (!demand.byTies.empty() || !demand.atMacroSteps.empty())
    for (const double lead : {1.25, 1.5, 2.0})
      if (ContactStep other = stepWith(demand, particles, ratesOf, lead); other.dt > step.dt) step = std::move(other);
  step.twoBody = demand.twoBody;
  return step;
}

ContactStep criticalStep(const Particles& particles, const PairList& list, const ContactLaws& laws,
                         double leastOverlap) {
  ContactDemand demand;
  laws.addDemand(demand, particles, list, leastOverlap);
  return criticalStep(demand, particles);
}

MassScaling scaleMasses(Particles& particles, const ContactDemand& demand, double dt) {
  requirePositive(dt, "time step wanted by mass scaling");
  // A contact of two has dt² K/m + 2 dt C/m ≤ 4 in sum, so half of that each; against walls alone all of it.
  std::vector<double> allowed(demand.stiffness.size(), 4.0);
  for (const ContactDemand::Link& link : demand.links) {
    if (link.partner < 0 && link.side < 0) continue;
    allowed[static_cast<std::size_t>(link.particle)] = 2.0;
    if (link.partner >= 0) allowed[static_cast<std::size_t>(link.partner)] = 2.0;
  }
  MassScaling report;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    report.massBefore += particles.mass[i];
    if (i >= demand.stiffness.size()) continue;
    const double needed = dt * (dt * demand.stiffness[i] + 2.0 * demand.damping[i]) / allowed[i];
    if (needed <= particles.mass[i]) continue;
    if (i < demand.body.size() && demand.body[i] >= 0)
      throw InputError("particle " + std::to_string(i) + " is a member of body " + std::to_string(demand.body[i]),
                       "mass scaling", "scale masses of single particles only, or give bodies a larger density");
    ++report.count;
    report.largestFactor = std::max(report.largestFactor, needed / particles.mass[i]);
    report.addedMass += needed - particles.mass[i];
    particles.mass[i] = needed;
  }
  return report;
}

}  // namespace dovetail::dem
