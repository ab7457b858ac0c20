#include "dovetail/dem/model/contact_step.hpp"

#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

namespace detail {

void addContact(ContactDemand& demand, const Particles& particles, int particle, int partner,
                const ContactSlopes& slopes, double scale, double effectiveMass) {
  demand.stiffness.resize(particles.size(), 0.0);
  demand.damping.resize(particles.size(), 0.0);
  demand.contacts.push_back({particle, partner});
  const auto strongest = [&](double normal, double tangential, double rolling, double radius) {
    const double side = particles.rotates() ? 3.5 * tangential + 2.5 * rolling / (radius * radius) : tangential;
    return scale * std::max(normal, side);
  };
  for (const int k : {particle, partner}) {
    if (k < 0) continue;
    const auto i = static_cast<std::size_t>(k);
    demand.stiffness[i] +=
        strongest(slopes.normal.stiffness, slopes.tangential.stiffness, slopes.rolling.stiffness, particles.radius[i]);
    demand.damping[i] +=
        strongest(slopes.normal.damping, slopes.tangential.damping, slopes.rolling.damping, particles.radius[i]);
  }
  demand.twoBody = std::min(demand.twoBody, verletLimit(scale * slopes.normal.stiffness / effectiveMass,
                                                        scale * slopes.normal.damping / effectiveMass));
}

}  // namespace detail

ContactStep criticalStep(const ContactDemand& demand, const Particles& particles) {
  ContactStep step;
  step.twoBody = demand.twoBody;
  for (const auto& [particle, partner] : demand.contacts) {
    double a = 0.0, b = 0.0;
    for (const int k : {particle, partner}) {
      if (k < 0) continue;
      const auto i = static_cast<std::size_t>(k);
      a += demand.stiffness[i] / particles.mass[i];
      b += demand.damping[i] / particles.mass[i];
    }
    const double dt = detail::verletLimit(a, b);
    if (dt < step.dt) {
      step.dt = dt;
      step.particle = particle;
      step.partner = partner;
    }
  }
  return step;
}

MassScaling scaleMasses(Particles& particles, const ContactDemand& demand, double dt) {
  requirePositive(dt, "time step wanted by mass scaling");
  // A contact of two has dt² K/m + 2 dt C/m ≤ 4 in sum, so half of that each; against walls alone all of it.
  std::vector<double> allowed(demand.stiffness.size(), 4.0);
  for (const auto& [particle, partner] : demand.contacts)
    if (partner >= 0) allowed[static_cast<std::size_t>(particle)] = allowed[static_cast<std::size_t>(partner)] = 2.0;
  MassScaling report;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    report.massBefore += particles.mass[i];
    if (i >= demand.stiffness.size()) continue;
    const double needed = dt * (dt * demand.stiffness[i] + 2.0 * demand.damping[i]) / allowed[i];
    if (needed <= particles.mass[i]) continue;
    ++report.count;
    report.largestFactor = std::max(report.largestFactor, needed / particles.mass[i]);
    report.addedMass += needed - particles.mass[i];
    particles.mass[i] = needed;
  }
  return report;
}

}  // namespace dovetail::dem
