// EdgeRule::projected: contacts with walls as the gradient of one potential.
#include <algorithm>
#include <span>
#include <vector>

#include "dovetail/core/vector_code.hpp"
#include "facet_potential.hpp"
#include "wall_side.hpp"

namespace dovetail::dem {

namespace {

/// Memory that is kept between particles and steps.
struct Scratch {
  MetFacets near;
  std::vector<MetFacet> exits;
  FacetPotential::Scratch potential;
};

/// One particle against the walls near it.
class Projection {
public:
  Projection(std::span<const MetWall> walls, Scratch& scratch)
      : walls_(walls), radius_(walls.front().encounter.radius), scratch_(scratch) {}

  void append() {
    withVectors([&] { look(radius_); });
    if (sunkIn()) return appendSunk();
    if (scratch_.near.empty()) return;
    if (nearestSuffices()) return nearest().met->add(nearest().entry, nearest().view, nearestOverlap(), 1.0, 1.0);
    look(radius_ + 2.0 * nearestOverlap());
    const MetFacet first = nearest();
    const auto near = scratch_.near.all();
    std::stable_partition(near.begin(), near.end(), [&](const MetFacet& f) { return f.view.distance < radius_; });
    FacetPotential potential(radius_, near, false, scratch_.potential);
    potential.lower({first, (radius_ - first.view.distance) * first.view.normal});
    potential.append();
  }

private:
  const MetFacet& nearest() const { return scratch_.near[nearest_]; }
  double nearestOverlap() const { return radius_ - nearest().view.distance; }

  /// Facets closer than reach, but for those of one-sided walls that show their back.
  void look(double reach) {
    MetFacets& near = scratch_.near;
    near.clear();
    nearest_ = 0;
    front_ = back_ = reach;
    for (const MetWall& met : walls_) {
      for (std::size_t k = 0; k < met.encounter.size(); ++k) {
        if (!met.encounter.mayBeWithin(k, reach - radius_)) continue;
        const FacetCorners corners = met.corners(k);
        if (corners.beyond(reach)) continue;
        MetFacet& next = near.next();
        viewFacet({}, corners, radius_, reach, met.wall->oneSided, next.view);
        const FacetView& seen = next.view;
        if (seen.behind()) back_ = std::min(back_, seen.farness());
        if (!(seen.distance >= 0.0 && seen.distance < reach)) continue;
        next.met = &met;
        next.entry = k;
        if (seen.distance < front_) {
          front_ = seen.distance;
          nearest_ = near.size();
        }
        near.keepNext();
      }
    }
  }

  /// Only where a back is as near as any front is there something to decide.
  bool sunkIn() const {
    return back_ < radius_ && back_ <= front_ + sameFoot * radius_ && insideWall(walls_, std::min(front_, back_));
  }

  /// Whether stepping out of the nearest facet clears all others. Distance to a facet is a convex function, so that
  /// being clear of its tangent plane suffices; if that fails, look again from there.
  bool nearestSuffices() const {
    const Vec3& normal = nearest().view.normal;
    const double depth = nearestOverlap(), slack = 1e-13 * radius_;
    for (std::size_t i = 0; i < scratch_.near.size(); ++i) {
      const FacetView& other = scratch_.near[i].view;
      const double g = dot(other.normal, normal);
      if (i == nearest_ || coupling(g) * depth >= radius_ - other.distance - slack) continue;
      if (g <= 0.0) return false;
      FacetView after;
      viewFacet(depth * normal, scratch_.near[i].corners(), radius_, FacetView::unseen, false, after);
      if (after.distance < radius_ - slack || dot(after.normal, normal) < couplingBlend) return false;
    }
    return true;
  }

  /// Out by the shortest way: through the face that asks for least.
  void appendSunk() {
    scratch_.near.clear();
    scratch_.exits.clear();
    for (const MetWall& met : walls_) collectBothSides(met);
    std::sort(scratch_.exits.begin(), scratch_.exits.end(),
              [](const MetFacet& a, const MetFacet& b) { return a.view.farness() < b.view.farness(); });
    FacetPotential potential(radius_, scratch_.near.all(), true, scratch_.potential);
    for (const MetFacet& exit : scratch_.exits) {
      const double way = radius_ + exit.view.farness(), least = 0.5 * way * way;
      if (!scratch_.potential.best.facets.empty() && least >= scratch_.potential.best.energy) break;
      potential.lower({exit, {}, true}, (1.0 - 1e-12) * least);
    }
    if (!scratch_.potential.best.facets.empty()) potential.append();
  }

  void collectBothSides(const MetWall& met) {
    for (std::size_t k = 0; k < met.encounter.size(); ++k) {
      MetFacet& next = scratch_.near.next();
      const FacetCorners corners = met.corners(k);
      viewFacet({}, corners, radius_, radius_, met.wall->oneSided, next.view);
      if (!next.view.behind() && !(next.view.distance < radius_)) continue;
      next.met = &met;
      next.entry = k;
      scratch_.near.keepNext();
      if (!next.view.behind() || onRim(met, k, next.view.feature)) continue;
      scratch_.exits.push_back(next);
      Vec3& normal = scratch_.exits.back().view.normal;
      normal = geometry::triangleNormal(corners.a, corners.b, corners.c);
    }
  }

  std::span<const MetWall> walls_;
  double radius_;
  Scratch& scratch_;
  std::size_t nearest_ = 0;
  double front_ = 0.0, back_ = 0.0;  // of the nearest facet from its front, and of one-sided ones from their back, m
};

/// The contact with facets that all lie in one plane, if the foot is on one of them: then it is the nearest, and the
/// others add nothing. False if it is on none.
/// @param last where to look first, and where the foot was found @param reach beyond touch, m
bool appendFlat(const MetWall& met, double reach, int& last) {
  const Encounter& e = met.encounter;
  const auto tryEntry = [&](std::size_t k) {
    FacetView seen;
    viewFacet({}, met.corners(k), e.radius, FacetView::unseen, met.wall->oneSided, seen);
    if (!seen.face()) return false;
    last = static_cast<int>(k);
    if (seen.distance < e.radius + reach) met.add(k, seen, e.radius - seen.distance, 1.0, 1.0);
    return true;
  };
  if (last >= 0 && tryEntry(static_cast<std::size_t>(last))) return true;
  for (std::size_t k = 0; k < e.size(); ++k)
    if (static_cast<int>(k) != last && tryEntry(k)) return true;
  return false;
}

}  // namespace

void projectParticle(std::span<const MetWall> walls) {
  thread_local Scratch scratch;
  Projection(walls, scratch).append();
}

void projectWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                         const WallClearances* clearances, WallContacts& contacts) {
  sweepParticles(particles, candidates, clearances, contacts,
                 [&](std::size_t k, const Encounter& e, WallContacts& into) {
                   const MetWall met{e, &wall, &into};
                   if (!candidates.flat.empty() && candidates.flat[k] &&
                       appendFlat(met, candidates.reach, candidates.lastFacet[k]))
                     return;
                   const std::size_t first = into.size();
                   projectParticle({&met, 1});
                   if (candidates.reach > 0.0) appendBeyondTouch(e, wall, candidates.reach, couplingBlend, first, into);
                 });
}

void projectWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                         WallContacts& contacts) {
  projectWallContacts(particles, wall, candidates, nullptr, contacts);
}

}  // namespace dovetail::dem
