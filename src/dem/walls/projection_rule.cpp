// EdgeRule::projected: contacts with a wall as the gradient of one potential.
#include <algorithm>
#include <span>
#include <vector>

#include "dovetail/core/vector_code.hpp"
#include "dovetail/dem/walls/share_solver.hpp"
#include "facet_view.hpp"
#include "wall_sweep.hpp"

namespace dovetail::dem {

namespace {

constexpr double tolerance = 1e-13;     // of the radius
constexpr int largestIterations = 200;  // contraction is about overlap/radius per iteration

/// One facet in reach. Positions are relative to the particle's centre.
struct Candidate {
  std::size_t entry = 0;  // of the encounter
  FacetView view;         // from `position`
  Vec3 position;          // yᵢ − x
};

/// Whether an edge, or a facet at a vertex, has no neighbour there: the end of an open surface.
bool onRim(const TriangulatedWall& wall, int facet, geometry::Feature feature) {
  if (!wall.corner.empty()) return false;
  const auto open = [&](int f) {
    const auto& neighbours = wall.topology.neighbours[static_cast<std::size_t>(f)];
    return std::find(neighbours.begin(), neighbours.end(), -1) != neighbours.end();
  };
  if (!geometry::isVertex(feature)) return open(facet);
  const auto corner = static_cast<std::size_t>(feature) - static_cast<std::size_t>(geometry::Feature::vertex0);
  const auto around = wall.topology.facetsAtVertex(wall.facets[static_cast<std::size_t>(facet)][corner]);
  return std::any_of(around.begin(), around.end(), open);
}

/// A list that keeps its elements when it is emptied: those at its end are filled in place before they count.
class Candidates {
public:
  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  /// The element behind the last one.
  Candidate& next() {
    if (count_ == kept_.size()) kept_.emplace_back();
    return kept_[count_];
  }
  void keepNext() { ++count_; }
  Candidate& operator[](std::size_t i) { return kept_[i]; }
  const Candidate& operator[](std::size_t i) const { return kept_[i]; }
  std::span<Candidate> all() { return {kept_.data(), count_}; }

private:
  std::vector<Candidate> kept_;
  std::size_t count_ = 0;
};

/// Memory that is kept between particles and steps.
struct Scratch {
  Candidates candidates;
  Candidate sunk{};
  std::vector<Share> shares;
  ShareSolver solver;
};

/// One particle against one wall.
class Projection {
public:
  /// @param reach beyond touch, m
  Projection(const Encounter& encounter, const TriangulatedWall& wall, double reach, Scratch& scratch)
      : encounter_(encounter), radius_(encounter.radius), beyond_(reach), wall_(wall), scratch_(scratch) {}

  void appendTo(WallContacts& contacts) {
    const std::size_t first = contacts.size();
    appendTouching(contacts);
    if (beyond_ > 0.0) appendBeyondTouch(encounter_, wall_, beyond_, couplingBlend, first, contacts);
  }

  void appendTouching(WallContacts& contacts) {
    if (!collect(radius_)) return;
    if (nearestSuffices()) return appendNearest(contacts);
    collect(radius_ + nearestOverlap());
    guess();
    for (int i = 0; i < largestIterations; ++i) {
      linearise();
      scratch_.solver.solve(scratch_.shares, tolerance * radius_);
      if (move() <= tolerance * radius_) break;
    }
    appendShares(contacts);
  }

  /// The contact with facets that all lie in one plane, if the foot is on one of them: then it is the nearest, and the
  /// others add nothing. False if it is on none.
  /// @param last where to look first, and where the foot was found
  bool appendFlat(int& last, WallContacts& contacts) const {
    const auto tryEntry = [&](std::size_t k) {
      FacetView seen;
      view(k, {}, seen);
      if (!seen.face()) return false;
      last = static_cast<int>(k);
      if (seen.distance < radius_ + beyond_)
        addContact(contacts, encounter_, k, seen.weight, seen.normal, radius_ - seen.distance, 1.0, 1.0);
      return true;
    };
    if (last >= 0 && tryEntry(static_cast<std::size_t>(last))) return true;
    for (std::size_t k = 0; k < encounter_.size(); ++k)
      if (static_cast<int>(k) != last && tryEntry(k)) return true;
    return false;
  }

private:
  /// However far away it is.
  void view(std::size_t entry, const Vec3& position, FacetView& seen) const {
    viewFacet(position, FacetCorners(wall_, encounter_.facet[entry], encounter_.seenFrom(entry)), radius_,
              FacetView::unseen, wall_.oneSided, seen);
  }
  const Candidate& nearest() const { return scratch_.candidates[nearest_]; }
  double nearestOverlap() const { return radius_ - nearest().view.distance; }

  /// Facets closer than reach; false if there are none.
  bool collect(double reach) {
    withVectors([&] { look(reach); });
    return !scratch_.candidates.empty();
  }

  void look(double reach) {
    Candidates& candidates = scratch_.candidates;
    candidates.clear();
    nearest_ = 0;
    double least = reach;
    bool anySunk = false;
    Candidate* next = &candidates.next();
    for (std::size_t k = 0; k < encounter_.size(); ++k) {
      if (!encounter_.mayBeWithin(k, reach - radius_)) continue;
      const FacetCorners corners(wall_, encounter_.facet[k], encounter_.seenFrom(k));
      if (corners.beyond(reach)) continue;
      viewFacet({}, corners, radius_, reach, wall_.oneSided, next->view);
      next->entry = k;
      const FacetView& seen = next->view;
      if (seen.sunk > 0.0 && (!anySunk || seen.sunk < scratch_.sunk.view.sunk)) {
        anySunk = true;
        scratch_.sunk = *next;
      }
      if (!(seen.distance < reach)) continue;
      if (seen.distance < least) {
        least = seen.distance;
        nearest_ = candidates.size();
      }
      candidates.keepNext();
      next = &candidates.next();
    }
    if (candidates.empty() && anySunk) bringInSunk();
  }

  /// Inside the skin, where an edge (of a valley) is nearer than any face.
  void bringInSunk() {
    const Candidate& sunk = scratch_.sunk;
    if (onRim(wall_, encounter_.facet[sunk.entry], sunk.view.feature)) return;
    Candidate& only = scratch_.candidates.next();
    only = sunk;
    only.view.distance = -sunk.view.sunk;
    scratch_.candidates.keepNext();
  }

  /// Whether stepping out of the nearest facet clears all others. Distance to a facet is a convex function, so that
  /// being clear of its tangent plane suffices; if that fails, look again from there.
  bool nearestSuffices() const {
    const Vec3& normal = nearest().view.normal;
    const double depth = nearestOverlap(), slack = tolerance * radius_;
    for (std::size_t i = 0; i < scratch_.candidates.size(); ++i) {
      const Candidate& other = scratch_.candidates[i];
      const double g = dot(other.view.normal, normal);
      if (i == nearest_ || coupling(g) * depth >= radius_ - other.view.distance - slack) continue;
      if (g <= 0.0) return false;
      FacetView after;
      view(other.entry, depth * normal, after);
      if (after.distance == FacetView::unseen) continue;
      if (after.distance < radius_ - slack || dot(after.normal, normal) < couplingBlend) return false;
    }
    return true;
  }

  void appendNearest(WallContacts& contacts) const {
    addContact(contacts, encounter_, nearest().entry, nearest().view.weight, nearest().view.normal, nearestOverlap(),
               1.0, 1.0);
  }

  /// First guess of the yᵢ: clear of the nearest facet, for those that do not face it.
  void guess() {
    scratch_.shares.assign(scratch_.candidates.size(), Share{});
    const Vec3 step = nearestOverlap() * nearest().view.normal;
    for (Candidate& c : scratch_.candidates.all()) c.position = dot(c.view.normal, step) >= 0.0 ? step : Vec3{};
  }

  /// The facets as seen from the yᵢ: δᵢ = R − nᵢ·(x − cᵢ).
  void linearise() {
    for (std::size_t i = 0; i < scratch_.candidates.size(); ++i) {
      Candidate& c = scratch_.candidates[i];
      view(c.entry, c.position, c.view);
      scratch_.shares[i].normal = c.view.normal;
      scratch_.shares[i].overlap =
          c.view.distance == FacetView::unseen ? 0.0 : radius_ + dot(c.view.normal, c.view.foot);
    }
  }

  /// yᵢ = x + Σ s′(nᵢ·nⱼ) λⱼ nⱼ; returns the largest change where a contact is active, m.
  double move() {
    double largest = 0.0;
    for (std::size_t i = 0; i < scratch_.candidates.size(); ++i) {
      const Vec3& normal = scratch_.shares[i].normal;
      Vec3 position;
      for (const Share& other : scratch_.shares)
        if (other.carried > 0.0) position += couplingSlope(dot(normal, other.normal)) * other.carried * other.normal;
      if (scratch_.shares[i].carried > 0.0)
        largest = std::max(largest, squaredNorm(position - scratch_.candidates[i].position));
      scratch_.candidates[i].position = position;
    }
    return std::sqrt(largest);
  }

  /// Facets that are coupled answer with one overlap s, s² = Σ λδ: forces F(s) λ/s are the gradient of E(s), whatever
  /// the law. Those that are not answer each with its own, between the two s changes smoothly.
  void appendShares(WallContacts& contacts) const {
    const std::vector<Share>& shares = scratch_.shares;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const Share& share = shares[i];
      if (!(share.carried > 0.0)) continue;
      double squared = 0.0;
      for (const Share& other : shares)
        if (other.carried > 0.0)
          squared += (&other == &share ? 1.0 : together(dot(share.normal, other.normal))) * other.carried *
                     std::max(other.overlap, other.carried);
      const double common = std::sqrt(squared);
      addContact(contacts, encounter_, scratch_.candidates[i].entry, scratch_.candidates[i].view.weight, share.normal,
                 share.carried, share.carried / common,
                 share.carried * std::max(share.overlap, share.carried) / squared);
    }
  }

  const Encounter& encounter_;
  double radius_, beyond_;
  const TriangulatedWall& wall_;
  Scratch& scratch_;
  std::size_t nearest_ = 0;
};

}  // namespace

void projectWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                         const WallClearances* clearances, WallContacts& contacts) {
  sweepParticles(
      particles, candidates, clearances, contacts, [&](std::size_t k, const Encounter& e, WallContacts& into) {
        thread_local Scratch scratch;
        Projection projection(e, wall, candidates.reach, scratch);
        if (!candidates.flat.empty() && candidates.flat[k] && projection.appendFlat(candidates.lastFacet[k], into))
          return;
        projection.appendTo(into);
      });
}

void projectWallContacts(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
                         WallContacts& contacts) {
  projectWallContacts(particles, wall, candidates, nullptr, contacts);
}

}  // namespace dovetail::dem
