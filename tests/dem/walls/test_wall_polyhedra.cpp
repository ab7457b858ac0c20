// The force is the gradient of one energy at random places of random polyhedra, and the energy goes on where other
// facets, edges and vertices come to act.
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include "dovetail/geometry/triangle.hpp"
#include "dovetail/geometry/triangle_mesh.hpp"
#include "plate_wall.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double radius = 0.5;

/// An octahedron cut finer and pushed about: a closed body, convex to spiky.
TriangulatedWall body(Random& random, double size, double roughness, int cuts) {
  std::vector<Vec3> x{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<geometry::Facet> facets{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<int, int>, int> middles;
    std::vector<geometry::Facet> finer;
    const auto middle = [&](int a, int b) {
      const auto [at, isNew] = middles.try_emplace(std::minmax(a, b), static_cast<int>(x.size()));
      if (isNew) x.push_back(normalized(x[static_cast<std::size_t>(a)] + x[static_cast<std::size_t>(b)]));
      return at->second;
    };
    for (const auto& [a, b, c] : facets) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    facets = finer;
  }
  const Vec3 half{random(0.3, 1.0), random(0.3, 1.0), random(0.3, 1.0)};
  for (Vec3& p : x) p = size * (1.0 + random(-roughness, roughness)) * Vec3{half.x * p.x, half.y * p.y, half.z * p.z};
  return makeWall(std::move(x), std::move(facets), true);
}

TriangulatedWall ground(Random& random) {
  auto wall = squares(5, 5, random(0.3, 1.0));
  const double roughness = random(0.05, 0.35);
  for (Vec3& x : wall.x) x += random.vector(roughness);
  return wall;
}

TriangulatedWall polyhedron(int kind, Random& random) {
  switch (kind % 4) {
    case 0:
      return body(random, random(0.6, 4.0), random(0.0, 0.15), kind / 4 % 3);
    case 1:
      return body(random, random(1.0, 4.0), random(0.2, 0.7), 1 + kind / 4 % 2);
    case 2:
      return plate(random, random(0.3, 1.2), random(0.0, 0.3), std::pow(10.0, random(-4.0, -0.5)));
    default:
      return ground(random);
  }
}

/// A centre outside, 0 to 0.5 R in overlap.
Vec3 placeNear(const TriangulatedWall& wall, Random& random) {
  while (true) {
    const auto& t =
        wall.facets[static_cast<std::size_t>(random(0.0, 0.999999) * static_cast<double>(wall.facets.size()))];
    const auto corner = [&](std::size_t k) { return wall.x[static_cast<std::size_t>(t[k])]; };
    const double a = random(0, 1), b = random(0, 1 - a);
    const Vec3 at = corner(0) + a * (corner(1) - corner(0)) + b * (corner(2) - corner(0)) +
                    random(0.5, 1.0) * radius * normalized(random.vector(1.0));
    double nearest = radius;
    for (const auto& f : wall.facets) {
      const auto x = [&](std::size_t k) { return wall.x[static_cast<std::size_t>(f[k])]; };
      nearest = std::min(nearest, norm(at - geometry::closestPointOnTriangle(at, x(0), x(1), x(2)).point));
    }
    if (nearest < 0.5 * radius || nearest >= radius) continue;
    if (wall.oneSided && geometry::windingNumber(wall.x, wall.facets, at) > 0.5) continue;
    return at;
  }
}

/// Facets and features that act.
std::vector<std::array<int, 4>> acting(const Response& response) {
  std::vector<std::array<int, 4>> list;
  for (std::size_t c = 0; c < response.contacts.size(); ++c) {
    const auto& w = response.contacts.weight[c];
    list.push_back({response.contacts.facet[c], w[0] > 0.0, w[1] > 0.0, w[2] > 0.0});
  }
  return list;
}

/// @param away places where the same features act around @param switches others
void expectGradients(Random random, int& away, int& switches) {
  for (int kind = 0; kind < 60; ++kind) {
    const auto wall = polyhedron(kind, random);
    for (int place = 0; place < 60; ++place) {
      const Vec3 at = placeNear(wall, random), along = normalized(random.vector(1.0));
      const double h = 1e-5 * radius;
      const auto seen = [&](double steps) { return respond(wall, at + steps * h * along, radius, 1.0); };
      const Response here = seen(0), before = seen(-10), after = seen(10);
      ASSERT_GT(here.contacts.size(), 0u);
      if (acting(before) == acting(here) && acting(after) == acting(here)) {
        ++away;
        const double slope =
            (8.0 * (seen(1).energy - seen(-1).energy) - (seen(2).energy - seen(-2).energy)) / (12.0 * h);
        EXPECT_LE(std::abs(slope + dot(here.force, along)), 1e-6 * norm(here.force)) << kind << ", place " << place;
      } else {
        ++switches;
        Response last = before;
        for (int step = -9; step <= 10; ++step) {
          const Response next = seen(step);
          // The trapezoidal rule is exact to the square of the step where the force has a kink.
          const double jump = next.energy - last.energy + 0.5 * h * dot(next.force + last.force, along);
          EXPECT_LE(std::abs(jump), 1e-10) << kind << ", place " << place;
          last = next;
        }
      }
    }
  }
}

TEST(WallPolyhedra, TheForceIsTheGradientOfAnEnergyThatGoesOnOverSwitches) {
  int away = 0, switches = 0;
  for (const unsigned seed : {4u, 5u}) expectGradients(Random(seed), away, switches);
  EXPECT_GT(away, 6000);
  EXPECT_GT(switches, 700);
}

}  // namespace
}  // namespace dovetail::dem
