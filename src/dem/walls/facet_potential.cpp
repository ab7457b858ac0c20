#include "facet_potential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace dovetail::dem {

namespace {

constexpr double tolerance = 1e-13;      // of the radius
constexpr double touching = 1e-12;       // of the radius: less is left of a facet that is cleared
constexpr double seam = 2e-3;            // of the radius: facets with gaps up to it hang together
constexpr int largestIterations = 2000;  // contraction is about overlap/radius per iteration
constexpr int largestStalls = 20;
constexpr int largestRounds = 12;
constexpr int looks = 30;
// Where feet slide to and fro, two facets hold the particle off: after so many, none slides to one of the set, then
// none.
constexpr int freeSlides = 6, largestSlides = 20;
constexpr double leastDamping = 1e-3;
constexpr double roundOff = 1e-15;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Faces before edges before vertices.
int rank(geometry::Feature feature) {
  return feature == geometry::Feature::face ? 0 : geometry::isEdge(feature) ? 1 : 2;
}

}  // namespace

/// Whether a facet is one of the set.
bool FacetPotential::holds(const MetFacet& facet) const {
  const auto& set = scratch_.set.facets;
  return std::any_of(set.begin(), set.end(), [&](const MetFacet& f) { return f.is(facet); });
}

/// A facet from its place. Where its foot is not the nearest of the surface around, the facet that has it is looked at
/// instead: edges and vertices within a face, or at the bottom of a valley, hold nobody off.
void FacetPotential::see(ActiveFacet& facet, Slide slide) const {
  if (facet.plane) return;
  const auto look = [&](const MetFacet& at, FacetView& view) {
    viewFacet(facet.position, at.corners(), radius_, FacetView::unseen, false, view);
  };
  look(facet, facet.view);
  for (bool slides = slide != Slide::no; slides && !facet.view.face();) {
    slides = false;
    const double near = facet.view.distance + norm(facet.position) + 1e-6 * radius_;
    for (const MetFacet& other : near_) {
      if (other.view.farness() > near) continue;
      FacetView view;
      look(other, view);
      const double nearer = facet.view.distance - view.distance, same = 1e-13 * radius_;
      if (other.is(facet) || !(nearer > same || (nearer >= -same && rank(view.feature) < rank(facet.view.feature))))
        continue;
      const FacetCorners t = other.corners();
      const Vec3 gap = geometry::closestPointOnTriangle(facet.view.foot, t.a, t.b, t.c).point - facet.view.foot;
      if (squaredNorm(gap) > seam * seam * radius_ * radius_) continue;
      if (slide == Slide::offSet && holds(other)) return;
      static_cast<MetFacet&>(facet) = {other.met, other.entry, view};
      slides = true;
    }
  }
}

/// The overlaps δᵢ = R − nᵢ·(x − cᵢ) as they are seen now, and who carries what.
void FacetPotential::fraction() {
  ActiveSet& set = scratch_.set;
  set.fractions.assign(set.facets.size(), Fraction{});
  for (std::size_t i = 0; i < set.facets.size(); ++i) {
    const FacetView& view = set.facets[i].view;
    set.fractions[i].normal = view.normal;
    set.fractions[i].overlap = radius_ + dot(view.normal, view.foot);
  }
  scratch_.solver.solve(set.fractions, tolerance * radius_);
  set.energy = 0.0;
  for (const Fraction& s : set.fractions) set.energy += 0.5 * s.carried * s.overlap;
}

/// Σ s′(n·nⱼ) λⱼ nⱼ: from where a facet is seen along n.
Vec3 FacetPotential::pushed(const Vec3& normal) const {
  Vec3 position;
  for (const Fraction& s : scratch_.set.fractions)
    if (s.carried > 0.0) position += couplingSlope(dot(normal, s.normal)) * s.carried * s.normal;
  return position;
}

/// Overlap with a facet along a normal, less what the fractions spare it, m. @param support largest n·vertex
double FacetPotential::remaining(const Vec3& normal, double support) const {
  double depth = radius_ + support;
  for (const Fraction& s : scratch_.set.fractions)
    if (s.carried > 0.0) depth -= coupling(dot(normal, s.normal)) * s.carried;
  return depth;
}

/// Every facet is seen from its yᵢ: steps that would raise the energy are cut, but where a foot slides to the next
/// facet. False if it came to no end.
bool FacetPotential::converge() {
  ActiveSet &set = scratch_.set, &kept = scratch_.kept;
  double damping = 1.0, last = infinite, lastOff = infinite;
  int slides = 0, stalls = 0;
  for (int i = 0; i < largestIterations; ++i) {
    if (set.energy > last && damping > leastDamping) {
      damping *= 0.5;
      set = kept;
    } else {
      kept = set;
      last = set.energy + 1e-14 * radius_ * std::sqrt(set.energy);
    }
    const double off = stepOn(damping);
    if (off <= tolerance * radius_) return true;
    stalls = damping <= leastDamping ? stalls + 1 : 0;
    if (stalls > largestStalls) return false;
    // Where round-off hides what a step does to the energy.
    if (off > lastOff && off < 1e-4 * radius_) damping = std::max(0.5 * damping, leastDamping);
    lastOff = off;
    for (ActiveFacet& facet : set.facets) {
      const MetFacet before = facet;
      see(facet, slides < freeSlides ? Slide::yes : slides < largestSlides ? Slide::offSet : Slide::no);
      if (!facet.is(before)) {
        ++slides;
        damping = 1.0;
        last = infinite;
      }
    }
    fraction();
  }
  return false;
}

/// Moves the places from which facets are seen towards the yᵢ; returns how far they are off where a facet is active, m.
double FacetPotential::stepOn(double damping) {
  ActiveSet& set = scratch_.set;
  double largest = 0.0;
  for (std::size_t k = 0; k < set.facets.size(); ++k) {
    if (set.facets[k].plane) continue;
    const Vec3 step = pushed(set.fractions[k].normal) - set.facets[k].position;
    if (set.fractions[k].carried > 0.0) largest = std::max(largest, norm(step));
    set.facets[k].position += damping * step;
  }
  return largest;
}

/// Facets that carry nothing.
void FacetPotential::dropIdle() {
  ActiveSet& set = scratch_.set;
  for (std::size_t i = set.facets.size(); i-- > 0;) {
    if (set.fractions[i].carried > 0.0) continue;
    set.facets.erase(set.facets.begin() + static_cast<std::ptrdiff_t>(i));
    set.fractions.erase(set.fractions.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// From a place on, where a facet is seen and what is left of it there. False if nothing is.
bool FacetPotential::follow(const MetFacet& facet, const Vec3& position, Remainder& found) const {
  ActiveFacet seen{facet, position};
  double damping = 1.0;
  bool itself = true;
  found.depth = infinite;
  for (int i = 0; i < looks && damping > leastDamping; ++i) {
    see(seen);
    if (!sunkIn_ && dot(seen.view.normal, seen.view.foot) > 0.0) return true;  // from the far side
    const double depth = remaining(seen.view.normal, dot(seen.view.normal, seen.view.foot));
    itself = itself && seen.is(facet);
    if (itself && depth <= touching * radius_) return false;
    if (depth > found.depth + roundOff * radius_)
      damping *= 0.5;
    else
      found = {depth, seen};
    const Vec3 step = pushed(found.facet.view.normal) - found.facet.position;
    if (norm(step) <= 1e-9 * radius_) break;
    seen = found.facet;
    seen.position += damping * step;
  }
  if (found.depth <= touching * radius_) found.depth = infinite;
  return true;
}

/// Whether nothing is left along the normal of one of those that carry.
bool FacetPotential::clearedAlongFractions(const MetFacet& facet) const {
  const FacetCorners t = facet.corners();
  return std::any_of(scratch_.set.fractions.begin(), scratch_.set.fractions.end(), [&](const Fraction& s) {
    const double support = std::max({dot(s.normal, t.a), dot(s.normal, t.b), dot(s.normal, t.c)});
    return s.carried > 0.0 && remaining(s.normal, support) <= touching * radius_;
  });
}

/// @param other where there are two, take the one that does not leave least. False if nothing is left along some
bool FacetPotential::leastRemainder(const MetFacet& facet, bool other, Remainder& least) {
  if (clearedAlongFractions(facet)) return false;
  Remainder fromCentre{infinite, {}}, fromBeyond{infinite, {}};
  const auto anythingLeft = [&](const FacetView& seen) {
    return remaining(seen.normal, dot(seen.normal, seen.foot)) > touching * radius_;
  };
  Vec3 beyond;
  for (const Fraction& s : scratch_.set.fractions) beyond += s.carried * s.normal;
  FacetView seen;
  viewFacet(beyond, facet.corners(), radius_, FacetView::unseen, sunkIn_ && facet.met->wall->oneSided, seen);
  if (sunkIn_ && (seen.distance == FacetView::unseen || seen.distance < 0.0)) return false;
  if (!anythingLeft(seen) && (sunkIn_ || !anythingLeft(facet.view))) return false;
  if (!sunkIn_ && !follow(facet, {}, fromCentre)) return false;
  if (!follow(facet, beyond, fromBeyond)) return false;
  const bool second = fromBeyond.depth < fromCentre.depth;
  const bool two = fromCentre.depth < infinite && fromBeyond.depth < infinite &&
                   dot(fromCentre.facet.view.normal, fromBeyond.facet.view.normal) < 1.0 - 1e-6;
  ambiguous_ = ambiguous_ || two;
  least = second != (two && other) ? fromBeyond : fromCentre;
  return least.depth < infinite;
}

/// The facet of which most is left. False if none is.
bool FacetPotential::takeIn(bool other) {
  ActiveSet& set = scratch_.set;
  Remainder most, found;
  const auto among = [](const auto& list, const MetFacet& facet) {
    return std::any_of(list.begin(), list.end(), [&](const MetFacet& f) { return f.is(facet); });
  };
  for (const MetFacet& facet : near_) {
    if (!sunkIn_ && !(facet.view.distance < radius_)) break;
    if (among(set.facets, facet) || among(scratch_.refused, facet)) continue;
    if (leastRemainder(facet, other, found) && found.depth > most.depth) most = found;
  }
  if (!(most.depth > 0.0)) return false;
  set.facets.push_back(most.facet);
  fraction();
  if (!(set.fractions.back().carried > 0.0)) scratch_.refused.push_back(most.facet);
  return true;
}

/// All that holds the particle off together with a first facet, unless that is no lower than the best.
void FacetPotential::descend(const ActiveFacet& first, bool other) {
  ActiveSet &set = scratch_.set, &best = scratch_.best;
  set.facets.assign(1, first);
  set.complete = false;
  scratch_.refused.clear();
  fraction();
  bool converged = true;
  for (int round = 0; round < largestRounds; ++round) {
    if (!takeIn(other)) {
      set.complete = converged;
      return;
    }
    converged = converge();
    if (best.complete && set.energy >= best.energy) return;
    dropIdle();
  }
}

void FacetPotential::lower(const ActiveFacet& first, double atLeast) {
  ActiveSet &set = scratch_.set, &best = scratch_.best;
  for (const bool other : {false, true}) {
    ambiguous_ = false;
    descend(first, other);
    const bool better = set.complete == best.complete ? set.energy < best.energy : set.complete;
    if (set.energy >= atLeast && (best.facets.empty() || better)) std::swap(set, best);
    if (!ambiguous_) return;
  }
}

/// Facets that are coupled answer with one overlap s, s² = Σ λδ: forces F(s) λ/s are the gradient of E(s), whatever the
/// law. Those that are not answer each with its own, between the two s changes smoothly.
void FacetPotential::append() const {
  const std::vector<Fraction>& fractions = scratch_.best.fractions;
  const std::vector<ActiveFacet>& facets = scratch_.best.facets;
  std::array<std::size_t, EdgeContactSolver::capacity> order{};
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(fractions.size());
  std::iota(order.begin(), end, std::size_t{0});
  std::sort(order.begin(), end, [&](std::size_t a, std::size_t b) { return facets[a].entry < facets[b].entry; });
  for (auto i = order.begin(); i != end; ++i) {
    const Fraction& fraction = fractions[*i];
    double squared = 0.0;
    for (const Fraction& other : fractions)
      squared += (&other == &fraction ? 1.0 : together(dot(fraction.normal, other.normal))) * other.carried *
                 std::max(other.overlap, other.carried);
    const ActiveFacet& facet = facets[*i];
    facet.met->add(facet.entry, facet.view, fraction.carried, fraction.carried / std::sqrt(squared),
                   fraction.carried * std::max(fraction.overlap, fraction.carried) / squared);
  }
}

}  // namespace dovetail::dem
