// Tractions on walls carry the force of the contacts, and where they can its moment.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dovetail/cg/wall_traction.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "random_state.hpp"

namespace dovetail::cg {
namespace {

using testing::RandomState;

/// A wavy sheet of 2 n² facets over the unit square, split into two patches at x = ½.
struct Sheet {
  std::vector<Vec3> x;
  std::vector<std::array<int, 3>> facets;
  std::vector<int> patch;
};

Sheet sheet(int n, double wave, RandomState& random) {
  Sheet s;
  const double h = 1.0 / n;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const bool inner = i > 0 && i < n && j > 0 && j < n && 2 * i != n;
      Vec3 shaken = inner ? 0.2 * h * random.vector(-1.0, 1.0) : Vec3{};
      shaken.z = 0.0;
      s.x.push_back(Vec3{i * h, j * h, wave * std::sin(6.0 * i * h + 4.0 * j * h)} + shaken);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + (n + 1) * j, b = a + 1, c = a + n + 1, d = c + 1;
      s.facets.push_back({a, b, d});
      s.facets.push_back({a, d, c});
      s.patch.insert(s.patch.end(), 2, 2 * i < n ? 0 : 1);
    }
  return s;
}

struct Pushes {
  std::vector<int> facet;
  std::vector<std::array<double, 3>> barycentric;
  std::vector<Vec3> force;
  FacetForceView view() const { return {facet, barycentric, force}; }
};

Pushes pushes(const Sheet& s, int n, RandomState& random) {
  Pushes p;
  for (int c = 0; c < n; ++c) {
    p.facet.push_back(static_cast<int>(random.number(0.0, 0.999) * static_cast<double>(s.facets.size())));
    const double a = random.number(0.0, 1.0), b = random.number(0.0, 1.0 - a);
    p.barycentric.push_back({a, b, 1.0 - a - b});
    p.force.push_back(random.vector(-1.0, 1.0));
  }
  return p;
}

struct Resultant {
  Vec3 force, moment;
};

Resultant ofContacts(const Sheet& s, const Pushes& p) {
  Resultant sum;
  for (std::size_t c = 0; c < p.facet.size(); ++c) {
    Vec3 point;
    for (int k = 0; k < 3; ++k) point += p.barycentric[c][k] * s.x[s.facets[p.facet[c]][k]];
    sum.force -= p.force[c];
    sum.moment -= cross(point, p.force[c]);
  }
  return sum;
}

Resultant ofTraction(const Sheet& s, const VertexTraction& t) {
  Resultant sum;
  for (std::size_t v = 0; v < s.x.size(); ++v) {
    sum.force += t.area[v] * t.traction[v];
    sum.moment += cross(s.x[v], t.area[v] * t.traction[v]);
  }
  return sum;
}

TEST(WallTraction, IntegratesToTheForceAndWithLinearCorrectionToTheMoment) {
  RandomState random(1);
  for (double wave : {0.0, 0.1}) {
    const Sheet s = sheet(12, wave, random);
    const Pushes p = pushes(s, 300, random);
    const Resultant wanted = ofContacts(s, p);
    for (double width : {0.0, 0.05, 0.25, 2.0}) {
      const Kernel kernel{KernelShape::lucy, 2, width};
      for (KernelCorrection correction : {KernelCorrection::none, KernelCorrection::linear}) {
        const Resultant sum = ofTraction(s, wallTraction({kernel, correction}, s.x, s.facets, s.patch, p.view()));
        EXPECT_LT(norm(sum.force - wanted.force), 1e-11) << width;
        if (width == 0.0 || correction == KernelCorrection::linear) {
          EXPECT_LT(norm(sum.moment - wanted.moment), 1e-10) << width;
        }
      }
    }
  }
}

TEST(WallTraction, StaysOnThePatchAndIsThatOfThePlaneFarFromItsRims) {
  RandomState random(2);
  const Sheet s = sheet(64, 0.0, random);
  // One push in the middle of the left patch.
  Pushes p;
  const auto at = std::size_t{2 * (16 + 64 * 32)};
  p.facet.push_back(static_cast<int>(at));
  p.barycentric.push_back({1, 0, 0});
  p.force.push_back({1, -2, 3});
  const std::vector<Vec3> point{s.x[s.facets[at][0]]};
  const Kernel kernel{KernelShape::lucy, 2, 0.2};
  const VertexTraction t = wallTraction({kernel, KernelCorrection::none}, s.x, s.facets, s.patch, p.view());
  const auto plane = surfaceTraction(kernel, s.x, {point, p.force});
  double area = 0.0;
  for (std::size_t v = 0; v < s.x.size(); ++v) {
    area += t.area[v];
    EXPECT_LT(norm(t.traction[v] - plane[v]), 0.05 * kernel.peak() * norm(p.force[0])) << v;  // mesh: width/13
    if (s.x[v].x > 0.5 + 1e-9) {
      EXPECT_EQ(t.traction[v], Vec3{});
    }
  }
  EXPECT_NEAR(area, 1.0, 2e-3);                                  // shaken out of the plane
  EXPECT_LT(dot(t.traction[s.facets[at][0]], p.force[0]), 0.0);  // what particles do to the wall
}

TEST(WallTraction, IsTheSameForAnyNumberOfThreads) {
  RandomState random(3);
  const Sheet s = sheet(10, 0.1, random);
  const Pushes p = pushes(s, 500, random);
  const SurfaceKernel kernel{{KernelShape::lucy, 2, 0.3}, KernelCorrection::linear};
  const auto one = wallTraction(kernel, s.x, s.facets, s.patch, p.view());
  setThreads(3);
  EXPECT_EQ(one.traction, wallTraction(kernel, s.x, s.facets, s.patch, p.view()).traction);
  setThreads(1);
}

TEST(WallTraction, OfAPlaneIntegratesToTheReaction) {
  const std::vector<Vec3> contact{{0.1, 0.05, 0}, {-0.2, 0.15, 0}}, force{{1, 2, 30}, {-4, 0.5, 12}};
  const int n = 400;
  const double h = 2.0 / n;
  const auto plane = gridPoints({{-1 + 0.5 * h, -1 + 0.5 * h, 0}, {h, h, 0}, {n, n, 1}});
  const Kernel kernel{KernelShape::lucy, 2, 0.6};
  Vec3 total, moment;
  const auto traction = surfaceTraction(kernel, plane, {contact, force});
  for (std::size_t p = 0; p < plane.size(); ++p) {
    total += h * h * traction[p];
    moment += h * h * cross(plane[p], traction[p]);
  }
  EXPECT_LT(norm(total - Vec3{3, -2.5, -42}), 1e-7);
  EXPECT_LT(norm(moment + cross(contact[0], force[0]) + cross(contact[1], force[1])), 1e-6);
  // Where space repeats, a period carries it all.
  const geometry::Periodicity space{{{-0.25, -0.25, 0}, {0.25, 0.25, 0}}, {true, true, false}};
  Vec3 ofPeriod;
  const auto part = gridPoints({{0, 0, 0}, {0.02, 0.02, 0}, {25, 25, 1}});
  for (const Vec3& t : surfaceTraction(kernel, part, {contact, force}, space)) ofPeriod += 4e-4 * t;
  EXPECT_LT(norm(ofPeriod - Vec3{3, -2.5, -42}), 1e-3);
}

TEST(WallTraction, BadInputIsRefused) {
  RandomState random(4);
  const Sheet s = sheet(4, 0.0, random);
  const Pushes good = pushes(s, 5, random);
  const SurfaceKernel kernel{{KernelShape::lucy, 2, 0.3}};
  const auto traction = [&](const Pushes& p) { return wallTraction(kernel, s.x, s.facets, s.patch, p.view()); };
  Pushes bad = good;
  bad.facet[2] = 1000;
  EXPECT_THROW(traction(bad), InputError);
  bad = good;
  bad.force[3].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(traction(bad), InputError);
  bad = good;
  bad.barycentric.pop_back();
  EXPECT_THROW(traction(bad), InputError);
  EXPECT_THROW(wallTraction(kernel, s.x, s.facets, {}, {}), InputError);
  EXPECT_THROW(wallTraction({kernel.kernel, KernelCorrection::symmetric}, s.x, s.facets, s.patch, {}), InputError);
  EXPECT_THROW(surfaceTraction({KernelShape::lucy, 3, 0.5}, s.x, {}), InputError);
  EXPECT_THROW(surfaceTraction({KernelShape::lucy, 2, 0.5}, s.x, {s.x, {}}), InputError);
  EXPECT_EQ(wallTraction(kernel, s.x, s.facets, s.patch, {}).traction[0], Vec3{});
}

}  // namespace
}  // namespace dovetail::cg
