// Walls that go on with what those of a state remember.
#include <algorithm>

#include "dovetail/dem/model/checkpoint.hpp"
#include "dovetail/dem/model/walls.hpp"
#include "events.hpp"

namespace dovetail::dem {

namespace {

bool areNear(const Vec3& a, const Vec3& b, double distance) { return norm(a - b) <= distance; }

bool areSame(const PrimitiveWall& a, const PrimitiveWall& b, double distance) {
  constexpr double angle = 1e-9;
  return a.shape == b.shape && a.inside == b.inside && a.material == b.material &&
         std::abs(a.radius - b.radius) <= distance && areNear(a.point, b.point, distance) &&
         areNear(a.axis, b.axis, angle);
}
bool areSame(const MeshWall& a, const MeshWall& b, double distance) {
  return a.wall.facets == b.wall.facets && a.wall.oneSided == b.wall.oneSided && a.wall.material == b.wall.material &&
         std::ranges::equal(a.wall.x, b.wall.x, [=](const Vec3& p, const Vec3& q) { return areNear(p, q, distance); });
}

/// @param part  of a term, the wall
template <class WallTerm, class Wall>
int take(Model& m, const std::vector<TermOfState>& terms, const char* name, Wall WallTerm::*part) {
  const double distance = 1e-9 * smallestRadius(m.particles);
  std::vector<WallTerm> saved;
  for (const TermOfState& term : terms) {
    if (term.name != name) continue;
    ByteReader reader(term.bytes);
    saved.emplace_back(Wall{}).load(reader);
  }
  int without = 0;
  for (auto* const term : m.terms.all<WallTerm>()) {
    const auto same =
        std::ranges::find_if(saved, [&](const WallTerm& one) { return areSame(one.*part, term->*part, distance); });
    if (same == saved.end()) {
      ++without;
      continue;
    }
    (term->*part).contacts = std::move(((*same).*part).contacts);
    term->stored = same->stored;
    saved.erase(same);
  }
  return without;
}

}  // namespace

int takeWallContacts(Model& m, const std::vector<TermOfState>& terms) {
  return take(m, terms, "walls", &PrimitiveWallTerm::wall) + take(m, terms, "mesh walls", &MeshWallTerm::mesh);
}

}  // namespace dovetail::dem
