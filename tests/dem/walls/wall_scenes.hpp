// Walls and single-particle scenes that several tests share.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "dovetail/dem/particles/particles.hpp"
#include "dovetail/dem/walls/wall_candidates.hpp"
#include "dovetail/dem/walls/wall_contacts.hpp"
#include "sweeps.hpp"

namespace dovetail::dem {

/// n × m squares of edge h from the origin in the plane z = 0, each cut into four triangles that meet in its centre.
inline TriangulatedWall squares(int n, int m, double h, bool oneSided = false) {
  std::vector<Vec3> x;
  std::vector<geometry::Facet> facets;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) x.push_back({i * h, j * h, 0.0});
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1, centre = static_cast<int>(x.size());
      x.push_back({(i + 0.5) * h, (j + 0.5) * h, 0.0});
      for (const auto& [p, q] : {std::pair{a, b}, {b, c}, {c, d}, {d, a}}) facets.push_back({p, q, centre});
    }
  return makeWall(std::move(x), std::move(facets), oneSided);
}

/// Two planes that share the y axis: one towards +x in z = 0, the other towards −x, turned so that the angle between
/// the two normals is `bend`: > 0 a valley, < 0 a ridge. Each half is h wide and runs over |y| < h.
inline TriangulatedWall fold(double bend, double h, bool oneSided = false) {
  const double c = std::cos(bend), s = std::sin(bend);
  std::vector<Vec3> x;
  for (const double y : {-h, 0.0, h}) {
    x.push_back({-h * c, y, h * s});
    x.push_back({0.0, y, 0.0});
    x.push_back({h, y, 0.0});
  }
  std::vector<geometry::Facet> facets;
  for (const int row : {0, 3})
    for (const int column : {0, 1}) {
      const int a = row + column;
      facets.push_back({a, a + 1, a + 4});
      facets.push_back({a, a + 4, a + 3});
    }
  return makeWall(std::move(x), std::move(facets), oneSided);
}

/// Bound on how far particles have moved in a drift over dt.
inline Moves movesOf(const Particles& particles, double dt) {
  double fastest = 0.0;
  for (const Vec3& v : particles.v) fastest = std::max(fastest, norm(v));
  return {.particles = fastest * std::abs(dt)};
}

/// Elastic response of a wall to one sphere.
struct Response {
  double energy = 0.0;
  Vec3 force;                // on the sphere
  std::vector<Vec3> onWall;  // per vertex
  WallContacts contacts;
};

inline Response respond(const TriangulatedWall& wall, const Vec3& x, double radius, double stiffness,
                        EdgeRule rule = EdgeRule::projected) {
  Particles particles;
  addParticle(particles, x, {}, radius, Mass{1.0});
  WallCandidates candidates;
  findWallCandidates(particles, wall, 0.5 * radius, candidates);
  Response response;
  findWallContacts(particles, wall, candidates, rule, response.contacts);
  response.energy = sweepWall(ElasticLaw{{stiffness}}, particles, wall, response.contacts).storedEnergy();
  response.force = particles.f[0];
  response.onWall.resize(wall.x.size());
  addWallForces(response.contacts, wall.x, wall.facets, response.onWall);
  return response;
}

class Random {
public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }

private:
  std::mt19937 engine_;
};

}  // namespace dovetail::dem
