// The projection rule: forces are the gradient of its energy, at random states.
#include <gtest/gtest.h>

#include <functional>

#include "dovetail/geometry/triangle.hpp"
#include "wall_scenes.hpp"

namespace dovetail::dem {
namespace {

constexpr double radius = 0.5, stiffness = 2e3;

struct State {
  TriangulatedWall wall;
  Vec3 x;
};

/// What a family of states went through.
struct Coverage {
  int touching = 0, single = 0, several = 0, threeOrMore = 0, offFace = 0, severalOffFace = 0;
  double worstGradient = 0.0, worstForce = 0.0, worstMoment = 0.0;
};

double energyAlong(const State& state, const Vec3& dx, const std::vector<Vec3>& dWall, double h) {
  State moved = state;
  moved.x += h * dx;
  for (std::size_t i = 0; i < dWall.size(); ++i) moved.wall.x[i] += h * dWall[i];
  return respond(moved.wall, moved.x, radius, stiffness).energy;
}

/// Largest |dV/ds + F·s| over directions s in which the sphere and all vertices move, relative to |F|.
double gradientError(const State& state, const Response& response, Random& random) {
  double size = 0.0, worst = 0.0;
  for (const Vec3& f : response.onWall) size += norm(f);
  for (int k = 0; k < 4; ++k) {
    const Vec3 dx = k % 2 == 0 ? random.vector(1.0) : Vec3{};
    std::vector<Vec3> dWall(state.wall.x.size());
    if (k > 0)
      for (Vec3& d : dWall) d = random.vector(1.0);
    const double h = 1e-6 * radius;
    const double slope = (energyAlong(state, dx, dWall, h) - energyAlong(state, dx, dWall, -h)) / (2.0 * h);
    double work = dot(response.force, dx);
    for (std::size_t i = 0; i < dWall.size(); ++i) work += dot(response.onWall[i], dWall[i]);
    worst = std::max(worst, std::abs(slope + work) / size);
  }
  return worst;
}

void balance(const State& state, const Response& response, Coverage& coverage) {
  Vec3 force = response.force, moment = cross(state.x, response.force);
  double size = 0.0;
  for (std::size_t i = 0; i < response.onWall.size(); ++i) {
    force += response.onWall[i];
    moment += cross(state.wall.x[i], response.onWall[i]);
    size += norm(response.onWall[i]);
  }
  coverage.worstForce = std::max(coverage.worstForce, norm(force) / size);
  coverage.worstMoment = std::max(coverage.worstMoment, norm(moment) / (size * radius));
}

Coverage survey(const std::function<State(Random&)>& draw, int states, unsigned seed) {
  Random random(seed);
  Coverage coverage;
  for (int s = 0; s < states; ++s) {
    const State state = draw(random);
    const Response response = respond(state.wall, state.x, radius, stiffness);
    if (response.contacts.size() == 0) continue;
    bool offFace = false;
    for (const auto& w : response.contacts.weight) offFace = offFace || w[0] * w[1] * w[2] == 0.0;
    ++coverage.touching;
    coverage.single += response.contacts.size() == 1;
    coverage.several += response.contacts.size() >= 2;
    coverage.threeOrMore += response.contacts.size() >= 3;
    coverage.offFace += offFace;
    coverage.severalOffFace += offFace && response.contacts.size() >= 2;
    coverage.worstGradient = std::max(coverage.worstGradient, gradientError(state, response, random));
    balance(state, response, coverage);
  }
  return coverage;
}

void expectConservative(const Coverage& coverage) {
  EXPECT_LE(coverage.worstGradient, 1e-6);
  EXPECT_LE(coverage.worstForce, 1e-14);
  EXPECT_LE(coverage.worstMoment, 1e-12);
}

/// Rough ground of facets about as large as the sphere.
State roughGround(Random& random, double roughness, double overlap, bool oneSided) {
  State state{squares(4, 4, 0.6, oneSided), {}};
  for (Vec3& x : state.wall.x) x += random.vector(roughness);
  state.x = {random(0.9, 1.5), random(0.9, 1.5), 2.0};
  // Lower the sphere until it touches, then by the overlap wanted.
  double high = 2.0, low = 0.0;
  for (int i = 0; i < 50; ++i) {
    state.x.z = 0.5 * (high + low);
    (respond(state.wall, state.x, radius, stiffness).contacts.size() > 0 ? low : high) = state.x.z;
  }
  state.x.z -= random(0.1, 1.0) * overlap;
  return state;
}

TEST(WallPotential, RoughGroundWithSmallOverlaps) {
  for (const bool oneSided : {false, true}) {
    const auto coverage =
        survey([&](Random& r) { return roughGround(r, 0.1, 0.01 * radius, oneSided); }, 400, oneSided ? 1 : 2);
    expectConservative(coverage);
    EXPECT_GT(coverage.offFace, 50);
  }
}

TEST(WallPotential, RoughGroundWithDeepOverlaps) {
  const auto coverage = survey([](Random& r) { return roughGround(r, 0.25, 0.3 * radius, false); }, 1500, 3);
  expectConservative(coverage);
  EXPECT_GT(coverage.several, 100);
  EXPECT_GT(coverage.threeOrMore, 5);
  EXPECT_GT(coverage.severalOffFace, 20);
}

TEST(WallPotential, ValleysAndRidges) {
  const auto draw = [](Random& random) {
    const double bend = random(-1.2, 1.8), overlap = random(0.001, 0.1) * radius;
    State state{fold(bend, 2.0), {}};
    for (Vec3& x : state.wall.x) x += random.vector(0.02);
    state.x = {random(-0.03, 0.03), random(-0.5, 0.5), radius - overlap};
    if (bend > 0.0) state.x.x += radius * std::tan(0.5 * bend);
    return state;
  };
  const auto coverage = survey(draw, 400, 4);
  expectConservative(coverage);
  EXPECT_GT(coverage.several, 50);
  EXPECT_GT(coverage.single, 50);
}

/// The force leads to the nearest position clear of all facets: there the sphere touches, and no clear place is nearer.
TEST(WallPotential, TheForceLeadsToTheNearestClearPosition) {
  Random random(9);
  int several = 0;
  for (int s = 0; s < 800; ++s) {
    const State state = roughGround(random, 0.25, 0.2 * radius, false);
    const Response response = respond(state.wall, state.x, radius, stiffness);
    const auto& normal = response.contacts.normal;
    bool blended = false;
    for (const Vec3& a : normal)
      for (const Vec3& b : normal) blended = blended || dot(a, b) < 0.2;
    if (blended) continue;
    several += normal.size() > 1;
    const Vec3 step = response.force / stiffness;
    const auto clear = [&](const Vec3& y) {
      double least = 1e300;
      for (const auto& t : state.wall.facets) {
        const auto vertex = [&](std::size_t k) { return state.wall.x[static_cast<std::size_t>(t[k])]; };
        least = std::min(least, norm(y - geometry::closestPointOnTriangle(y, vertex(0), vertex(1), vertex(2)).point));
      }
      return least - radius;
    };
    ASSERT_NEAR(clear(state.x + step), 0.0, 1e-12);
    ASSERT_NEAR(response.energy, 0.5 * stiffness * squaredNorm(step), 1e-11 * response.energy);
    for (int k = 0; k < 30; ++k) {
      const Vec3 other = step + random.vector(0.1 * norm(step));
      if (clear(state.x + other) >= 0.0) {
        ASSERT_GE(norm(other), norm(step));
      }
    }
  }
  EXPECT_GT(several, 50);
}

/// Three walls that meet in a corner, at any angles.
TEST(WallPotential, CornersOfThreeWalls) {
  const auto draw = [](Random& random) {
    std::vector<Vec3> x{{0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
    const double open = random(-0.3, 1.2);
    for (std::size_t i = 1; i < 4; ++i) x[i] += Vec3{-open, -open, -open} + random.vector(0.1);
    State state{makeWall(std::move(x), {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}), {}};
    std::array<Vec3, 3> normal;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& t = state.wall.facets[i];
      normal[i] = geometry::triangleNormal(state.wall.x[0], state.wall.x[static_cast<std::size_t>(t[1])],
                                           state.wall.x[static_cast<std::size_t>(t[2])]);
    }
    // Centre at distance R − overlap from each of the three planes.
    const double det = dot(normal[0], cross(normal[1], normal[2]));
    for (std::size_t i = 0; i < 3; ++i) {
      const double distance = radius * (1.0 - random(-0.01, 0.05));
      state.x += (distance / det) * cross(normal[(i + 1) % 3], normal[(i + 2) % 3]);
    }
    return state;
  };
  const auto coverage = survey(draw, 400, 5);
  expectConservative(coverage);
  EXPECT_GT(coverage.several, 100);
  EXPECT_GT(coverage.threeOrMore, 50);
}

/// A sphere that rests on two separate edges, or three separate points: all contacts turn as it moves.
TEST(WallPotential, SlotsAndPrickles) {
  const auto slot = [](Random& random) {
    const double half = random(0.1, 0.4);
    std::vector<Vec3> x{{-half, -2, 0}, {-half, 2, 0}, {-3, 0, -0.5}, {half, -2, 0}, {half, 2, 0}, {3, 0, -0.5}};
    for (Vec3& p : x) p += random.vector(0.004);
    State state{makeWall(std::move(x), {{0, 1, 2}, {3, 4, 5}}), {}};
    state.x = {random(-0.002, 0.002), 0.0, std::sqrt(radius * radius - half * half) - random(0.005, 0.012)};
    return state;
  };
  const auto prickles = [](Random& random) {
    std::vector<Vec3> x;
    std::vector<geometry::Facet> facets;
    for (int k = 0; k < 3; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / 3.0;
      const Vec3 out{std::cos(angle), std::sin(angle), 0.0}, across{-out.y, out.x, 0.0};
      for (const Vec3& p :
           {0.3 * out, 2.0 * out + 0.3 * across - Vec3{0, 0, 1}, 2.0 * out - 0.3 * across - Vec3{0, 0, 1}})
        x.push_back(p + random.vector(0.02));
      facets.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    State state{makeWall(std::move(x), std::move(facets)), {}};
    state.x = {random(-0.02, 0.02), random(-0.02, 0.02), 0.4 - random(0.02, 0.08)};
    return state;
  };
  const auto onSlots = survey(slot, 300, 6);
  expectConservative(onSlots);
  EXPECT_GT(onSlots.severalOffFace, 200);
  const auto onPrickles = survey(prickles, 300, 7);
  expectConservative(onPrickles);
  EXPECT_GT(onPrickles.threeOrMore, 100);
}

/// Walls that face each other push one by one; nothing diverges.
TEST(WallPotential, OpposingWalls) {
  const auto draw = [](Random& random) {
    const double gap = 2.0 * radius * (1.0 - random(0.0, 0.05));
    std::vector<Vec3> x{{-2, -2, 0}, {2, -2, 0}, {0, 3, 0}, {-2, -2, gap}, {2, -2, gap}, {0, 3, gap}};
    for (Vec3& p : x) p += random.vector(0.01);
    return State{makeWall(std::move(x), {{0, 1, 2}, {3, 4, 5}}), {random(-0.1, 0.1), 0.0, 0.5 * gap}};
  };
  const auto coverage = survey(draw, 200, 8);
  expectConservative(coverage);
  EXPECT_GT(coverage.several, 50);
}

}  // namespace
}  // namespace dovetail::dem
