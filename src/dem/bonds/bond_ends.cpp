#include "bond_ends.hpp"

#include <algorithm>

#include "dovetail/core/parallel.hpp"

namespace dovetail::dem::detail {

namespace {

std::uint32_t endOf(std::size_t bond, bool second) { return static_cast<std::uint32_t>(2 * bond + (second ? 1 : 0)); }

/// An end of a particle gets another name, and the row stays in order.
void rename(BondEnds& ends, int particle, std::uint32_t from, std::uint32_t to) {
  const auto found = std::lower_bound(ends.particle.begin(), ends.particle.end(), particle);
  const auto row = static_cast<std::size_t>(found - ends.particle.begin());
  const auto begin = ends.end.begin() + static_cast<std::ptrdiff_t>(ends.first[row]),
             stop = ends.end.begin() + static_cast<std::ptrdiff_t>(ends.first[row + 1]);
  *std::find(begin, stop, from) = to;
  std::sort(begin, stop);
}

}  // namespace

void updateEnds(const Particles& particles, Bonds& bonds) {
  BondEnds& ends = bonds.ends;
  if (ends.bonds == bonds.size() && ends.particles == particles.size()) return;
  check(bonds, particles);
  std::vector<std::size_t> first(particles.size() + 1, 0);
  for (const Bond& bond : bonds.bonds)
    for (const int k : {bond.i, bond.j}) ++first[static_cast<std::size_t>(k) + 1];
  ends.particle.clear();
  ends.first.assign(1, 0);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (first[i + 1] > 0) {
      ends.particle.push_back(static_cast<int>(i));
      ends.first.push_back(ends.first.back() + first[i + 1]);
    }
    first[i + 1] += first[i];
  }
  ends.end.resize(2 * bonds.size());
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    ends.end[first[static_cast<std::size_t>(bonds.bonds[b].i)]++] = endOf(b, false);
    ends.end[first[static_cast<std::size_t>(bonds.bonds[b].j)]++] = endOf(b, true);
  }
  ends.bonds = bonds.size();
  ends.particles = particles.size();
}

void removeBond(Bonds& bonds, std::size_t bond) {
  const std::size_t last = bonds.size() - 1;
  const auto renameBoth = [&](std::size_t from, auto&& to) {
    rename(bonds.ends, bonds.bonds[from].i, endOf(from, false), to(false));
    rename(bonds.ends, bonds.bonds[from].j, endOf(from, true), to(true));
  };
  renameBoth(bond, [](bool) { return BondEnds::gone; });
  if (bond != last) {
    renameBoth(last, [&](bool second) { return endOf(bond, second); });
    bonds.bonds[bond] = bonds.bonds[last];
    bonds.forces[bond] = bonds.forces[last];
    bonds.energy[bond] = bonds.energy[last];
    bonds.utilised[bond] = bonds.utilised[last];
  }
  bonds.bonds.pop_back();
  bonds.forces.pop_back();
  bonds.energy.pop_back();
  bonds.utilised.pop_back();
  --bonds.ends.bonds;
}

bool joined(const Bonds& bonds, int i, int j) {
  const BondEnds& ends = bonds.ends;
  const auto found = std::lower_bound(ends.particle.begin(), ends.particle.end(), i);
  if (found == ends.particle.end() || *found != i) return false;
  const auto row = static_cast<std::size_t>(found - ends.particle.begin());
  for (std::size_t e = ends.first[row]; e < ends.first[row + 1] && ends.end[e] != BondEnds::gone; ++e) {
    const Bond& bond = bonds.bonds[ends.end[e] / 2];
    if (bond.i == j || bond.j == j) return true;
  }
  return false;
}

void gatherForces(const Bonds& bonds, Particles& particles) {
  const BondEnds& ends = bonds.ends;
  parallelFor(ends.particle.size(), 512, [&](std::size_t begin, std::size_t stop) {
    for (std::size_t k = begin; k < stop; ++k) {
      const auto i = static_cast<std::size_t>(ends.particle[k]);
      Vec3 force = particles.f[i], torque = particles.torque[i];
      for (std::size_t e = ends.first[k]; e < ends.first[k + 1] && ends.end[e] != BondEnds::gone; ++e) {
        const Bonds::Forces& f = bonds.forces[ends.end[e] / 2];
        if (ends.end[e] % 2 == 0) {
          force -= f.force;
          torque += f.torqueI;
        } else {
          force += f.force;
          torque += f.torqueJ;
        }
      }
      particles.f[i] = force;
      particles.torque[i] = torque;
    }
  });
}

}  // namespace dovetail::dem::detail
