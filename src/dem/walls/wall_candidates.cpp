#include "dovetail/dem/walls/wall_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "dovetail/core/finite.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "wall_broad_phase.hpp"

namespace dovetail::dem {

namespace {

using Found = std::vector<std::array<int, 2>>;  // entry of NearWall, facet

const Vec3& corner(const TriangulatedWall& wall, int facet, std::size_t k) {
  return wall.x[static_cast<std::size_t>(wall.facets[static_cast<std::size_t>(facet)][k])];
}

/// By facet.
std::vector<Found> findPairs(const NearWall& near, const TriangulatedWall& wall, double margin) {
  constexpr std::size_t chunkSize = 128;
  geometry::HierarchicalGrid grid;
  grid.build(near.x, near.radius, 2.0 * margin);
  std::vector<Found> parts((wall.facets.size() + chunkSize - 1) / chunkSize);
  parallelFor(wall.facets.size(), chunkSize, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const auto facet = static_cast<int>(t);
      const Vec3 &a = corner(wall, facet, 0), &b = corner(wall, facet, 1), &c = corner(wall, facet, 2);
      grid.query(geometry::boundingBox(a, b, c), [&](int entry) {
        const Vec3& x = near.x[static_cast<std::size_t>(entry)];
        const double reach = near.radius[static_cast<std::size_t>(entry)] + margin;
        if (squaredNorm(x - geometry::closestPointOnTriangle(x, a, b, c).point) <= reach * reach)
          parts[begin / chunkSize].push_back({entry, facet});
      });
    }
  });
  return parts;
}

/// By entry, facets ascending: a counting sort.
Found sortByEntry(const std::vector<Found>& parts, std::size_t entries) {
  std::vector<std::size_t> next(entries + 1, 0);
  for (const Found& part : parts)
    for (const auto& pair : part) ++next[static_cast<std::size_t>(pair[0]) + 1];
  for (std::size_t e = 0; e < entries; ++e) next[e + 1] += next[e];
  Found sorted(next[entries]);
  for (const Found& part : parts)
    for (const auto& pair : part) sorted[next[static_cast<std::size_t>(pair[0])]++] = pair;
  return sorted;
}

void makeLists(const Particles& particles, const NearWall& near, const Found& found, WallCandidates& candidates) {
  candidates.particle.clear();
  candidates.offsets.clear();
  candidates.facet.clear();
  candidates.image.clear();
  candidates.position.clear();
  for (const auto& [entry, facet] : found) {
    const auto e = static_cast<std::size_t>(entry);
    if (candidates.particle.empty() || candidates.particle.back() != near.particle[e]) {
      candidates.particle.push_back(near.particle[e]);
      candidates.offsets.push_back(static_cast<int>(candidates.facet.size()));
      if (!near.image.empty()) candidates.position.push_back(particles.x[static_cast<std::size_t>(near.particle[e])]);
    }
    candidates.facet.push_back(facet);
    if (!near.image.empty()) candidates.image.push_back(near.image[e]);
  }
  candidates.offsets.push_back(static_cast<int>(candidates.facet.size()));
}

/// Whether facets first … last − 1 of the list lie in one plane, to round-off, and push the same way.
bool inOnePlane(const TriangulatedWall& wall, const WallCandidates& candidates, std::size_t first, std::size_t last) {
  const auto areaNormal = [&](int facet) {
    return geometry::triangleAreaNormal(corner(wall, facet, 0), corner(wall, facet, 1), corner(wall, facet, 2));
  };
  const auto shift = [&](std::size_t k) {
    return candidates.image.empty() ? Vec3{} : shiftOf(candidates.image[k], candidates.period);
  };
  const int start = candidates.facet[first];
  const Vec3 area = areaNormal(start);
  if (!(squaredNorm(area) > 0.0)) return false;
  const Vec3 normal = area / norm(area), origin = corner(wall, start, 0) - shift(first);
  const double size = std::sqrt(norm(area));
  for (std::size_t k = first; k < last; ++k) {
    const int facet = candidates.facet[k];
    const Vec3 other = areaNormal(facet);
    if (norm(cross(other, normal)) > 1e-12 * norm(other) || (wall.oneSided && dot(other, normal) <= 0.0)) return false;
    for (std::size_t v = 0; v < 3; ++v)
      if (std::abs(dot(corner(wall, facet, v) - shift(k) - origin, normal)) > 1e-12 * size) return false;
  }
  return true;
}

void markFlat(const TriangulatedWall& wall, WallCandidates& candidates) {
  candidates.flat.clear();
  candidates.lastFacet.clear();
  if (!wall.rigid) return;
  candidates.flat.resize(candidates.particle.size());
  candidates.lastFacet.assign(candidates.particle.size(), -1);
  parallelFor(candidates.particle.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      candidates.flat[k] = inOnePlane(wall, candidates, static_cast<std::size_t>(candidates.offsets[k]),
                                      static_cast<std::size_t>(candidates.offsets[k + 1]));
  });
}

double largestTravel(const std::vector<Vec3>& now, const std::vector<Vec3>& then) {
  return std::sqrt(parallelSum(now.size(), 4096, [&](std::size_t begin, std::size_t end) {
                     Largest squared;
                     for (std::size_t i = begin; i < end; ++i) squared.meet(squaredNorm(now[i] - then[i]));
                     return squared;
                   }).value);
}

bool fits(const Particles& particles, const TriangulatedWall& wall, const WallCandidates& candidates,
          const Vec3& period) {
  return candidates.builds > 0 && particles.revision == candidates.particleRevision &&
         wall.x.size() == candidates.vertexAtBuild.size() && wall.facets.size() == candidates.facetsAtBuild &&
         candidates.period == period && candidates.reachAtBuild == candidates.reach;
}

}  // namespace

double defaultSkin(const Particles& particles) {
  if (particles.size() == 0) return 0.0;
  const double sum = parallelSum(particles.size(), 4096, [&](std::size_t begin, std::size_t end) {
    double part = 0.0;
    for (std::size_t i = begin; i < end; ++i) part += particles.radius[i];
    return part;
  });
  return 0.3 * sum / static_cast<double>(particles.size());
}

namespace {

void search(const Particles& particles, const TriangulatedWall& wall, double skin, WallCandidates& candidates,
            const Vec3& period) {
  candidates.margin = requireNonNegative(skin, "skin of the wall candidates");
  requireFinite(wall.x, "wall vertex", "position", "contact search with a wall");
  candidates.period = period;
  const double margin = skin + candidates.reach;
  const NearWall near = nearWall(particles, wall, margin, period);
  makeLists(particles, near, sortByEntry(findPairs(near, wall, margin), near.particle.size()), candidates);
  candidates.reachAtBuild = candidates.reach;
  markFlat(wall, candidates);
  candidates.smallestRadius = near.smallestRadius;
  candidates.particleRevision = particles.revision;
  candidates.vertexAtBuild = wall.x;
  candidates.facetsAtBuild = wall.facets.size();
  candidates.particleTravel = {};
  candidates.wallTravel = 0.0;
  ++candidates.builds;
}

}  // namespace

void findWallCandidates(const Particles& particles, const TriangulatedWall& wall, double skin,
                        WallCandidates& candidates, const geometry::Periodicity& periodicity) {
  search(particles, wall, skin, candidates, periodsOf(periodicity));
  candidates.skin = skin;
}

// Comparisons are written so that a NaN asks for a search, which then names the culprit.
bool updateWallCandidates(const Particles& particles, const TriangulatedWall& wall, WallCandidates& candidates,
                          const Moves& moves, const geometry::Periodicity& periodicity) {
  const Vec3 period = periodsOf(periodicity);
  bool rebuild = !fits(particles, wall, candidates, period) || candidates.margin == 0.0;
  if (!rebuild) {
    candidates.particleTravel.add(moves);
    candidates.wallTravel += moves.wall;
    const double left = candidates.margin - candidates.particleTravel.bound;
    if (!(candidates.wallTravel <= left) && left >= 0.0)
      candidates.wallTravel = largestTravel(wall.x, candidates.vertexAtBuild);
    rebuild = !(candidates.wallTravel <= left);
  }
  if (!rebuild) return false;
  search(particles, wall, candidates.skin ? *candidates.skin : defaultSkin(particles), candidates, period);
  candidates.particleTravel.reset(moves);
  return true;
}

}  // namespace dovetail::dem
