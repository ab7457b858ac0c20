// What bonds ask of the step, whether they fit their particles, and what they carry one by one.
#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/bonds/bonds.hpp"
#include "dovetail/dem/model/contact_step.hpp"

namespace dovetail::dem {

void addDemand(ContactDemand& demand, const Particles& particles, const Bonds& bonds) {
  if (bonds.size() == 0) return;
  demand.stiffness.resize(particles.size(), 0.0);
  demand.damping.resize(particles.size(), 0.0);
  for (const Bond& bond : bonds.bonds) {
    demand.links.push_back({bond.i, bond.j, StepOwner::bond});
    const double fraction = 0.5 * (particles.weightOf(static_cast<std::size_t>(bond.i)) +
                                   particles.weightOf(static_cast<std::size_t>(bond.j)));
    const double sliding = 0.25 * bond.shear * bond.length * bond.length;
    for (const int k : {bond.i, bond.j}) {
      const auto i = static_cast<std::size_t>(k);
      const double perInertia = particles.mass[i] / momentOfInertia(particles, k);
      const double asked = fraction * std::max({bond.normal, perInertia * bond.twisting,
                                                bond.shear + perInertia * (sliding + bond.bending)});
      demand.stiffness[i] += asked;
      demand.damping[i] += bond.dampingTime * asked;
    }
  }
}

void check(const Bonds& bonds, const Particles& particles) {
  if (bonds.size() > 0 && !particles.rotates())
    throw InputError("the particles do not spin", "bonds", "call switchOnRotation before");
  const auto count = static_cast<int>(particles.size());
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const Bond& bond = bonds.bonds[b];
    const std::string where = "bond " + std::to_string(b);
    for (const int k : {bond.i, bond.j})
      if (k < 0 || k >= count)
        throw InputError("there is no particle " + std::to_string(k), where,
                         "call renumber when particles have been removed");
    if (bond.i == bond.j)
      throw InputError("both its ends are at particle " + std::to_string(bond.i), where, "bond two particles");
    requirePositive(bond.length, "length of " + where);
    requirePositive(bond.normal, "axial stiffness of " + where);
    requirePositive(bond.radius, "radius of " + where);
    for (const double k : {bond.shear, bond.bending, bond.twisting}) requireNonNegative(k, "stiffness of " + where);
    requireNonNegative(bond.dampingTime, "damping time of " + where);
    if (!(bond.tensileStrength > 0.0 && bond.shearStrength > 0.0))
      throw InputError("a strength is not > 0", where, "give strengths; infinite: never breaks");
  }
}

BondSample sampleBonds(const Particles& particles, const Bonds& bonds, const geometry::Periodicity& space) {
  if (bonds.forces.size() != bonds.size())
    throw InputError("the bonds have no forces yet", "sample of bonds", "take it after a step, or after exchangeBonds");
  BondSample sample;
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const Bond& bond = bonds.bonds[b];
    const Bonds::Forces& f = bonds.forces[b];
    const Vec3 from = particles.x[static_cast<std::size_t>(bond.i)];
    const Vec3 branch = space.minimumImage(particles.x[static_cast<std::size_t>(bond.j)] - from);
    const double length = norm(branch);
    sample.first.push_back(bond.i);
    sample.second.push_back(bond.j);
    sample.from.push_back(from);
    sample.to.push_back(from + branch);
    sample.force.push_back(-f.force);
    sample.torqueFirst.push_back(f.torqueI);
    sample.torqueSecond.push_back(f.torqueJ);
    sample.tension.push_back(length > 0.0 ? -dot(f.force, branch) / length : 0.0);
  }
  sample.utilised = bonds.utilised;
  sample.energy = bonds.energy;
  return sample;
}

}  // namespace dovetail::dem
