// Troughs, plates and wedges: what is exact there, whatever the cut into triangles.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/quaternion.hpp"
#include "dovetail/dem/walls/edge_contact_solver.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double radius = 0.5, stiffness = 1e5, length = 12.0, width = 3.0;

/// Two planes that meet on the z axis at an angle, in n × 2 m quadrangles with vertices and diagonals at random.
TriangulatedWall trough(double angle, int n, int m, const Quaternion& turn, bool oneSided, Random& random) {
  const Vec3 along[2] = {{-std::cos(angle), -std::sin(angle), 0.0}, {1.0, 0.0, 0.0}};
  std::vector<Vec3> x;
  for (int i = 0; i <= n; ++i)
    for (int j = -m; j <= m; ++j) {
      const bool inside = i > 0 && i < n;
      const double off = inside ? 0.3 : 0.0,
                   w = (j + (j != 0 && std::abs(j) < m ? random(-off, off) : 0.0)) * width / m;
      x.push_back(w * along[j > 0] + Vec3{0, 0, (i + random(-off, off)) * length / n});
    }
  std::vector<geometry::Facet> facets;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * m; ++j) {
      const int a = i * (2 * m + 1) + j, b = a + 1, d = a + 2 * m + 1, c = d + 1;
      if (random(0, 1) < 0.5)
        facets.insert(facets.end(), {{a, d, c}, {a, c, b}});
      else
        facets.insert(facets.end(), {{a, d, b}, {b, d, c}});
    }
  for (Vec3& p : x) p = rotate(turn, p);
  return makeWall(std::move(x), std::move(facets), oneSided);
}

double inRadians(double degrees) { return degrees * std::numbers::pi / 180.0; }

TEST(WallTroughs, TheCutIntoTrianglesDoesNotShow) {
  Random random(5);
  for (int trial = 0; trial < 4000; ++trial) {
    const double angle = inRadians(trial % 2 == 0 ? 90.0 : random(50.0, 170.0));
    const auto wall = trough(angle, 6, 3, {}, trial % 3 == 0, random);
    const double d1 = random(0.0, 0.2) * radius, d2 = random(0.0, 0.2) * radius;
    std::vector<Fraction> planes{{{0, 1, 0}, d1}, {{std::sin(angle), -std::cos(angle), 0}, d2}};
    EdgeContactSolver().solve(planes, 1e-15);
    const Vec3 expected = planes[0].carried * planes[0].normal + planes[1].carried * planes[1].normal;
    const double height = radius - d1, out = (radius - d2 + std::cos(angle) * height) / std::sin(angle);
    const Response response = respond(wall, {out, height, random(4.0, 8.0)}, radius, 1.0);
    ASSERT_LE(norm(response.force - expected), 1e-13) << trial;
  }
}

/// How a frictionless ball slides along a trough into which it is pressed.
struct Slide {
  double speedChange = 0.0;  // of the impulse exchanged over the mass
  double energyDrift = 0.0;  // of the elastic energy
};

Slide slide(double degrees, double depth, double dt, bool oneSided, unsigned seed) {
  Random random(seed);
  const Quaternion turn = fromRotationVector(random.vector(2.0));
  const double half = 0.5 * inRadians(degrees);
  const auto wall = trough(2.0 * half, 12, 3, turn, oneSided, random);
  const Vec3 edge = rotate(turn, {0, 0, 1}), up = rotate(turn, {std::cos(half), std::sin(half), 0});
  Particles ball;
  const Vec3 start = (radius * (1.0 - depth) / std::sin(half)) * up + 2.0 * edge;
  addParticle(ball, start, 15.0 * edge + 0.3 * up, radius, Mass{1.0});
  WallCandidates candidates;
  findWallCandidates(ball, wall, length, candidates);
  const auto laws = makeContactLaws(ElasticLaw{{stiffness}});
  WallContacts contacts;
  double elastic = 0.0;
  Vec3 load;
  const auto findForces = [&] {
    clearForces(ball);
    findWallContacts(ball, wall, candidates, EdgeRule::projected, contacts);
    elastic = laws->wall(ball, wall, contacts, 0.0, Booking::on).storedEnergy();
    ball.f[0] += load;
  };
  findForces();
  load = -dot(ball.f[0], up) * up;
  findForces();
  const auto energy = [&] { return elastic + 0.5 * squaredNorm(ball.v[0]) - dot(load, ball.x[0] - start); };
  const double first = energy(), size = elastic, speed = dot(ball.v[0], edge);
  Slide slide;
  double impulse = 0.0;
  for (double t = 0.0; t < 0.4; t += dt) {
    kick(ball, 0.5 * dt);
    drift(ball, dt);
    findForces();
    impulse += dt * norm(ball.f[0] - load);
    kick(ball, 0.5 * dt);
    slide.energyDrift = std::max(slide.energyDrift, std::abs(energy() - first) / size);
  }
  slide.speedChange = std::abs(dot(ball.v[0], edge) - speed) / impulse;
  return slide;
}

TEST(WallTroughs, AFrictionlessBallKeepsItsSpeedAlongTheEdge) {
  unsigned seed = 0;
  for (const double degrees : {60.0, 90.0, 95.0, 120.0})
    for (const double depth : {0.1, 0.2}) {
      const bool oneSided = ++seed % 2 == 0;
      const Slide coarse = slide(degrees, depth, 4e-4, oneSided, seed),
                  fine = slide(degrees, depth, 2e-4, oneSided, seed);
      EXPECT_LE(coarse.speedChange, 1e-12) << degrees << " degrees, " << depth << " R";
      EXPECT_LE(fine.energyDrift, 0.3 * coarse.energyDrift) << degrees << " degrees, " << depth << " R";
      EXPECT_LE(coarse.energyDrift, 0.02);
    }
}

/// A closed plate whose top is at z = 0.
TriangulatedWall plate(double thickness, double half = 4.0) {
  std::vector<Vec3> x;
  for (const double z : {-thickness, 0.0})
    for (const auto& [a, b] : {std::pair{-half, -half}, {half, -half}, {half, half}, {-half, half}})
      x.push_back({a, b, z});
  return makeWall(std::move(x),
                  {{4, 5, 6},
                   {4, 6, 7},
                   {0, 2, 1},
                   {0, 3, 2},
                   {0, 1, 5},
                   {0, 5, 4},
                   {1, 2, 6},
                   {1, 6, 5},
                   {2, 3, 7},
                   {2, 7, 6},
                   {3, 0, 4},
                   {3, 4, 7}},
                  true);
}

TEST(WallTroughs, AThinClosedPlateIsAThickOneForCentresOutside) {
  Random random(2);
  for (const double thickness : {1e-9, 1e-4, 1e-3, 0.01, 0.1, 1.0})
    for (const double depth : {0.01, 0.1, 0.5, 0.99}) {
      const Vec3 at{random(-1.0, 1.0), random(-1.0, 1.0), radius * (1.0 - depth)};
      const Vec3 force = respond(plate(thickness * radius), at, radius, stiffness).force;
      EXPECT_LE(norm(force - Vec3{0, 0, stiffness * depth * radius}), 1e-10 * stiffness * radius) << thickness;
    }
}

TEST(WallTroughs, TheEdgeOfAThinPlateActsAsAnEdge) {
  // Beside the edge of a plate of 1 mm the nearest way out is sideways, from above and below alike.
  const double thickness = 0.002 * radius;
  for (const double tilt : {-1.2, -0.5, 0.0, 0.5, 1.2}) {
    const Vec3 normal{std::cos(tilt), 0.0, std::sin(tilt)};
    const Vec3 edge{4.0, 0.3, tilt > 0.0 ? 0.0 : tilt < 0.0 ? -thickness : -0.5 * thickness};
    const Vec3 force = respond(plate(thickness), edge + 0.7 * radius * normal, radius, stiffness).force;
    EXPECT_LE(norm(force - 0.3 * radius * stiffness * normal), 1e-9 * stiffness * radius) << tilt;
  }
}

TEST(WallTroughs, ASunkCentreLeavesByTheShortestWay) {
  const auto block = plate(4.0);
  // Below the top and, deeper, behind the side: out through the top alone.
  const Vec3 byTop = respond(block, {4.0 - 0.3, 0.1, -0.1}, radius, stiffness).force;
  EXPECT_LE(norm(byTop - Vec3{0, 0, stiffness * (radius + 0.1)}), 1e-9 * stiffness);
  const Vec3 bySide = respond(block, {4.0 - 0.05, 0.1, -0.2}, radius, stiffness).force;
  EXPECT_LE(norm(bySide - Vec3{stiffness * (radius + 0.05), 0, 0}), 1e-9 * stiffness);
  // The energy goes on where the centre passes the surface.
  for (const Vec3& at : {Vec3{3.9, 0.1, 0.0}, Vec3{4.0, 0.1, 0.0}, Vec3{4.0, 4.0, 0.0}})
    EXPECT_NEAR(respond(block, at + Vec3{1e-9, 1e-9, 1e-9}, radius, stiffness).energy,
                respond(block, at - Vec3{1e-9, 1e-9, 1e-9}, radius, stiffness).energy, 1e-8 * stiffness);
}

}  // namespace
}  // namespace dovetail::dem
