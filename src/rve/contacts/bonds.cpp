#include "dovetail/rve/bonds.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "bonded.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "touching.hpp"

namespace dovetail::rve {

namespace {

constexpr const char* where = "bonds of a cell";

void check(const Rve& cell, const BondLaw& law) {
  if (cell.shape != Shape::disc) throw InputError("the grains are spheres", where, "bond discs");
  if (!cell.state.contacts.bond.empty()) throw InputError("the cell is bonded already", where, "give one that is not");
  validate(law);
}

bool breaks(const BondLaw& law, const BondTouch& b) {
  return -b.normalForce / law.tensileStrength + std::abs(b.tangentialForce) / law.shearStrength +
             std::abs(b.moment) / law.bendingStrength >=
         b.fraction;
}

/// A contact with the springs of the cell from here on; what it has not of the bond's energy is booked.
void breakBond(Rve& cell, BondTouch& b) {
  Contacts& contacts = cell.state.contacts;
  const double ri = cell.radius[b.i], rj = cell.radius[b.j], before = b.energy();
  const double k = b.fraction * normalStiffness(cell.springs, ri, rj), overlap = std::max(ri + rj - b.distance, 0.0);
  const double kt = cell.springs.slides() ? k * cell.springs.tangential : 0.0;
  const double most = cell.springs.friction * k * overlap;
  contacts.bond[b.contact] = {};
  contacts.stiffness[b.contact] = k;
  b.normalForce = k * overlap;
  b.tangentialForce = kt > 0.0 && overlap > 0.0 ? std::clamp(b.tangentialForce, -most, most) : 0.0;
  b.moment = 0.0;
  b.normalStiffness = k;
  b.shearStiffness = kt;
  contacts.stretch[0][b.contact] = kt > 0.0 ? b.tangentialForce / kt : 0.0;
  if (!contacts.roll.empty()) contacts.roll[b.contact] = 0.0;
  cell.state.ledger.bonds += before - b.energy();
}

void addForces(Rve& cell, const BondTouch& b) {
  CellState& s = cell.state;
  const Vec3 f = b.forceOnI();
  const double armI = b.armI(cell);
  for (int k = 0; k < 2; ++k) {
    s.force[static_cast<std::size_t>(k)][b.i] += f[k];
    s.force[static_cast<std::size_t>(k)][b.j] -= f[k];
    for (int l = 0; l < 2; ++l) s.virial(k, l) += f[k] * b.branch[l];
  }
  s.torque[2][b.i] += armI * b.tangentialForce - b.moment;
  s.torque[2][b.j] += (b.distance - armI) * b.tangentialForce + b.moment;
}

}  // namespace

void validate(const BondLaw& law) {
  requirePositive(law.normal, "normal stiffness of the bonds");
  requireNonNegative(law.shear, "shear stiffness of the bonds");
  requireNonNegative(law.bending, "bending stiffness of the bonds");
  for (const double strength : {law.tensileStrength, law.shearStrength, law.bendingStrength})
    if (!(strength > 0.0))
      throw InputError("a strength is " + formatNumber(strength), where, "give one above 0, or infinity");
}

void bond(Rve& cell, const BondLaw& law) {
  check(cell, law);
  Contacts& contacts = cell.state.contacts;
  std::vector<Bond> bonds(contacts.size());
  const double before = storedEnergy(cell);
  forEachTouch(cell, [&](const Touch& touch) {
    const double fraction = cell.frame.empty() ? 1.0
                                               : touch.stiffness / normalStiffness(cell.springs, cell.radius[touch.i],
                                                                                   cell.radius[touch.j]);
    const auto stretchFor = [&](double force, double stiffness) {
      return stiffness > 0.0 ? force / (fraction * stiffness) : 0.0;
    };
    const double tangentialForce = dot(contactForce(cell, touch), Vec3{-touch.normal.y, touch.normal.x, 0.0});
    bonds[touch.contact] = {touch.distance + stretchFor(touch.normalForce, law.normal), fraction,
                            stretchFor(tangentialForce, law.shear),
                            stretchFor(rollingStiffness(cell, touch) * touch.roll, law.bending)};
  });
  cell.bonds = cell.state.bonds = law;
  contacts.bond = std::move(bonds);
  leaveToBonds(contacts);
  cell.state.ledger.bonds += before - storedEnergy(cell);
  setSprings(cell, cell.springs);  // lists, steps and forces anew; what is too weak breaks
}

void sweepBonds(Rve& cell, double dt, const MeanMotion& motion) {
  CellState& s = cell.state;
  const Eigen::Matrix3d& D = motion.rate;
  const std::array<Vec3, 27> shift = imageShifts(s.lattice);
  for (std::size_t i = 0; i < cell.size(); ++i)
    for (int c = s.contacts.first[i]; c < s.contacts.first[i + 1]; ++c) {
      const auto at = static_cast<std::size_t>(c);
      Bond& bond = s.contacts.bond[at];
      if (!(bond.length > 0.0)) continue;
      const BondTouch now = bondTouch(cell, shift, i, at);
      const Vec3 t = now.along(), &b = now.branch;
      const double wx = s.v[0][now.j] - s.v[0][i] + D(0, 0) * b.x + D(0, 1) * b.y;
      const double wy = s.v[1][now.j] - s.v[1][i] + D(1, 0) * b.x + D(1, 1) * b.y;
      const double armI = now.armI(cell), spinI = s.spin[2][i], spinJ = s.spin[2][now.j];
      bond.stretch += (wx * t.x + wy * t.y - armI * spinI - (now.distance - armI) * spinJ) * dt;
      bond.turn += (spinI - spinJ) * dt;
      BondTouch moved = bondTouch(cell, shift, i, at);
      if (breaks(cell.bonds, moved)) breakBond(cell, moved);
      addForces(cell, moved);
    }
}

ContactMatrix linearised(const Rve& cell, const BondTouch& bond, const Linearisation& what) {
  using Row = Eigen::Matrix<double, 1, 9>;
  const double d = bond.distance, armI = bond.armI(cell), armJ = d - armI;
  const double normalForce = what.prestress ? bond.normalForce : 0.0,
               tangentialForce = what.prestress ? bond.tangentialForce : 0.0;
  const Eigen::Vector3d n(bond.normal.x, bond.normal.y, 0.0), t(-n[1], n[0], 0.0);
  Row away = Row::Zero(), across = Row::Zero(), turn = Row::Zero();
  away.head<3>() = n.transpose();
  across.head<3>() = t.transpose();
  turn[5] = bond.bendingStiffness;
  turn[8] = -bond.bendingStiffness;
  Row slide = across;
  slide[5] = -armI;
  slide[8] = -armJ;
  slide *= bond.shearStiffness;
  ContactMatrix m = ContactMatrix::Zero();
  m.topRows<3>() =
      n * (bond.normalStiffness * away - tangentialForce / d * across) + t * (slide - normalForce / d * across);
  m.row(5) = 0.5 * tangentialForce * away + armI * slide - turn;
  m.row(8) = 0.5 * tangentialForce * away + armJ * slide + turn;
  return m;
}

void boundStiffness(const Rve& cell, Contacts& contacts) {
  for (std::size_t i = 0; i < cell.size(); ++i)
    for (int c = contacts.first[i]; c < contacts.first[i + 1]; ++c) {
      const auto at = static_cast<std::size_t>(c);
      if (!isBonded(contacts, at)) continue;
      const double least = std::min(cell.radius[i], cell.radius[static_cast<std::size_t>(contacts.other[at])]);
      const BondLaw& law = cell.bonds;
      // Inertia ½ m r²: sliding with turning, and bending of the smaller grain.
      const double k = std::max(law.normal, 3.0 * law.shear + 2.0 * law.bending / (least * least));
      contacts.stiffness[at] = std::max(contacts.stiffness[at], contacts.bond[at].fraction * k);
    }
}

void leaveToBonds(Contacts& contacts) {
  for (std::size_t c = 0; c < contacts.bond.size(); ++c)
    if (isBonded(contacts, c)) contacts.stiffness[c] = 0.0;
}

}  // namespace dovetail::rve
