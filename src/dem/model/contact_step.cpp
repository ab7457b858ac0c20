#include "dovetail/dem/model/contact_step.hpp"

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/laws/contact_laws.hpp"

namespace dovetail::dem {

namespace detail {

void addContact(ContactDemand& demand, const Particles& particles, int particle, int partner,
                const ContactSlopes& slopes, double scale, double effectiveMass) {
  demand.stiffness.resize(particles.size(), 0.0);
  demand.damping.resize(particles.size(), 0.0);
  const auto strongest = [&](double normal, double tangential, double rolling, double radius) {
    const double side = particles.rotates() ? 3.5 * tangential + 2.5 * rolling / (radius * radius) : tangential;
    return scale * std::max(normal, side);
  };
  ContactDemand::Link link{particle, partner, StepOwner::contact, scale * slopes.normal.stiffness};
  for (const int k : {particle, partner}) {
    if (k < 0) continue;
    const auto i = static_cast<std::size_t>(k);
    demand.stiffness[i] +=
        strongest(slopes.normal.stiffness, slopes.tangential.stiffness, slopes.rolling.stiffness, particles.radius[i]);
    demand.damping[i] +=
        strongest(slopes.normal.damping, slopes.tangential.damping, slopes.rolling.damping, particles.radius[i]);
  }
  if (partner < 0) {
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

}  // namespace detail

namespace {

/// What is asked over the mass that answers, per particle: 1/s² and 1/s.
struct Rates {
  std::vector<double> stiff, damped;
};

Rates ratesOf(const ContactDemand& demand, const Particles& particles) {
  Rates rates{demand.stiffness, demand.damping};
  const std::size_t n = rates.stiff.size();
  const auto bodyOf = [&](std::size_t i) { return i < demand.body.size() ? demand.body[i] : -1; };
  std::vector<std::array<double, 2>> ofBody;
  for (std::size_t i = 0; i < n; ++i) {
    const int body = bodyOf(i);
    const double inverse = (body < 0 ? 1.0 : demand.lever[i]) / (particles.weightOf(i) * particles.mass[i]);
    rates.stiff[i] *= inverse;
    rates.damped[i] *= inverse;
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

}  // namespace

ContactStep criticalStep(const ContactDemand& demand, const Particles& particles) {
  ContactStep step;
  step.twoBody = demand.twoBody;
  const Rates rates = ratesOf(demand, particles);
  for (const ContactDemand::Link& link : demand.links) {
    double a = link.wallStiff, b = link.wallDamped;
    for (const int k : {link.particle, link.partner}) {
      if (k < 0) continue;
      a += rates.stiff[static_cast<std::size_t>(k)];
      b += rates.damped[static_cast<std::size_t>(k)];
    }
    const double dt = detail::verletLimit(a, b);
    if (dt < step.dt) {
      step.dt = dt;
      step.particle = link.particle;
      step.partner = link.partner;
      step.owner = link.owner;
      step.surface = link.surface < 0 ? "" : demand.surfaces[static_cast<std::size_t>(link.surface)];
    }
  }
  return step;
}

ContactStep criticalStep(const Particles& particles, const PairList& list, const ContactLaws& laws,
                         double leastOverlap) {
  ContactDemand demand;
  laws.addDemand(demand, particles, list, leastOverlap);
  return criticalStep(demand, particles);
}

std::string ownerOf(const ContactStep& step, const Particles& particles) {
  const auto name = [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    return "particle " + std::to_string(k < particles.id.size() ? particles.id[k] : std::int64_t{i});
  };
  if (step.particle < 0) return "nothing";
  return std::string(step.owner == StepOwner::bond ? "the bond" : "the contact") + " of " + name(step.particle) +
         " with " +
         (step.partner >= 0      ? name(step.partner)
          : step.surface.empty() ? "a wall"
                                 : "\"" + step.surface + "\"");
}

MassScaling scaleMasses(Particles& particles, const ContactDemand& demand, double dt) {
  requirePositive(dt, "time step wanted by mass scaling");
  // A contact of two has dt² K/m + 2 dt C/m ≤ 4 in sum, so half of that each; against walls alone all of it.
  std::vector<double> allowed(demand.stiffness.size(), 4.0);
  for (const ContactDemand::Link& link : demand.links) {
    if (link.partner < 0 && !(link.wallStiff > 0.0)) continue;
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
