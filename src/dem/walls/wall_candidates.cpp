#include "dovetail/dem/walls/wall_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <span>

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

/// Whether the facets lie in one plane, to round-off, and push the same way.
bool inOnePlane(const TriangulatedWall& wall, std::span<const int> facets) {
  const auto corner = [&](int facet, std::size_t k) -> const Vec3& {
    return wall.x[static_cast<std::size_t>(wall.facets[static_cast<std::size_t>(facet)][k])];
  };
  const auto areaNormal = [&](int facet) {
    return geometry::triangleAreaNormal(corner(facet, 0), corner(facet, 1), corner(facet, 2));
  };
  const Vec3 first = areaNormal(facets[0]);
  if (!(squaredNorm(first) > 0.0)) return false;
  const Vec3 normal = first / norm(first);
  const double size = std::sqrt(norm(first));
  for (const int facet : facets) {
    const Vec3 other = areaNormal(facet);
    if (norm(cross(other, normal)) > 1e-12 * norm(other) || (wall.oneSided && dot(other, normal) <= 0.0)) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(dot(corner(facet, k) - corner(facets[0], 0), normal)) > 1e-12 * size) return false;
  }
  return true;
}

void markFlat(const TriangulatedWall& wall, WallCandidates& candidates) {
  candidates.flat.clear();
  candidates.lastFacet.clear();
  if (!wall.rigid) return;
  const std::span<const int> facets(candidates.facet);
  for (std::size_t k = 0; k < candidates.particle.size(); ++k) {
    const auto first = static_cast<std::size_t>(candidates.offsets[k]);
    const auto last = static_cast<std::size_t>(candidates.offsets[k + 1]);
    candidates.flat.push_back(inOnePlane(wall, facets.subspan(first, last - first)) ? 1 : 0);
  }
  candidates.lastFacet.assign(candidates.particle.size(), -1);
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
  markFlat(wall, candidates);
  candidates.particleTravel = 0.0;
  candidates.particleAtBuild = particles.x;
  candidates.vertexAtBuild = wall.x;
  candidates.facetsAtBuild = wall.facets.size();
  candidates.vertexTravel = 0.0;
  candidates.updatesSinceBuild = 0;
  candidates.nextScan = 1;
  ++candidates.builds;
}

bool updateWallCandidates(const Particles& particles, const TriangulatedWall& wall, WallCandidates& candidates,
                          std::optional<double> wallTravel, std::optional<double> particleStep) {
  bool rebuild = candidates.builds == 0 || particles.size() != candidates.particleAtBuild.size() ||
                 wall.x.size() != candidates.vertexAtBuild.size() || wall.facets.size() != candidates.facetsAtBuild;
  if (!rebuild) {
    if (particleStep) {
      candidates.particleTravel += *particleStep;
      if (wallTravel && candidates.particleTravel + *wallTravel <= candidates.skin) return false;
    }
    const double particleTravel = largestTravel(particles.x, candidates.particleAtBuild);
    candidates.particleTravel = particleTravel;
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
