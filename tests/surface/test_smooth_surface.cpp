#include <gtest/gtest.h>

#include <algorithm>

#include "dovetail/core/error.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "scenes.hpp"

namespace dovetail::surface {
namespace {

constexpr std::array<std::array<double, 2>, 4> cornerParameter{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

/// Point of an edge of a face's parameter square, t from its first to its second corner.
std::array<double, 2> onEdge(int edge, double t) {
  const auto &a = cornerParameter[edge], &b = cornerParameter[(edge + 1) % 4];
  return {(1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1]};
}

PatchPoint pointAt(const SmoothSurface& surface, int face, std::array<double, 2> parameter) {
  PatchPoint at;
  at.parameter = parameter;
  at.weight = patchWeights(parameter[0], parameter[1]);
  for (std::size_t k = 0; k < 16; ++k) at.point += at.weight[k] * surface.x[surface.control[face][k]];
  return at;
}

void placeAll(SmoothSurface& surface, std::span<const Vec3> u) {
  std::vector<int> all(surface.X.size());
  for (std::size_t c = 0; c < all.size(); ++c) all[c] = static_cast<int>(c);
  place(surface, u, std::vector<Vec3>(u.size()), all);
}

int edgeTowards(const SmoothSurface& surface, int face, int neighbour) {
  const auto& across = surface.across[face];
  return static_cast<int>(std::find(across.begin(), across.end(), neighbour) - across.begin());
}

TEST(SmoothSurface, WeightsSumToOneAndDeriveFromOnePolynomial) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const double xi = random(0, 1), eta = random(0, 1);
    const auto weight = patchWeights(xi, eta);
    double sum = 0.0, first = 0.0, second = 0.0;
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 4; ++k) {
        sum += weight[k + 4 * j];
        first += weight[k + 4 * j] * (k - 1);
        second += weight[k + 4 * j] * (j - 1);
        EXPECT_GE(weight[k + 4 * j], 0.0);
      }
    EXPECT_NEAR(sum, 1.0, 1e-15);
    EXPECT_NEAR(first, xi, 1e-15);
    EXPECT_NEAR(second, eta, 1e-15);
  }
}

/// Up to the rim, and after any affine displacement.
TEST(SmoothSurface, ReproducesLinearFields) {
  const fem::SolidMesh mesh = unitBlock();
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  SmoothSurface surface = makeSmoothSurface(skin);
  Random random(2);
  const std::array<Vec3, 4> affine{random.vector(0.5), random.vector(0.5), random.vector(0.5), random.vector(0.5)};
  const auto displaced = [&](const Vec3& X) {
    return X + affine[0] + X.x * affine[1] + X.y * affine[2] + X.z * affine[3];
  };
  std::vector<Vec3> u;
  for (const Vec3& X : mesh.X) u.push_back(displaced(X) - X);
  placeAll(surface, u);
  for (std::size_t face = 0; face < skin.faces.size(); ++face)
    for (int i = 0; i < 5; ++i) {
      const double xi = i == 0 ? 0.0 : random(0, 1), eta = i == 1 ? 1.0 : random(0, 1);
      Vec3 X;
      const std::array<double, 4> shape{(1 - xi) * (1 - eta), xi * (1 - eta), xi * eta, (1 - xi) * eta};
      for (int k = 0; k < 4; ++k) X += shape[k] * skin.X[skin.faces[face].node[k]];
      const Vec3 x = pointAt(surface, static_cast<int>(face), {xi, eta}).point;
      EXPECT_LE(norm(x - displaced(X)), 1e-14) << "face " << face;
    }
}

class SmoothNormals : public ::testing::TestWithParam<Variant> {};

TEST_P(SmoothNormals, AreContinuousWhereThoseOfFacetsJump) {
  const fem::SolidMesh mesh = unitBlock();
  Skin skin = carriedSkin(mesh, GetParam());
  SmoothSurface surface = makeSmoothSurface(skin);
  Random random(3);
  const auto u = random.field(mesh.X.size(), 0.2);
  placeAll(surface, u);
  place(skin, u, u);
  double jump = 0.0, gap = 0.0, flatJump = 0.0;
  int boundaries = 0;
  for (int face = 0; face < static_cast<int>(surface.control.size()); ++face)
    for (int e = 0; e < 4; ++e) {
      const int other = surface.across[face][e];
      if (other < 0) continue;
      ++boundaries;
      const int edge = edgeTowards(surface, other, face);
      for (double t : {0.0, 0.3, 1.0}) {
        const PatchPoint here = pointOnPatch(surface, face, onEdge(e, t)),
                         there = pointOnPatch(surface, other, onEdge(edge, 1 - t));
        gap = std::max(gap, norm(here.point - there.point));
        jump = std::max(jump, norm(here.normal() - there.normal()));
      }
      const auto normalOf = [&](int facet) {
        const auto& v = skin.wall.facets[facet];
        return geometry::triangleNormal(skin.wall.x[v[0]], skin.wall.x[v[1]], skin.wall.x[v[2]]);
      };
      flatJump = std::max(flatJump, norm(normalOf(4 * face + e) - normalOf(4 * other + edge)));
    }
  EXPECT_EQ(boundaries, 2 * (24 + 24 + 4 * 10));
  EXPECT_LE(gap, 1e-13);
  EXPECT_LE(jump, 1e-10);
  EXPECT_GT(flatJump, GetParam().width > 2.0 ? 1e-3 : 0.1);
}

INSTANTIATE_TEST_SUITE_P(Variants, SmoothNormals, ::testing::ValuesIn(flatVariants()), VariantName{});

TEST(SmoothSurface, ClosestPointAgainstBruteForce) {
  const fem::SolidMesh mesh = unitBlock();
  SmoothSurface surface = makeSmoothSurface(makeSkin(mesh.X, mesh.faceSets.at("z+")));
  Random random(4);
  placeAll(surface, random.field(mesh.X.size(), 0.2));
  constexpr int n = 60;
  for (int trial = 0; trial < 40; ++trial) {
    const Vec3 p{random(-0.2, 4.2), random(-0.2, 4.2), random(-0.4, 0.6)};
    for (int face = 0; face < 16; ++face) {
      const PatchPoint closest = closestPointOnPatch(surface, face, p, {0.5, 0.5});
      double brute = 1e300;
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
          brute = std::min(brute, norm(p - pointAt(surface, face, {i / double(n), j / double(n)}).point));
      const double distance = std::sqrt(closest.squaredDistance);
      if (distance > 1.0) continue;
      EXPECT_LE(distance, brute + 1e-12) << "face " << face;
      EXPECT_GE(distance, brute - 0.03);
      EXPECT_LE(norm(pointAt(surface, face, closest.parameter).point - closest.point), 1e-13);
      EXPECT_NEAR(norm(p - closest.point), distance, 1e-13);
      if (closest.edge < 0) {
        EXPECT_LE(norm(cross(p - closest.point, closest.normal())), 1e-12);
      }
    }
  }
}

TEST(SmoothSurface, TheMobilityBoundHoldsEverywhereAndIsMetAtACorner) {
  const fem::SolidMesh mesh = unitBlock();
  Random random(6);
  std::vector<double> inverseMass;
  for (std::size_t i = 0; i < mesh.X.size(); ++i) inverseMass.push_back(random(0.1, 1.0));
  for (double width : {0.0, 1.3}) {
    const SmoothSurface surface = makeSmoothSurface(carriedSkin(mesh, {"", width}));
    const double bound = largestMobility(surface, inverseMass);
    double largest = 0.0;
    std::vector<double> row(mesh.X.size());
    for (int face = 0; face < static_cast<int>(surface.control.size()); ++face)
      for (double xi : {0.0, 0.2, 0.5, 0.9, 1.0})
        for (double eta : {0.0, 0.3, 0.5, 0.7, 1.0}) {
          std::fill(row.begin(), row.end(), 0.0);
          const auto weight = patchWeights(xi, eta);
          for (std::size_t k = 0; k < 16; ++k) {
            const int c = surface.control[face][k];
            for (std::size_t i = 0; i < surface.carrier.rowColumns(c).size(); ++i)
              row[surface.carrier.rowColumns(c)[i]] += weight[k] * surface.carrier.rowWeights(c)[i];
          }
          double mobility = 0.0;
          for (std::size_t i = 0; i < row.size(); ++i) mobility += row[i] * row[i] * inverseMass[i];
          largest = std::max(largest, mobility);
        }
    EXPECT_LE(largest, bound * (1.0 + 1e-14)) << width;
    EXPECT_GE(largest, 0.8 * bound) << width;
  }
}

/// From wherever it starts, within a face's size of patches that are bent sharply: it comes to rest, at a place no
/// farther than the start, where no direction leads nearer.
TEST(SmoothSurface, TheSearchComesToRestAndNeverGoesAway) {
  const fem::SolidMesh mesh = unitBlock();
  SmoothSurface surface = makeSmoothSurface(makeSkin(mesh.X, mesh.faceSets.at("z+")));
  Random random(12);
  int near = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    if (trial % 10 == 0) placeAll(surface, random.field(mesh.X.size(), 0.5));
    const int face = trial % 16;
    const Vec3 p{random(0, 4), random(0, 4), random(-1.0, 1.5)};
    const std::array<double, 2> start{random(0, 1), random(0, 1)};
    const PatchPoint foot = closestPointOnPatch(surface, face, p, start);
    if (foot.squaredDistance > 1.0) continue;
    ++near;
    EXPECT_TRUE(foot.found) << trial;
    EXPECT_LE(std::sqrt(foot.squaredDistance), norm(p - pointAt(surface, face, start).point) + 1e-14) << trial;
    for (const auto& [dx, dy] : std::array<std::array<double, 2>, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
      const std::array<double, 2> beside{std::clamp(foot.parameter[0] + 1e-5 * dx, 0.0, 1.0),
                                         std::clamp(foot.parameter[1] + 1e-5 * dy, 0.0, 1.0)};
      EXPECT_GE(squaredNorm(p - pointAt(surface, face, beside).point), foot.squaredDistance - 1e-13) << trial;
    }
  }
  EXPECT_GT(near, 500);
}

TEST(SmoothSurface, RefusesFacesThatHaveAnEdgeTheSameWayRound) {
  const std::vector<Vec3> X{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  EXPECT_NO_THROW(makeSmoothSurface(makeSkin(X, std::vector{quad(0, 1, 2, 3), quad(1, 4, 5, 2)})));
  EXPECT_THROW(makeSmoothSurface(makeSkin(X, std::vector{quad(0, 1, 2, 3), quad(2, 5, 4, 1)})), InputError);
}

/// Three faces that meet in the middle of a hexagon.
TEST(SmoothSurface, RefusesAnIrregularMeshByFace) {
  std::vector<Vec3> X{{0, 0, 0}};
  for (int k = 0; k < 6; ++k) X.push_back({std::cos(k * std::numbers::pi / 3), std::sin(k * std::numbers::pi / 3), 0});
  const Skin skin = makeSkin(X, std::vector{quad(0, 1, 2, 3), quad(0, 3, 4, 5), quad(0, 5, 6, 1)});
  try {
    makeSmoothSurface(skin);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("face 0"), std::string::npos) << error.what();
  }
}

TEST(SmoothSurface, PatchesEndAtSharpEdgesSplitOrNot) {
  const fem::SolidMesh mesh = unitBlock();
  Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  const SmoothSurface whole = makeSmoothSurface(skin);
  splitAtSharpEdges(skin);
  const SmoothSurface split = makeSmoothSurface(skin);
  EXPECT_EQ(whole.control, split.control);
  EXPECT_EQ(whole.across, split.across);
  EXPECT_EQ(whole.X, split.X);
  int rims = 0;
  for (const auto& across : whole.across) rims += static_cast<int>(std::count(across.begin(), across.end(), -1));
  EXPECT_EQ(rims, 2 * 16 + 4 * 12);
}

Vec3 forceAt(SurfaceCoupler& seam, const Vec3& x, std::size_t nodes) {
  dem::Particles particles;
  dem::addParticle(particles, x, {}, 0.35, dem::Mass{1.0});
  const std::vector<Vec3> rest(nodes);
  seam.exchange(particles, rest, rest, *elasticLaws(1e4), 1e-3);
  return particles.f[0];
}

TEST(SmoothSurface, CoplanarFacesActAsOnePlane) {
  const fem::SolidMesh mesh = unitBlock();
  SurfaceCoupler seam(makeSmoothSurface(makeSkin(mesh.X, mesh.faceSets.at("skin"))));
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const double overlap = 0.35 * std::pow(10.0, random(-4.0, -0.5));
    Vec3 x{random(0, 4), random(0, 4), 0.35 - overlap};
    if (i % 4 == 1) x.x = std::round(x.x);
    if (i % 4 == 2) x = {std::round(x.x), std::round(x.y), x.z};
    const Vec3 force = forceAt(seam, x, mesh.X.size());
    EXPECT_LE(norm(force - Vec3{0, 0, 1e4 * overlap}), 1e-12 * 1e4 * 0.35) << x.x << " " << x.y;
  }
  EXPECT_EQ(forceAt(seam, {2.0, 2.0, 0.3501}, mesh.X.size()), Vec3{});
}

/// On a surface of curvature κ cut into faces of size h, a node lies κ h²/8 off the surface; the middle of a face lies
/// on it, as on the bilinear face.
TEST(SmoothSurface, ApproximatesWithTheStatedOffset) {
  const fem::SolidMesh mesh = unitBlock();
  SmoothSurface surface = makeSmoothSurface(makeSkin(mesh.X, mesh.faceSets.at("z+")));
  const double curvature = 0.06;
  std::vector<Vec3> u;
  for (const Vec3& X : mesh.X) u.push_back({0, 0, 0.5 * curvature * (X.x - 2.0) * (X.x - 2.0)});
  placeAll(surface, u);
  const PatchPoint foot = closestPointOnPatch(surface, 5, {2.0, 2.0, 0.0}, {0.5, 0.5});
  EXPECT_NEAR(foot.point.z, curvature / 8.0, 1e-14);
  const PatchPoint middle = pointAt(surface, 5, {0.5, 0.5});
  EXPECT_NEAR(middle.point.z, 0.5 * curvature * 0.5 * (0.0 + 1.0), 1e-14);
}

}  // namespace
}  // namespace dovetail::surface
