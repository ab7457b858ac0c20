#include "dovetail/dem/bonds/bonds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"

namespace dovetail::dem {

namespace {

constexpr double pi = std::numbers::pi;

void requirePositiveOrInfinite(double value, const std::string& field) {
  if (!(value > 0.0))
    throw InputError(field + " is " + formatNumber(value), field,
                     "give a number greater than zero; infinite: never breaks");
}

Vec3 anyAcross(const Vec3& direction) {
  const Vec3 axis = std::abs(direction.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  return normalized(cross(direction, axis));
}

}  // namespace

void validate(const BondMaterial& material) {
  requirePositive(material.youngsModulus, "Young's modulus of bonds");
  if (!(material.poissonRatio > -1.0 && material.poissonRatio <= 0.5))
    throw InputError("Poisson's ratio is " + formatNumber(material.poissonRatio), "Poisson's ratio of bonds",
                     "give −1 < ν ≤ 0.5");
  requirePositive(material.radiusRatio, "radius ratio of bonds");
  requireNonNegative(material.shearCorrection, "shear correction of bonds");
  requirePositiveOrInfinite(material.tensileStrength, "tensile strength of bonds");
  requirePositiveOrInfinite(material.shearStrength, "shear strength of bonds");
  if (!(material.momentContribution >= 0.0 && material.momentContribution <= 1.0))
    throw InputError("the fraction of the moments is " + formatNumber(material.momentContribution),
                     "moment contribution of bonds", "give a number from 0 to 1");
  requireNonNegative(material.dampingTime, "damping time of bonds");
}

int addBond(Bonds& bonds, const Particles& particles, const geometry::Periodicity& space, int i, int j,
            const BondMaterial& material) {
  validate(material);
  const auto exists = [&](int k) { return k >= 0 && static_cast<std::size_t>(k) < particles.size(); };
  const std::string where = "bond between particles " + std::to_string(i) + " and " + std::to_string(j);
  if (!exists(i) || !exists(j) || i == j)
    throw InputError("these are not two particles", where,
                     "give two numbers below " + std::to_string(particles.size()));
  const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
  const Vec3 d = space.minimumImage(particles.x[b] - particles.x[a]);
  const double length = norm(d), r = material.radiusRatio * std::min(particles.radius[a], particles.radius[b]);
  if (!(length > 0.0) || !std::isfinite(length))
    throw InputError("the centres are " + formatNumber(length) + " m apart", where,
                     "bond particles at different places");
  const double E = material.youngsModulus, G = 0.5 * E / (1.0 + material.poissonRatio);
  const double area = pi * r * r, inertia = 0.25 * area * r * r;
  const double flexibility =  // Φ: bending over shear
      material.shearCorrection > 0.0 ? 12.0 * E * inertia / (material.shearCorrection * G * area * length * length)
                                     : 0.0;
  Bond bond;
  bond.i = i;
  bond.j = j;
  bond.length = length;
  bond.normal = E * area / length;
  bond.shear = 12.0 * E * inertia / (length * length * length * (1.0 + flexibility));
  bond.bending = E * inertia / length;
  bond.twisting = 2.0 * G * inertia / length;
  bond.radius = r;
  bond.tensileStrength = material.tensileStrength;
  bond.shearStrength = material.shearStrength;
  bond.momentContribution = material.momentContribution;
  bond.dampingTime = material.dampingTime;
  bond.directionI = d / length;
  bond.directionJ = -bond.directionI;
  bond.acrossI = bond.acrossJ = anyAcross(bond.directionI);
  bonds.bonds.push_back(bond);
  return static_cast<int>(bonds.size()) - 1;
}

namespace {

/// A list of all pairs that may be as close as `gap`.
PairList pairsWithin(const Particles& particles, const PairList& of, double gap) {
  PairList list;
  list.setPeriodicity(of.periodicity());
  const auto largest = std::max_element(particles.radius.begin(), particles.radius.end());
  list.setSkin(std::max(0.0, gap) + 1e-9 * (largest == particles.radius.end() ? 1.0 : *largest));
  Particles placed = particles;  // the search moves them by periods
  findPairs(placed, list);
  return list;
}

/// Pairs that are bonded, the lower number first, ascending.
std::vector<std::array<int, 2>> bondedPairs(const Bonds& bonds) {
  std::vector<std::array<int, 2>> pairs;
  pairs.reserve(bonds.size());
  for (const Bond& bond : bonds.bonds) pairs.push_back({std::min(bond.i, bond.j), std::max(bond.i, bond.j)});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

int bondTouching(Bonds& bonds, const Particles& particles, const PairList& list, double gap,
                 const BondMaterial& material, const std::function<bool(int i, int j)>& wanted) {
  const bool serves =
      list.fits(particles) && (std::isinf(list.travel()) || gap + 2.0 * list.travel() <= list.innerSkin());
  const PairList own = serves ? PairList{} : pairsWithin(particles, list, gap);
  const geometry::Periodicity& space = list.periodicity();
  const std::vector<std::array<int, 2>> bonded = bondedPairs(bonds);
  int count = 0;
  for (const auto& pair : (serves ? list : own).pairs()) {
    const auto [i, j] = pair;
    if (wanted && !wanted(i, j)) continue;
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    const double distance = norm(space.minimumImage(particles.x[a] - particles.x[b]));
    if (distance > particles.radius[a] + particles.radius[b] + gap) continue;
    if (std::binary_search(bonded.begin(), bonded.end(), pair)) continue;
    addBond(bonds, particles, space, i, j, material);
    ++count;
  }
  return count;
}

namespace {

/// Bonds that lie near each other in memory are those of particles that do.
void sortByParticle(Bonds& bonds) {
  std::vector<std::array<int, 3>> order;
  order.reserve(bonds.size());
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const Bond& bond = bonds.bonds[b];
    order.push_back({std::min(bond.i, bond.j), std::max(bond.i, bond.j), static_cast<int>(b)});
  }
  if (std::is_sorted(order.begin(), order.end())) return;
  std::sort(order.begin(), order.end());
  const std::vector<Bond> old = std::move(bonds.bonds);
  const std::vector<double> energy = std::move(bonds.energy);
  bonds.bonds.clear();
  bonds.energy.clear();
  for (const auto& entry : order) {
    bonds.bonds.push_back(old[static_cast<std::size_t>(entry[2])]);
    bonds.energy.push_back(energy[static_cast<std::size_t>(entry[2])]);
  }
}

}  // namespace

double renumber(Bonds& bonds, std::span<const int> newNumber) {
  std::size_t kept = 0;
  double gone = 0.0;
  bonds.ends = {};
  bonds.forces.clear();
  bonds.utilised.clear();
  bonds.energy.resize(bonds.size(), 0.0);
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    Bond bond = bonds.bonds[b];
    bond.i = newNumber[static_cast<std::size_t>(bond.i)];
    bond.j = newNumber[static_cast<std::size_t>(bond.j)];
    if (bond.i < 0 || bond.j < 0) {
      gone += bonds.energy[b];
      continue;
    }
    bonds.energy[kept] = bonds.energy[b];
    bonds.bonds[kept++] = bond;
  }
  bonds.bonds.resize(kept);
  bonds.energy.resize(kept);
  sortByParticle(bonds);
  return gone;
}

void muteBonded(const Bonds& bonds, PairList& list) {
  const std::span<double> factors = list.writeFactors();
  for (const Bond& bond : bonds.bonds) {
    const std::array<int, 2> pair{std::min(bond.i, bond.j), std::max(bond.i, bond.j)};
    if (const auto place = list.find(pair)) factors[*place] = 0.0;
  }
}

}  // namespace dovetail::dem
