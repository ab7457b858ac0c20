#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "dovetail/core/error.hpp"
#include "dovetail/geometry/triangle.hpp"
#include "scenes.hpp"

namespace dovetail::surface {
namespace {

Vec3 areaVector(const Skin& skin, std::size_t facet) {
  const auto& t = skin.wall.facets[facet];
  return 0.5 * geometry::triangleAreaNormal(skin.X[t[0]], skin.X[t[1]], skin.X[t[2]]);
}

double area(const Skin& skin) {
  double sum = 0.0;
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) sum += norm(areaVector(skin, t));
  return sum;
}

TEST(SkinInput, RefusesASharpAngleThatIsNone) {
  const fem::SolidMesh mesh = unitBlock();
  for (const double bad : {0.0, -1.0, 4.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(makeSkin(mesh.X, mesh.faceSets.at("skin"), QuadSplit::four, bad), InputError) << bad;
}

class SkinSplit : public ::testing::TestWithParam<QuadSplit> {};

TEST_P(SkinSplit, OfABoxIsClosedAndPointsOutwards) {
  const fem::SolidMesh mesh = unitBlock();
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"), GetParam());
  const std::size_t faces = 16 + 16 + 4 * 8, perFace = GetParam() == QuadSplit::four ? 4 : 2;
  EXPECT_EQ(skin.wall.facets.size(), faces * perFace);
  EXPECT_EQ(skin.X.size(), 66 + (perFace == 4 ? faces : 0));
  EXPECT_TRUE(skin.wall.oneSided);
  EXPECT_NEAR(area(skin), 64.0, 1e-12);
  Vec3 closed;
  double volume = 0.0;
  const Vec3 middle{2, 2, -1};
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) {
    const Vec3 outward = areaVector(skin, t);
    closed += outward;
    volume += dot(outward, skin.X[skin.wall.facets[t][0]]) / 3.0;
    EXPECT_GT(dot(outward, skin.X[skin.wall.facets[t][0]] - middle), 0.0) << "facet " << t;
  }
  EXPECT_LE(norm(closed), 1e-12);
  EXPECT_NEAR(volume, 32.0, 1e-12);
}

TEST_P(SkinSplit, LocalMapReproducesPositionsAndConstants) {
  fem::SolidMesh mesh = unitBlock();
  Random random(1);
  for (Vec3& X : mesh.X) X += random.vector(0.1);
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"), GetParam());
  cg::requireValid(skin.localMap);
  EXPECT_LE(cg::rowSumError(skin.localMap), 1e-15);
  std::vector<Vec3> mapped(skin.X.size());
  cg::apply(skin.localMap, mesh.X, mapped);
  for (std::size_t v = 0; v < mapped.size(); ++v) EXPECT_LE(norm(mapped[v] - skin.X[v]), 1e-15) << "vertex " << v;
  EXPECT_EQ(skin.carrier.column, skin.localMap.column);
  EXPECT_EQ(skin.carrier.weight, skin.localMap.weight);
}

TEST_P(SkinSplit, OfAnOpenFaceSetIsTwoSided) {
  const fem::SolidMesh mesh = unitBlock();
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("z+"), GetParam());
  EXPECT_FALSE(skin.wall.oneSided);
  EXPECT_NEAR(area(skin), 16.0, 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Skin, SkinSplit, ::testing::Values(QuadSplit::two, QuadSplit::four));

TEST(Skin, SharpEdgesSplitTheBoxIntoSixPatchesWithTheirOwnVertices) {
  const fem::SolidMesh mesh = unitBlock();
  Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  const Skin whole = skin;
  splitAtSharpEdges(skin);
  EXPECT_EQ(skin.X.size(), 2 * (25 + 16) + 4 * (15 + 8));
  EXPECT_NEAR(area(skin), 64.0, 1e-12);
  std::vector<int> patchOfVertex(skin.X.size(), -1);
  std::set<int> patches;
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) {
    patches.insert(skin.patchOfFacet[t]);
    EXPECT_EQ(norm(areaVector(skin, t) - areaVector(whole, t)), 0.0);
    for (int vertex : skin.wall.facets[t]) {
      if (patchOfVertex[vertex] < 0) patchOfVertex[vertex] = skin.patchOfFacet[t];
      EXPECT_EQ(patchOfVertex[vertex], skin.patchOfFacet[t]);
    }
  }
  EXPECT_EQ(patches.size(), 6u);
  std::vector<Vec3> mapped(skin.X.size());
  cg::apply(skin.localMap, mesh.X, mapped);
  for (std::size_t v = 0; v < mapped.size(); ++v) EXPECT_LE(norm(mapped[v] - skin.X[v]), 1e-15);
  const auto facets = skin.wall.facets;
  splitAtSharpEdges(skin);
  EXPECT_EQ(skin.wall.facets, facets) << "a second split changes nothing";
}

/// Two unit squares that share an edge, the second turned up by `angle`.
std::vector<Vec3> fold(double angle) {
  return {{0, 0, 0},
          {1, 0, 0},
          {1, 1, 0},
          {0, 1, 0},
          {1 + std::cos(angle), 0, std::sin(angle)},
          {1 + std::cos(angle), 1, std::sin(angle)}};
}
const std::vector<fem::Face> foldFaces{quad(0, 1, 2, 3), quad(1, 4, 5, 2)};

TEST(Skin, AnEdgeIsSharpBeyondTheSharpAngle) {
  const double degree = std::numbers::pi / 180.0;
  for (double sign : {-1.0, 1.0}) {
    Skin blunt = makeSkin(fold(sign * 59.9 * degree), foldFaces),
         sharp = makeSkin(fold(sign * 60.1 * degree), foldFaces);
    splitAtSharpEdges(blunt);
    splitAtSharpEdges(sharp);
    EXPECT_EQ(blunt.X.size(), 8u);
    EXPECT_EQ(sharp.X.size(), 10u);
  }
  Skin asked = makeSkin(fold(20.0 * degree), foldFaces, QuadSplit::two, 19.0 * degree);
  splitAtSharpEdges(asked);
  EXPECT_EQ(asked.X.size(), 8u);
}

TEST(Skin, PlacesVerticesByTheCarrier) {
  const fem::SolidMesh mesh = unitBlock();
  Skin skin = carriedSkin(mesh, {"lucy", 1.3});
  Random random(2);
  const auto u = random.field(mesh.X.size(), 0.1), v = random.field(mesh.X.size(), 2.0);
  place(skin, u, v);
  const Skin all = skin;
  const std::vector<int> some{3, 17, 40};
  place(skin, std::vector<Vec3>(u.size()), std::vector<Vec3>(u.size()));
  place(skin, u, v, some);
  for (int vertex : some) {
    EXPECT_EQ(skin.wall.x[vertex], all.wall.x[vertex]);
    EXPECT_EQ(skin.wall.v[vertex], all.wall.v[vertex]);
    Vec3 x = skin.X[vertex], speed;
    skin.offsets.carry(static_cast<std::size_t>(vertex), x, speed);
    for (std::size_t k = 0; k < skin.carrier.rowColumns(vertex).size(); ++k) {
      x += skin.carrier.rowWeights(vertex)[k] * u[skin.carrier.rowColumns(vertex)[k]];
      speed += skin.carrier.rowWeights(vertex)[k] * v[skin.carrier.rowColumns(vertex)[k]];
    }
    EXPECT_LE(norm(x - skin.wall.x[vertex]), 2e-15);
    EXPECT_LE(norm(speed - skin.wall.v[vertex]), 2e-14);
  }
  EXPECT_EQ(skin.wall.x[4], skin.X[4]);
}

TEST(Skin, CarrierGainBoundsTheMotionOfVertices) {
  const fem::SolidMesh mesh = unitBlock();
  EXPECT_NEAR(carrierGain(carriedSkin(mesh, {"local"}).carrier, {}), 1.0, 1e-15);
  EXPECT_NEAR(carrierGain(carriedSkin(mesh, {"lucy", 1.3}).carrier, {}), 1.0, 1e-14);
  const Skin linear = carriedSkin(mesh, {"linear", 3.0, cg::KernelShape::lucy, cg::KernelCorrection::linear});
  double largest = 0.0;
  for (int row = 0; row < linear.carrier.rows(); ++row) {
    double sum = 0.0;  // of the vertex, were every node to move by the sign of its weight
    for (double w : linear.carrier.rowWeights(row)) sum += w * (w < 0.0 ? -1.0 : 1.0);
    largest = std::max(largest, sum);
  }
  EXPECT_GT(largest, 1.1);
  EXPECT_NEAR(carrierGain(linear.carrier, linear.offsets), largest, 1e-14);
}

/// Nodes that move by less than one move no vertex by more than the gain.
TEST(Skin, CarrierGainBoundsWhatTurnsOfPatchesAdd) {
  const fem::SolidMesh mesh = unitBlock();
  Random random(11);
  for (const Variant& variant : flatVariants()) {
    Skin skin = carriedSkin(mesh, variant);
    const double gain = carrierGain(skin.carrier, skin.offsets);
    const std::vector<Vec3> rest(mesh.X.size());
    for (int trial = 0; trial < 20; ++trial) {
      const Vec3 spin = random.vector(1.0);
      std::vector<Vec3> u;
      double largest = 0.0, moved = 0.0;
      for (const Vec3& X : mesh.X) {
        u.push_back(0.02 * (cross(spin, X - Vec3{2, 2, -1}) + random.vector(trial % 2)));
        largest = std::max(largest, norm(u.back()));
      }
      place(skin, u, rest);
      for (std::size_t v = 0; v < skin.X.size(); ++v) moved = std::max(moved, norm(skin.wall.x[v] - skin.X[v]));
      EXPECT_LE(moved, (1.0 + 1e-13) * gain * largest) << variant.name;
    }
  }
}

std::string refusal(const std::vector<Vec3>& X, const std::vector<fem::Face>& faces) {
  try {
    makeSkin(X, faces);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Skin, RefusesBadFacesByName) {
  const auto X = fold(0.1);
  EXPECT_NE(refusal(X, {}).find("no faces"), std::string::npos);
  for (const fem::Face& bad :
       {quad(1, 4, 6, 2), quad(1, 4, -1, 2), quad(1, 4, 4, 2), quad(1, 4, 5, 1), quad(2, 2, 2, 2)})
    EXPECT_NE(refusal(X, {foldFaces[0], bad}).find("face 1"), std::string::npos) << refusal(X, {foldFaces[0], bad});
  auto flat = X;
  for (int k : {1, 4, 5, 2}) flat[k] = {0.1 * k, 0.3 * k, 0.7 * k};
  EXPECT_NE(refusal(flat, {quad(1, 4, 5, 2)}).find("face 0"), std::string::npos) << refusal(flat, {quad(1, 4, 5, 2)});
  auto poisoned = X;
  poisoned[4].y = std::nan("");
  EXPECT_NE(refusal(poisoned, foldFaces).find("face 1"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::surface
