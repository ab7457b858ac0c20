// One sweep under a law: for tests that have the law and not yet a scene to hold it.
#pragma once

#include "dovetail/dem/laws/contact_laws.hpp"

namespace dovetail::dem {

/// @param law one or a table, listed (listed_laws.hpp) or compiled by the file that calls (own_laws.hpp)
ContactWork sweepPairs(const auto& law, Particles& particles, PairList& list, double dt = 0.0) {
  return makeContactLaws(law)->pairs(particles, list, dt, Booking::on);
}

ContactWork sweepWall(const auto& law, Particles& particles, PrimitiveWall& wall, double dt = 0.0) {
  return makeContactLaws(law)->wall(particles, wall, dt, Booking::on);
}

ContactWork sweepWall(const auto& law, Particles& particles, const TriangulatedWall& wall, WallContacts& contacts,
                      double dt = 0.0) {
  return makeContactLaws(law)->wall(particles, wall, contacts, dt, Booking::on);
}

}  // namespace dovetail::dem
