#include "make_rve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "contacts/contact_list.hpp"
#include "contacts/sweep.hpp"
#include "contacts/touching.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/rve.hpp"

namespace dovetail::rve {

namespace {

constexpr const char* where = "cell of grains";

void check(const Grains& grains, const geometry::Lattice& lattice) {
  const std::size_t n = grains.centre.size();
  if (n == 0 || grains.radius.size() != n)
    throw InputError(std::to_string(n) + " centres and " + std::to_string(grains.radius.size()) + " radii", where,
                     "give one of each per grain, and at least one grain");
  requirePositive(grains.density, "density of the grains");
  for (std::size_t i = 0; i < n; ++i) {
    const std::string grain = "grain " + std::to_string(i);
    if (!isFinite(grains.centre[i])) throw InputError("the centre is not finite", grain, "give a finite one");
    if (!(grains.radius[i] > 0.0) || !std::isfinite(grains.radius[i]))
      throw InputError("the radius is " + formatNumber(grains.radius[i]) + " m", grain, "give one above 0");
    if (grains.shape == Shape::disc && grains.centre[i].z != 0.0)
      throw InputError("a disc lies at z = " + formatNumber(grains.centre[i].z) + " m", grain, "put it at z = 0");
  }
  if (grains.shape == Shape::sphere) return;
  const auto& [a, b, c] = lattice.period;
  if (a.z != 0.0 || b.z != 0.0 || c.x != 0.0 || c.y != 0.0 || lattice.axes[2])
    throw InputError("the periods do not fit a plane", where,
                     "let the first two lie in z = 0, and the third, which is not periodic, along z");
}

void checkShape(Shape shape, const Springs& springs) {
  if (springs.rolls() && shape == Shape::sphere)
    throw InputError("spheres resist rolling", where, "leave rolling resistance to discs");
  if (springs.elasticSpheres() && shape == Shape::disc)
    throw InputError("discs have the springs of elastic spheres", where, "give discs a modulus or a stiffness");
}

void setMasses(Rve& cell, const Grains& grains, double thickness) {
  for (const double r : cell.radius) {
    const bool disc = cell.shape == Shape::disc;
    const double mass = grains.density * std::numbers::pi * r * r * (disc ? thickness : 4.0 / 3.0 * r);
    cell.mass.push_back(mass);
    cell.inertia.push_back((disc ? 0.5 : 0.4) * mass * r * r);
  }
}

void place(Rve& cell, const Grains& grains) {
  const bool disc = cell.shape == Shape::disc;
  for (int k = 0; k < 3; ++k) {
    const auto a = static_cast<std::size_t>(k);
    if (!disc || k < 2) {
      cell.state.v[a].assign(cell.size(), 0.0);
      for (const Vec3& x : grains.centre) cell.state.x[a].push_back(x[k]);
    }
    if (!disc || k == 2) cell.state.spin[a].assign(cell.size(), 0.0);
  }
  cell.state.force = cell.state.v;
  cell.state.torque = cell.state.spin;
}

}  // namespace

void validate(const Springs& springs) {
  requireNonNegative(springs.modulus, "modulus of the springs");
  requireNonNegative(springs.stiffness, "stiffness of the springs");
  requireNonNegative(springs.hertz, "modulus of elastic spheres");
  if ((springs.modulus > 0.0) + (springs.stiffness > 0.0) + (springs.hertz > 0.0) != 1)
    throw InputError("the modulus is " + formatNumber(springs.modulus) + " Pa, the stiffness " +
                         formatNumber(springs.stiffness) + " N/m, the modulus of elastic spheres " +
                         formatNumber(springs.hertz) + " Pa",
                     "springs", "give one of them, and 0 for the others");
  requireNonNegative(springs.tangential, "ratio of tangential and normal stiffness");
  if (!(springs.friction >= 0.0))
    throw InputError("friction is " + formatNumber(springs.friction), "springs", "give a coefficient of 0 or more");
  requireNonNegative(springs.rolling, "ratio of rolling stiffness");
  requireNonNegative(springs.rollingLimit, "limit of rolling resistance");
}

Springs hertzMindlin(double shearModulus, double poisson, double friction) {
  requirePositive(shearModulus, "shear modulus of the spheres");
  if (!(poisson > -1.0 && poisson <= 0.5))
    throw InputError("Poisson's ratio is " + formatNumber(poisson), "springs", "give one above -1, of at most 0.5");
  return {.hertz = shearModulus / (1.0 - poisson),
          .tangential = 2.0 * (1.0 - poisson) / (2.0 - poisson),
          .friction = friction};
}

Rve cellWithoutContacts(const Grains& grains, const geometry::Lattice& lattice, const Springs& springs) {
  validate(springs);
  check(grains, lattice);
  Rve cell;
  cell.shape = grains.shape;
  cell.springs = springs;
  checkShape(grains.shape, springs);
  cell.radius = grains.radius;
  cell.density = grains.density;
  cell.skin = 0.2 * meanDiameter(cell) * 0.5;
  cell.state.springs = springs;
  static_cast<void>(geometry::inverse(lattice));
  cell.state.lattice = lattice;
  geometry::reduce(cell.state.lattice);
  cell.volume = lattice.volume();
  setMasses(cell, grains, norm(lattice.period[2]));
  place(cell, grains);
  return cell;
}

Rve makeRve(const Grains& grains, const geometry::Lattice& lattice, const Springs& springs) {
  Rve cell = cellWithoutContacts(grains, lattice, springs);
  const std::array<double, 3> widths = cell.state.lattice.widths();
  for (std::size_t k = 0; k < 3; ++k)
    if (lattice.axes[k] && widths[k] < 2.0 * listReach(cell))
      throw InputError("faces across period " + std::to_string(k + 1) + " are " + formatNumber(widths[k]) + " m apart",
                       where,
                       "take more grains: " + formatNumber(2.0 * listReach(cell)) +
                           " m, two of the largest diameters and skins, are the least");
  updateNeighbourList(cell);
  sweep(cell, 0.0);
  requireFiniteForces(cell);
  return cell;
}

double volume(const Rve& cell) { return cell.state.lattice.volume(); }

double meanDiameter(const Rve& cell) {
  double sum = 0.0;
  for (const double r : cell.radius) sum += r;
  return 2.0 * sum / static_cast<double>(cell.size());
}

double solidFraction(const Rve& cell) {
  double mass = 0.0;
  for (const double m : cell.mass) mass += m;
  for (const std::vector<int>& group : cell.frame.alike)
    for (std::size_t k = 1; k < group.size(); ++k)
      mass -= cell.mass[static_cast<std::size_t>(cell.frame.grain[static_cast<std::size_t>(group[k])])];
  return mass / (cell.density * volume(cell));
}

namespace {

/// What springs hold that have no friction or limit any more is lost.
void release(Rve& cell, const Springs& springs) {
  const double stored = storedEnergy(cell);
  Contacts& contacts = cell.state.contacts;
  if (!springs.slides())
    for (std::vector<double>& component : contacts.stretch) std::ranges::fill(component, 0.0);
  if (!springs.rolls()) std::ranges::fill(contacts.roll, 0.0);
  cell.state.ledger.friction += stored - storedEnergy(cell);
}

}  // namespace

void setSprings(Rve& cell, const Springs& springs) {
  validate(springs);
  checkShape(cell.shape, springs);
  release(cell, springs);
  RveLedger& ledger = cell.state.ledger;
  const auto accounted = [&] { return storedEnergy(cell) + ledger.friction + ledger.bonds; };
  const double before = accounted();
  cell.springs = cell.state.springs = springs;
  Contacts& contacts = cell.state.contacts;
  contacts.roll.resize(springs.rolls() ? contacts.size() : 0, 0.0);
  contacts.tangent.clear();
  updateNeighbourList(cell);
  if (!contacts.tangent.empty())  // stretches stay, whatever k_t was
    forEachTouch(cell,
                 [&](const Touch& touch) { contacts.tangent[touch.contact] = springs.tangential * touch.stiffness; });
  sweep(cell, 0.0);
  ledger.work += accounted() - before;
}

}  // namespace dovetail::rve
