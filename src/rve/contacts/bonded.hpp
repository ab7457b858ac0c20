// Contacts that are bonded, one by one.
#pragma once

#include <cmath>

#include "linear_contact.hpp"
#include "sweep.hpp"

namespace dovetail::rve {

struct BondTouch {
  std::size_t contact, i, j;
  Vec3 branch, normal;                                       ///< b, m, and b/|b|
  double distance;                                           ///< |b|, m
  double normalStiffness, shearStiffness, bendingStiffness;  ///< N/m, N/m, N m, of what lies here
  double normalForce, tangentialForce, moment;               ///< N, against approach; N, on i along e_z × n; N m, on j
  double fraction;

  double armI(const Rve& cell) const { return 0.5 * (distance + cell.radius[i] - cell.radius[j]); }
  Vec3 along() const { return {-normal.y, normal.x, 0.0}; }
  Vec3 forceOnI() const { return -normalForce * normal + tangentialForce * along(); }
  double energy() const;
};

inline double BondTouch::energy() const {
  const auto stored = [](double force, double k) { return k > 0.0 ? 0.5 * force * force / k : 0.0; };
  return stored(normalForce, normalStiffness) + stored(tangentialForce, shearStiffness) +
         stored(moment, bendingStiffness);
}

inline bool isBonded(const Contacts& contacts, std::size_t c) {
  return !contacts.bond.empty() && contacts.bond[c].length > 0.0;
}

inline BondTouch bondTouch(const Rve& cell, const std::array<Vec3, 27>& shift, std::size_t i, std::size_t c) {
  const CellState& s = cell.state;
  const auto j = static_cast<std::size_t>(s.contacts.other[c]);
  const Vec3 b = Vec3{s.x[0][j] - s.x[0][i], s.x[1][j] - s.x[1][i], 0.0} + shift[s.contacts.image[c]];
  const double d = norm(b);
  const Bond& bond = s.contacts.bond[c];
  const double kn = bond.fraction * cell.bonds.normal, ks = bond.fraction * cell.bonds.shear,
               kb = bond.fraction * cell.bonds.bending;
  return {c, i, j, b, b / d, d, kn, ks, kb, kn * (bond.length - d), ks * bond.stretch, kb * bond.turn, bond.fraction};
}

/// Calls visit(bond) for each contact that is bonded, in the order of the list.
template <class Visit>
void forEachBond(const Rve& cell, const Visit& visit) {
  const Contacts& contacts = cell.state.contacts;
  if (contacts.bond.empty()) return;
  const std::array<Vec3, 27> shift = imageShifts(cell.state.lattice);
  for (std::size_t i = 0; i < cell.size(); ++i)
    for (int c = contacts.first[i]; c < contacts.first[i + 1]; ++c)
      if (isBonded(contacts, static_cast<std::size_t>(c)))
        visit(bondTouch(cell, shift, i, static_cast<std::size_t>(c)));
}

/// The part of sweep that bonds have; those that have reached their strength break.
void sweepBonds(Rve& cell, double dt, const MeanMotion& motion);

ContactMatrix linearised(const Rve& cell, const BondTouch& bond, const Linearisation& what);

/// What bonds ask of lists made anew: contacts that are bonded are as stiff as the stiffer of contact and bond in
/// `boundStiffness`, and press by their bond alone afterwards.
void boundStiffness(const Rve& cell, Contacts& contacts);
void leaveToBonds(Contacts& contacts);

}  // namespace dovetail::rve
