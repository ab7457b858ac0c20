#include "smooth_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "dovetail/core/error.hpp"

namespace dovetail::surface {

namespace {

constexpr double tolerance = 1e-13;  // of the radius
constexpr int largestIterations = 200;

/// A patch as a particle sees it.
struct View {
  Vec3 normal;      // unit, from the patch to the particle
  double distance;  // m; < 0 below a one-sided patch
};

/// None where a rim of a one-sided surface is seen from inside: there a face near by pushes.
std::optional<View> viewPatch(const SmoothSurface& surface, const PatchPoint& at, const Vec3& x, double radius) {
  const double distance = std::sqrt(at.squaredDistance);
  if (!(distance > 1e-12 * radius)) return View{at.normal(), 0.0};
  const Vec3 normal = (x - at.point) / distance;
  const double outward = surface.oneSided ? dot(normal, at.normal()) : 1.0;
  if (outward >= -1e-8) return View{normal, distance};
  if (outward > -1.0 + 1e-6) return std::nullopt;
  return View{-normal, -distance};
}

/// One particle among the patches near it.
class Approach {
public:
  /// @param start  where the search on each of the faces ended last
  Approach(const SmoothSurface& surface, int particle, const Vec3& x, double radius, std::span<const int> faces,
           std::span<std::array<double, 2>> start, SmoothScratch& scratch)
      : surface_(surface), particle_(particle), x_(x), radius_(radius), faces_(faces), start_(start), s_(scratch) {}

  void appendTo(std::vector<SmoothContact>& contacts) {
    findHits(radius_);
    if (s_.hits.empty()) return;
    s_.fractions.assign(1, {s_.hits[0].normal, s_.hits[0].overlap, s_.hits[0].overlap});
    if (s_.hits.size() > 1) {
      findHits(radius_ + s_.hits[0].overlap);
      shareOverlap();
    }
    appendFractions(contacts);
  }

private:
  /// Patches closer than reach, the nearest first.
  void findHits(double reach) {
    s_.hits.clear();
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      const PatchPoint at = closestPointOnPatch(surface_, faces_[k], x_, start_[k]);
      start_[k] = at.parameter;
      if (!(at.squaredDistance < reach * reach)) continue;
      // The search ran into a side that another face continues: the true foot lies there.
      if (at.edge >= 0 && surface_.across[faces_[k]][at.edge] >= 0 && leavesThrough(at, x_)) continue;
      requireFound(at, faces_[k]);
      const std::optional<View> seen = viewPatch(surface_, at, x_, radius_);
      if (!seen || seen->distance <= -radius_) continue;
      const double overlap = radius_ - seen->distance;
      s_.hits.push_back({faces_[k], at, seen->normal, overlap, overlap, {}});
    }
    std::stable_sort(s_.hits.begin(), s_.hits.end(),
                     [](const PatchHit& a, const PatchHit& b) { return a.overlap > b.overlap; });
  }

  void requireFound(const PatchPoint& at, int face) const {
    if (!at.found)
      throw NumericalError("its closest point on face " + std::to_string(face) + " was not found",
                           "particle " + std::to_string(particle_),
                           "take facets where the surface is bent more sharply than the particle");
  }

  /// A patch as seen from y: δ = R − n·(x − c). The foot may have moved on to a neighbour.
  void lookFrom(PatchHit& hit) const {
    const Vec3 y = x_ + hit.position;
    hit.at = closestPointOnPatch(surface_, hit.face, y, hit.at.parameter);
    for (int hop = 0; hop < 4; ++hop) {
      const int edge = hit.at.edge;
      if (edge < 0 || surface_.across[hit.face][edge] < 0 || !leavesThrough(hit.at, y)) break;
      hit.face = surface_.across[hit.face][edge];
      hit.at = closestPointOnPatch(surface_, hit.face, y, {0.5, 0.5});
    }
    const std::optional<View> seen = viewPatch(surface_, hit.at, y, radius_);
    if (seen) hit.normal = seen->normal;
    hit.overlap = seen ? radius_ - dot(hit.normal, x_ - hit.at.point) : 0.0;
  }

  /// yᵢ = x + Σ s′(nᵢ·nⱼ) λⱼ nⱼ; returns the largest change where a contact is active, m.
  double moveHits() {
    double largest = 0.0;
    for (std::size_t i = 0; i < s_.hits.size(); ++i) {
      PatchHit& hit = s_.hits[i];
      hit.fraction = s_.fractions[i].carried;
      Vec3 position;
      for (const dem::Fraction& other : s_.fractions)
        if (other.carried > 0.0)
          position += dem::couplingSlope(dot(s_.fractions[i].normal, other.normal)) * other.carried * other.normal;
      if (hit.fraction > 0.0) largest = std::max(largest, squaredNorm(position - hit.position));
      hit.position = position;
    }
    return std::sqrt(largest);
  }

  /// The potential of dem::projectWallContacts with patches in place of facets.
  void shareOverlap() {
    const Vec3 step = s_.hits[0].overlap * s_.hits[0].normal;
    for (PatchHit& hit : s_.hits) hit.position = dot(hit.normal, step) >= 0.0 ? step : Vec3{};
    double change = 0.0;
    for (int iteration = 0; iteration < largestIterations; ++iteration) {
      s_.fractions.clear();
      for (PatchHit& hit : s_.hits) {
        lookFrom(hit);
        s_.fractions.push_back({hit.normal, hit.overlap, 0.0});
      }
      s_.solver.solve(s_.fractions, tolerance * radius_);
      change = moveHits();
      if (change <= tolerance * radius_) return;
    }
    if (!(change <= 1e-6 * radius_))
      throw NumericalError("the fractions of patches in its overlap were not found",
                           "particle " + std::to_string(particle_), "take a smaller step, or stiffer contacts");
  }

  /// As dem::projectWallContacts: those that are coupled answer with one overlap.
  void appendFractions(std::vector<SmoothContact>& contacts) const {
    for (std::size_t i = 0; i < s_.fractions.size(); ++i) {
      const dem::Fraction& fraction = s_.fractions[i];
      if (!(fraction.carried > 0.0)) continue;
      double squared = 0.0;
      for (const dem::Fraction& other : s_.fractions)
        if (other.carried > 0.0)
          squared += (&other == &fraction ? 1.0 : dem::together(dot(fraction.normal, other.normal))) * other.carried *
                     std::max(other.overlap, other.carried);
      const double common = std::sqrt(squared);
      contacts.push_back({particle_, s_.hits[i].face, s_.hits[i].at.weight, fraction.normal, s_.hits[i].at.point,
                          fraction.carried, fraction.carried / common,
                          fraction.carried * std::max(fraction.overlap, fraction.carried) / squared});
    }
  }

  const SmoothSurface& surface_;
  int particle_;
  Vec3 x_;
  double radius_;
  std::span<const int> faces_;
  std::span<std::array<double, 2>> start_;
  SmoothScratch& s_;
};

}  // namespace

void appendSmoothContacts(const SmoothSurface& surface, int particle, const Vec3& x, double radius,
                          std::span<const int> faces, std::span<std::array<double, 2>> start, SmoothScratch& scratch,
                          std::vector<SmoothContact>& contacts) {
  Approach(surface, particle, x, radius, faces, start, scratch).appendTo(contacts);
}

}  // namespace dovetail::surface
