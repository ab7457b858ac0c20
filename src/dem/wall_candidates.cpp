#include "dovetail/dem/wall_candidates.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/finite.hpp"
#include "dovetail/geometry/triangle.hpp"

namespace dovetail::dem {

namespace {

constexpr std::int64_t longestScanInterval = 64;

/// Largest displacement, m; NaN positions give NaN or are passed over, see `withinSkin`.
double largestTravel(const std::vector<Vec3>& now, const std::vector<Vec3>& then) {
  double squared = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double d2 = squaredNorm(now[i] - then[i]);
    if (!(d2 <= squared)) squared = d2;
    if (std::isnan(squared)) break;
  }
  return std::sqrt(squared);
}

void collectPairs(const Particles& particles, const TriangulatedWall& wall, WallCandidates& candidates) {
  auto& found = candidates.pairScratch;
  found.clear();
  for (std::size_t t = 0; t < wall.facets.size(); ++t) {
    const auto& vertex = wall.facets[t];
    const Vec3 &a = wall.x[static_cast<std::size_t>(vertex[0])], &b = wall.x[static_cast<std::size_t>(vertex[1])],
               &c = wall.x[static_cast<std::size_t>(vertex[2])];
    candidates.grid.query(geometry::boundingBox(a, b, c), [&](int i) {
      const Vec3& x = particles.x[static_cast<std::size_t>(i)];
      const double reach = particles.radius[static_cast<std::size_t>(i)] + candidates.skin;
      if (squaredNorm(x - geometry::closestPointOnTriangle(x, a, b, c).point) <= reach * reach)
        found.push_back({i, static_cast<int>(t)});
    });
  }
  std::sort(found.begin(), found.end());
}

void makeLists(WallCandidates& candidates) {
  candidates.particle.clear();
  candidates.offsets.clear();
  candidates.facet.clear();
  for (const auto& [particle, facet] : candidates.pairScratch) {
    if (candidates.particle.empty() || candidates.particle.back() != particle) {
      candidates.particle.push_back(particle);
      candidates.offsets.push_back(static_cast<int>(candidates.facet.size()));
    }
    candidates.facet.push_back(facet);
  }
  candidates.offsets.push_back(static_cast<int>(candidates.facet.size()));
}

/// Scans the vertices when it is time, and plans the next scan. Returns the travel to reckon with.
double scannedTravel(const TriangulatedWall& wall, double particleTravel, WallCandidates& candidates) {
  ++candidates.updatesSinceBuild;
  if (candidates.updatesSinceBuild < candidates.nextScan) return candidates.vertexTravel;
  const double travel = largestTravel(wall.x, candidates.vertexAtBuild);
  candidates.vertexTravel = travel;
  if (travel + particleTravel > candidates.skin) ++candidates.lateBuilds;
  const auto done = candidates.updatesSinceBuild;
  const double perUpdate = travel / static_cast<double>(done);
  const double affordable = (0.5 * candidates.skin - travel) / (4.0 * perUpdate);
  std::int64_t pause = std::min(done, longestScanInterval);
  if (!(affordable >= static_cast<double>(pause))) pause = affordable > 1.0 ? static_cast<std::int64_t>(affordable) : 1;
  candidates.nextScan = done + pause;
  return travel;
}

}  // namespace

void findWallCandidates(const Particles& particles, const TriangulatedWall& wall, double skin,
                        WallCandidates& candidates) {
  candidates.skin = requireNonNegative(skin, "skin of the wall candidates");
  requireFinite(particles.x, "particle", "position", "contact search with a wall");
  requireFinite(wall.x, "wall vertex", "position", "contact search with a wall");
  candidates.grid.build(particles.x, particles.radius, 2.0 * skin);
  collectPairs(particles, wall, candidates);
  makeLists(candidates);
  candidates.particleAtBuild = particles.x;
  candidates.vertexAtBuild = wall.x;
  candidates.facetsAtBuild = wall.facets.size();
  candidates.vertexTravel = 0.0;
  candidates.updatesSinceBuild = 0;
  candidates.nextScan = 1;
  ++candidates.builds;
}

bool updateWallCandidates(const Particles& particles, const TriangulatedWall& wall, WallCandidates& candidates,
                          std::optional<double> wallTravel) {
  bool rebuild = candidates.builds == 0 || particles.size() != candidates.particleAtBuild.size() ||
                 wall.x.size() != candidates.vertexAtBuild.size() || wall.facets.size() != candidates.facetsAtBuild;
  if (!rebuild) {
    const double particleTravel = largestTravel(particles.x, candidates.particleAtBuild);
    // Written so that a NaN asks for a rebuild, which then names the culprit.
    if (wallTravel) {
      rebuild = !(particleTravel + *wallTravel <= candidates.skin);
    } else {
      const double travel = scannedTravel(wall, particleTravel, candidates);
      rebuild = !(std::max(particleTravel, travel) <= 0.5 * candidates.skin) || std::isnan(travel);
    }
  }
  if (rebuild) findWallCandidates(particles, wall, candidates.skin, candidates);
  return rebuild;
}

}  // namespace dovetail::dem
