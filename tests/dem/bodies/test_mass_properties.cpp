// Mass, centre and inertia of unions of spheres and of solids.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "dovetail/core/error.hpp"
#include "dovetail/dem/bodies/mass_properties.hpp"

namespace dovetail::dem {
namespace {

constexpr double pi = std::numbers::pi;

struct Spheres {
  std::vector<Vec3> centre;
  std::vector<double> radius;
};

Spheres turned(Spheres s, const Quaternion& q, const Vec3& shift) {
  for (Vec3& c : s.centre) c = shift + rotate(q, c);
  return s;
}

MassProperties unionOf(const Spheres& s, double density = 1.0) {
  return unionOfSpheres(s.centre, s.radius, Density{density});
}

Quaternion randomTurn(std::mt19937_64& random) {
  std::normal_distribution<double> n;
  return normalized(Quaternion{n(random), n(random), n(random), n(random)});
}

Spheres randomSpheres(int n, std::mt19937_64& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  Spheres s;
  for (int i = 0; i < n; ++i) {
    s.centre.push_back({u(random), u(random), u(random)});
    s.radius.push_back(0.9 + 0.6 * u(random));
  }
  return s;
}

TEST(MassProperties, OneSphereAndTwoApart) {
  const MassProperties one = unionOf({{{1, 2, 3}}, {0.5}}, 1000.0);
  const double mass = 1000.0 * 4.0 / 3.0 * pi * 0.125;
  EXPECT_NEAR(one.mass, mass, 1e-13 * mass);
  EXPECT_LE(norm(one.centre - Vec3{1, 2, 3}), 1e-14);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(one.inertia[k], 0.4 * mass * 0.25, 1e-12 * mass);
  const Spheres apart{{{0, 0, 0}, {2, 1, 2}}, {0.5, 1.0}};
  const MassProperties a = unionOf(apart), b = sumOfSpheres(apart.centre, apart.radius, Density{1.0});
  EXPECT_NEAR(a.mass, b.mass, 1e-13 * b.mass);
  EXPECT_LE(norm(a.centre - b.centre), 1e-13);
  EXPECT_LE(norm(a.inertia - b.inertia), 1e-12 * norm(b.inertia));
}

/// Moments about the plane of the circle where two spheres meet, the part z ≥ 0 of a sphere with its centre at height
/// h.
struct Cap {
  double volume, first, along, across;  // ∫ 1, z, z² and (half of) x² + y²
  Cap(double h, double r) {
    const auto power = [&](int n, double z) { return std::pow(z, n + 1) / (n + 1); };
    const auto integral = [&](auto&& f) { return f(h + r) - f(0.0); };
    // ρ² = r² − (z − h)² = a + 2 h z − z²
    const double a = r * r - h * h;
    const auto weighted = [&](int n) {
      return pi * integral([&](double z) { return a * power(n, z) + 2 * h * power(n + 1, z) - power(n + 2, z); });
    };
    volume = weighted(0);
    first = weighted(1);
    along = weighted(2);
    across = 0.25 * pi * integral([&](double z) {
               return a * a * z + 4 * a * h * power(1, z) + (4 * h * h - 2 * a) * power(2, z) - 4 * h * power(3, z) +
                      power(4, z);
             });
  }
};

TEST(MassProperties, TwoSpheresHaveTheirClosedForm) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  for (int round = 0; round < 60; ++round) {
    const double r1 = 0.3 + u(random), r2 = 0.3 + u(random);
    const double d = std::abs(r1 - r2) + (0.01 + 0.98 * u(random)) * (2.0 * std::min(r1, r2));
    const double h1 = 0.5 * (d + (r1 * r1 - r2 * r2) / d);  // of the circle, from centre 1 towards centre 2
    const Cap lower(h1, r1), upper(d - h1, r2);             // each on its own side of the circle
    const double volume = lower.volume + upper.volume, middle = (upper.first - lower.first) / volume;
    const double along = lower.along + upper.along - volume * middle * middle, across = lower.across + upper.across;
    const Quaternion q = round % 3 == 0 ? Quaternion{} : randomTurn(random);
    const Vec3 shift{10.0 * u(random), 0.0, 3.0};
    const MassProperties p = unionOf(turned({{{0, 0, 0}, {0, 0, d}}, {r1, r2}}, q, shift));
    EXPECT_NEAR(p.mass, volume, 1e-11 * volume);
    EXPECT_LE(norm(p.centre - (shift + rotate(q, {0, 0, h1 + middle}))), 1e-11);
    std::array<double, 3> wanted{2.0 * across, along + across, along + across};
    std::sort(wanted.begin(), wanted.end());
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(p.inertia[k], wanted[k], 1e-11 * wanted[2]) << round;
  }
}

TEST(MassProperties, DoNotDependOnHowTheSlicesLie) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 10; ++round) {
    const Spheres s = randomSpheres(3 + round, random);
    const MassProperties a = unionOf(s);
    for (int turn = 0; turn < 3; ++turn) {
      const Quaternion q = randomTurn(random);
      const MassProperties b = unionOf(turned(s, q, {1, 2, 3}));
      EXPECT_NEAR(b.mass, a.mass, 1e-11 * a.mass) << round;
      EXPECT_LE(norm(b.centre - Vec3{1, 2, 3} - rotate(q, a.centre)), 1e-11) << round;
      EXPECT_LE(norm(b.inertia - a.inertia), 1e-11 * norm(a.inertia)) << round;
    }
  }
}

TEST(MassProperties, CentresOnALatticeAreAsGoodAsAnyOthers) {
  // Slices through poles, circles that lie flat or touch, and points where many spheres meet.
  std::mt19937_64 random(6);
  for (int round = 0; round < 12; ++round) {
    Spheres s;
    const int count = 2 + round;
    for (int i = 0; i < count; ++i) {
      const auto whole = [&] { return 0.5 * static_cast<double>(random() % 4); };
      s.centre.push_back({whole(), whole(), whole()});
      s.radius.push_back(0.5 * static_cast<double>(1 + random() % 2));
    }
    const MassProperties a = unionOf(s);
    const Quaternion q = randomTurn(random);
    const MassProperties b = unionOf(turned(s, q, {}));
    EXPECT_NEAR(b.mass, a.mass, 1e-10 * a.mass) << round;
    EXPECT_LE(norm(b.centre - rotate(q, a.centre)), 1e-10) << round;
    EXPECT_LE(norm(b.inertia - a.inertia), 1e-10 * norm(a.inertia)) << round;
  }
}

TEST(MassProperties, LatticesOfSpheresAndHiddenOnesAreNoSpecialCase) {
  // Coplanar, touching and repeated spheres, and one that is wholly inside: what they add is known.
  const MassProperties ball = unionOf({{{0, 0, 0}}, {1.0}});
  const MassProperties same = unionOf({{{0, 0, 0}, {0, 0, 0}, {0.3, 0.1, 0.2}, {0, 0.5, 0}}, {1.0, 1.0, 0.4, 0.5}});
  EXPECT_NEAR(same.mass, ball.mass, 1e-12);
  EXPECT_LE(norm(same.inertia - ball.inertia), 1e-12);
  Spheres lattice;
  for (int i = 0; i < 27; ++i) {
    lattice.centre.push_back({double(i % 3), double(i / 3 % 3), double(i / 9)});
    lattice.radius.push_back(0.5);
  }
  EXPECT_NEAR(unionOf(lattice).mass, 27.0 * pi / 6.0, 1e-11);
  for (double& r : lattice.radius) r = 0.6;  // 54 lenses between neighbours, nothing else overlaps
  const double h = 0.1, lens = 2.0 * pi * h * h * (3.0 * 0.6 - h) / 3.0;
  EXPECT_NEAR(unionOf(lattice).mass, 27.0 * 4.0 / 3.0 * pi * 0.216 - 54.0 * lens, 1e-11);
}

TEST(MassProperties, AgreeWithRandomPoints) {
  std::mt19937_64 random(3);
  const Spheres s = randomSpheres(6, random);
  const MassProperties p = unionOf(s);
  std::uniform_real_distribution<double> u(-2.6, 2.6);
  const int n = 400000;
  int inside = 0;
  Vec3 diagonal;
  for (int i = 0; i < n; ++i) {
    const Vec3 x{u(random), u(random), u(random)};
    bool hit = false;
    for (std::size_t k = 0; k < 6 && !hit; ++k) hit = squaredNorm(x - s.centre[k]) < s.radius[k] * s.radius[k];
    if (!hit) continue;
    ++inside;
    const Vec3 y = rotateBack(p.axes, x - p.centre);
    diagonal += Vec3{y.y * y.y + y.z * y.z, y.z * y.z + y.x * y.x, y.x * y.x + y.y * y.y};
  }
  const double cell = std::pow(5.2, 3) / n, fraction = double(inside) / n;
  EXPECT_NEAR(p.mass, cell * inside, 5.0 * cell * std::sqrt(n * fraction * (1.0 - fraction)));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(p.inertia[k], cell * diagonal[k], 0.01 * p.inertia[k]);
}

TEST(MassProperties, ASolidBoxHasItsClosedForm) {
  std::mt19937_64 random(4);
  const Quaternion q = randomTurn(random);
  std::vector<Vec3> x;
  for (int c = 0; c < 8; ++c)
    x.push_back(Vec3{100, 0, 0} + rotate(q, {c & 1 ? 3.0 : 0.0, c & 2 ? 2.0 : 0.0, c & 4 ? 1.0 : 0.0}));
  std::vector<geometry::Facet> facets{{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  const MassProperties p = solidInside(x, facets, Density{2.0});
  EXPECT_NEAR(p.mass, 12.0, 1e-12);
  EXPECT_LE(norm(p.centre - Vec3{100, 0, 0} - rotate(q, {1.5, 1.0, 0.5})), 1e-12);
  EXPECT_NEAR(p.inertia.x, 5.0, 1e-11);
  EXPECT_NEAR(p.inertia.y, 10.0, 1e-11);
  EXPECT_NEAR(p.inertia.z, 13.0, 1e-11);
  EXPECT_NEAR(std::abs(dot(rotate(p.axes, {1, 0, 0}), rotate(q, {1, 0, 0}))), 1.0, 1e-12);
  for (auto& f : facets) std::swap(f[0], f[1]);
  EXPECT_THROW(solidInside(x, facets, Density{2.0}), InputError);
  facets.pop_back();
  EXPECT_THROW(solidInside(x, facets, Density{2.0}), InputError);
}

TEST(MassProperties, BadInputIsRefused) {
  const std::vector<Vec3> x{{0, 0, 0}};
  const std::vector<double> none, negative{-1.0}, one{1.0};
  EXPECT_THROW(unionOfSpheres(x, none, Density{1.0}), InputError);
  EXPECT_THROW(unionOfSpheres({}, {}, Density{1.0}), InputError);
  EXPECT_THROW(unionOfSpheres(x, negative, Density{1.0}), InputError);
  EXPECT_THROW(sumOfSpheres(x, one, Density{0.0}), InputError);
}

}  // namespace
}  // namespace dovetail::dem
