// What bonds exert, and which of them break.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bond_ends.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/dem/bonds/bonds.hpp"

namespace dovetail::dem {

namespace {

/// Turns v by the rotation of Cayley, of angle 2 atan(|h|): lengths and angles stay to round-off.
void turn(Vec3& v, const Vec3& h, double factor) {
  const Vec3 first = cross(h, v);
  v += factor * (first + cross(h, first));
}

void turnEnds(Bond& bond, const Vec3& omegaI, const Vec3& omegaJ, double dt) {
  const Vec3 hI = (0.5 * dt) * omegaI, hJ = (0.5 * dt) * omegaJ;
  const double factorI = 2.0 / (1.0 + squaredNorm(hI)), factorJ = 2.0 / (1.0 + squaredNorm(hJ));
  turn(bond.directionI, hI, factorI);
  turn(bond.acrossI, hI, factorI);
  turn(bond.directionJ, hJ, factorJ);
  turn(bond.acrossJ, hJ, factorJ);
}

struct Line {
  Vec3 e;  // unit, from i to j
  double length;
};

Line lineOf(const Particles& particles, const Bond& bond, const geometry::Periodicity& space) {
  const Vec3 d =
      space.minimumImage(particles.x[static_cast<std::size_t>(bond.j)] - particles.x[static_cast<std::size_t>(bond.i)]);
  const double length = norm(d);
  return {length > 0.0 ? d / length : bond.directionI, length > 0.0 ? length : bond.length};
}

Bonds::Forces elasticForces(const Bond& bond, const Line& line, double& energy) {
  const Vec3 &nI = bond.directionI, &nJ = bond.directionJ, &mI = bond.acrossI, &mJ = bond.acrossJ;
  const Vec3 lI = cross(nI, mI), lJ = -cross(nJ, mJ);
  const double stretch = line.length - bond.length, slide = bond.shear * bond.length * bond.length;
  const double mixed = bond.bending - 0.25 * slide - 0.5 * bond.twisting;
  const Vec3 w = nJ - nI, across = w - dot(w, line.e) * line.e;
  energy = 0.5 * bond.normal * stretch * stretch +
           0.25 * slide * (squaredNorm(nI - line.e) + squaredNorm(nJ + line.e)) + 0.5 * mixed * squaredNorm(nI + nJ) +
           0.25 * bond.twisting * (squaredNorm(mI - mJ) + squaredNorm(lI - lJ));
  Bonds::Forces f;
  f.force = -(bond.normal * stretch) * line.e - (0.5 * slide / line.length) * across;
  const Vec3 pair = (0.5 * bond.twisting) * (cross(mI, mJ) + cross(lI, lJ)) - mixed * cross(nI, nJ);
  f.torqueI = (0.5 * slide) * cross(nI, line.e) + pair;
  f.torqueJ = -(0.5 * slide) * cross(nJ, line.e) - pair;
  return f;
}

/// Largest stress over strength.
double utilisation(const Bond& bond, const Line& line, const Bonds::Forces& f) {
  const double area = std::numbers::pi * bond.radius * bond.radius;
  const double perMoment = bond.momentContribution * 4.0 / (area * bond.radius);  // r/I; r/J is half of it
  const double tension = -dot(f.force, line.e), twist = dot(f.torqueI, line.e);
  const double bending = std::max(norm(f.torqueI - twist * line.e), norm(f.torqueJ - dot(f.torqueJ, line.e) * line.e));
  const double shear = norm(f.force + tension * line.e);
  return std::max((tension / area + perMoment * bending) / bond.tensileStrength,
                  (shear / area + 0.5 * perMoment * std::abs(twist)) / bond.shearStrength);
}

/// Adds the dashpots' forces; returns the power they lose, W.
double addDamping(const Bond& bond, const Line& line, const Vec3& velocity, const Vec3& omegaI, const Vec3& omegaJ,
                  Bonds::Forces& f) {
  const double along = dot(velocity, line.e);
  const Vec3 mean = 0.5 * (omegaI + omegaJ), relative = omegaJ - omegaI;
  const Vec3 sliding = mean - dot(mean, line.e) * line.e - cross(line.e, velocity) / line.length;
  const Vec3 moment = (bond.dampingTime * bond.shear * bond.length * bond.length) * sliding;
  const Vec3 twisting = dot(relative, line.e) * line.e;
  const Vec3 couple = bond.dampingTime * (bond.bending * (relative - twisting) + bond.twisting * twisting);
  const double axial = bond.dampingTime * bond.normal * along;
  f.force += cross(moment, line.e) / line.length - axial * line.e;
  f.torqueI += couple - 0.5 * moment;
  f.torqueJ -= couple + 0.5 * moment;
  return axial * along + dot(moment, sliding) + dot(couple, relative);
}

/// What of a bond is modelled here: the mean of the weights of its particles.
double fractionOf(const Particles& particles, const Bond& bond) {
  if (particles.weight.empty()) return 1.0;
  return 0.5 *
         (particles.weight[static_cast<std::size_t>(bond.i)] + particles.weight[static_cast<std::size_t>(bond.j)]);
}

void weigh(Bonds::Forces& f, double fraction) {
  f.force *= fraction;
  f.torqueI *= fraction;
  f.torqueJ *= fraction;
}

/// What a chunk of bonds stores and loses, and how many of it break.
struct Answer {
  ContactWork work;
  int broken = 0;
  double powerOfBroken = 0.0;
  Answer& operator+=(const Answer& b) {
    work += b.work;
    broken += b.broken;
    powerOfBroken += b.powerOfBroken;
    return *this;
  }
};

Answer answerBond(const Particles& particles, Bonds& bonds, const geometry::Periodicity& space, std::size_t b,
                  double dt) {
  Bond& bond = bonds.bonds[b];
  const auto i = static_cast<std::size_t>(bond.i), j = static_cast<std::size_t>(bond.j);
  const Vec3 omegaI = particles.omega[i], omegaJ = particles.omega[j];
  turnEnds(bond, omegaI, omegaJ, dt);
  const Line line = lineOf(particles, bond, space);
  Answer answer;
  double& energy = bonds.energy[b];
  Bonds::Forces& f = bonds.forces[b];
  f = elasticForces(bond, line, energy);
  bonds.utilised[b] = utilisation(bond, line, f);
  const double fraction = fractionOf(particles, bond);
  energy *= fraction;
  weigh(f, fraction);
  if (dt > 0.0 && bonds.utilised[b] > 1.0) {
    answer.work.fracturePower = energy / dt;
    answer.powerOfBroken =
        dot(f.force, particles.v[j] - particles.v[i]) + dot(f.torqueI, omegaI) + dot(f.torqueJ, omegaJ);
    f = {};
    answer.broken = 1;
    return answer;
  }
  answer.work.elasticEnergy = energy;
  if (bond.dampingTime > 0.0) {
    Bonds::Forces damping;
    answer.work.dissipatedPower =
        fraction * addDamping(bond, line, particles.v[j] - particles.v[i], omegaI, omegaJ, damping);
    weigh(damping, fraction);
    f.force += damping.force;
    f.torqueI += damping.torqueI;
    f.torqueJ += damping.torqueJ;
  }
  return answer;
}

}  // namespace

double dashpotPower(const Particles& particles, const Bonds& bonds, const geometry::Periodicity& space,
                    std::span<const Vec3> v, std::span<const Vec3> omega) {
  return parallelSum(bonds.size(), 512, [&](std::size_t begin, std::size_t end) {
    double power = 0.0;
    for (std::size_t b = begin; b < end; ++b) {
      const Bond& bond = bonds.bonds[b];
      if (!(bond.dampingTime > 0.0)) continue;
      const auto i = static_cast<std::size_t>(bond.i), j = static_cast<std::size_t>(bond.j);
      Bonds::Forces f;
      addDamping(bond, lineOf(particles, bond, space), particles.v[j] - particles.v[i], particles.omega[i],
                 particles.omega[j], f);
      weigh(f, fractionOf(particles, bond));
      power -= dot(f.force, v[j] - v[i]) + dot(f.torqueI, omega[i]) + dot(f.torqueJ, omega[j]);
    }
    return power;
  });
}

ContactWork exchangeBonds(Particles& particles, Bonds& bonds, const geometry::Periodicity& space, double dt) {
  requireNonNegative(dt, "time step of bonds");
  detail::updateEnds(particles, bonds);
  bonds.forces.resize(bonds.size());
  bonds.energy.resize(bonds.size());
  bonds.utilised.resize(bonds.size());
  const Answer answer = parallelSum(bonds.size(), 512, [&](std::size_t begin, std::size_t end) {
    Answer sum;
    for (std::size_t b = begin; b < end; ++b) sum += answerBond(particles, bonds, space, b, dt);
    return sum;
  });
  bonds.broken.clear();
  bonds.powerOfBroken = answer.powerOfBroken;
  bonds.brokenSoFar += answer.broken;
  for (std::size_t b = answer.broken > 0 ? bonds.size() : 0; b-- > 0;)
    if (bonds.utilised[b] > 1.0) {
      const auto [i, j] = std::minmax(bonds.bonds[b].i, bonds.bonds[b].j);
      bonds.broken.push_back({i, j});
      detail::removeBond(bonds, b);
    }
  std::erase_if(bonds.broken, [&](const auto& pair) { return detail::joined(bonds, pair[0], pair[1]); });
  detail::gatherForces(bonds, particles);
  return answer.work;
}

}  // namespace dovetail::dem
