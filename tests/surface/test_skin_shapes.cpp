// Skins of elements of all shapes, and contact with them.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/shape.hpp"
#include "scenes.hpp"

namespace dovetail::surface {
namespace {

using fem::ElementShape;

class SkinOf : public ::testing::TestWithParam<ElementShape> {};
struct ShapeName {
  template <class Info>
  std::string operator()(const Info& info) const {
    return fem::name(info.param);
  }
};
INSTANTIATE_TEST_SUITE_P(Shapes, SkinOf,
                         ::testing::Values(ElementShape::hex8, ElementShape::hex20, ElementShape::hex27,
                                           ElementShape::tet4, ElementShape::tet10),
                         ShapeName{});

fem::SolidMesh block(ElementShape shape) { return fem::boxOf(shape, {4, 4, 2}, {0, 0, -2}, {4, 4, 0}); }

/// All nodes moved at random, so that faces are curved.
fem::SolidMesh crooked(ElementShape shape, double amplitude, unsigned seed) {
  fem::SolidMesh mesh = block(shape);
  Random random(seed);
  for (Vec3& X : mesh.X) X += random.vector(amplitude);
  return mesh;
}

struct Enclosed {
  Vec3 area;  // Σ of outward areas
  double volume = 0.0;
};
Enclosed enclosed(const Skin& skin) {
  Enclosed sum;
  for (const auto& [a, b, c] : skin.wall.facets) {
    const Vec3 outward = 0.5 * cross(skin.X[b] - skin.X[a], skin.X[c] - skin.X[a]);
    sum.area += outward;
    sum.volume += dot(outward, skin.X[a]) / 3.0;
  }
  return sum;
}

TEST_P(SkinOf, ABoxIsClosed) {
  const fem::SolidMesh mesh = block(GetParam());
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  EXPECT_TRUE(skin.wall.oneSided);
  EXPECT_LT(norm(enclosed(skin).area), 1e-12);
  EXPECT_NEAR(enclosed(skin).volume, 32.0, 1e-12);
  const Vec3 middle{2, 2, -1};
  double area = 0.0;
  for (const auto& [a, b, c] : skin.wall.facets) {
    const Vec3 outward = cross(skin.X[b] - skin.X[a], skin.X[c] - skin.X[a]);
    EXPECT_GT(dot(outward, skin.X[a] - middle), 0.0);
    area += 0.5 * norm(outward);
  }
  EXPECT_NEAR(area, 64.0, 1e-12);
  const std::size_t quads = 64;
  const std::size_t perSquare = GetParam() == ElementShape::tet4 ? 2 : GetParam() == ElementShape::hex8 ? 4 : 8;
  EXPECT_EQ(skin.wall.facets.size(), quads * perSquare);
  EXPECT_EQ(skin.faces.size(), mesh.faceSets.at("skin").size());
}

TEST_P(SkinOf, ACrookedBoxIsClosed) {
  const fem::SolidMesh mesh = crooked(GetParam(), 0.08, 1);
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  EXPECT_TRUE(skin.wall.oneSided);
  EXPECT_LT(norm(enclosed(skin).area), 1e-12);
  EXPECT_NEAR(enclosed(skin).volume, 32.0, 2.0);
}

TEST_P(SkinOf, RowsSumToOneAndReproduceLinearFields) {
  const fem::SolidMesh mesh = crooked(GetParam(), 0.08, 2);
  Random random(3);
  const std::array<Vec3, 4> affine{random.vector(1), random.vector(1), random.vector(1), random.vector(1)};
  const auto field = [&](const Vec3& X) { return affine[0] + X.x * affine[1] + X.y * affine[2] + X.z * affine[3]; };
  std::vector<Vec3> values;
  for (const Vec3& X : mesh.X) values.push_back(field(X));
  Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  for (int pass = 0; pass < 2; ++pass, splitAtSharpEdges(skin)) {
    cg::requireValid(skin.localMap);
    EXPECT_LE(cg::rowSumError(skin.localMap), 1e-15);
    std::vector<Vec3> mapped(skin.X.size());
    cg::apply(skin.localMap, values, mapped);
    for (std::size_t v = 0; v < mapped.size(); ++v) EXPECT_LE(norm(mapped[v] - field(skin.X[v])), 2e-14);
  }
}

/// Vertices in the middle of faces of eight nodes are where the face itself has its middle.
TEST_P(SkinOf, VerticesLieOnTheFaces) {
  const fem::SolidMesh mesh = crooked(GetParam(), 0.08, 4);
  const Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t) {
    const fem::Face& face = skin.faces[static_cast<std::size_t>(skin.facetFace[t])];
    const int nodes = fem::nodesOf(face.shape);
    Vec3 centre;
    const std::vector<double> shape = fem::shapeRow(face.shape, 0.0, 0.0);
    for (int a = 0; a < nodes; ++a) centre += shape[static_cast<std::size_t>(a)] * skin.X[face.node[a]];
    for (int v : skin.wall.facets[t]) {
      const bool isNode = std::find(face.node.begin(), face.node.begin() + nodes, v) != face.node.begin() + nodes;
      EXPECT_TRUE(isNode || norm(skin.X[v] - centre) < 1e-14);
    }
  }
}

/// Split copies stay with their patches; a box has six.
TEST_P(SkinOf, SharpEdgesSplitTheBoxIntoSixPatches) {
  const fem::SolidMesh mesh = block(GetParam());
  Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
  const std::size_t before = skin.X.size();
  splitAtSharpEdges(skin);
  EXPECT_EQ(*std::max_element(skin.patchOfFacet.begin(), skin.patchOfFacet.end()), 5);
  const bool second = GetParam() != ElementShape::hex8 && GetParam() != ElementShape::tet4;
  // each vertex of an edge is doubled, of a corner trebled
  const std::size_t onEdges = second ? 8 * 7 + 4 * 3 : 8 * 3 + 4 * 1;
  EXPECT_EQ(skin.X.size(), before + onEdges + 2 * 8);
  for (std::size_t t = 0; t < skin.wall.facets.size(); ++t)
    for (int v : skin.wall.facets[t]) {
      const fem::Face& face = skin.faces[static_cast<std::size_t>(skin.facetFace[t])];
      const int nodes = fem::nodesOf(face.shape);
      double nearest = INFINITY;
      for (int a = 0; a < nodes; ++a) nearest = std::min(nearest, norm(skin.X[face.node[a]] - skin.X[v]));
      EXPECT_LT(nearest, 0.8);
    }
}

TEST_P(SkinOf, KernelsGiveRowsThatSumToOne) {
  const fem::SolidMesh mesh = crooked(GetParam(), 0.02, 5);
  for (const auto correction :
       {cg::KernelCorrection::none, cg::KernelCorrection::linear, cg::KernelCorrection::symmetric}) {
    Skin skin = makeSkin(mesh.X, mesh.faceSets.at("skin"));
    coarseGrain(skin, {{cg::KernelShape::lucy, 2, 1.3}, correction});
    EXPECT_LE(cg::rowSumError(skin.carrier), 1e-12) << static_cast<int>(correction);
    if (correction != cg::KernelCorrection::linear) continue;
    std::vector<Vec3> mapped(skin.X.size());
    cg::apply(skin.carrier, mesh.X, mapped);
    for (std::size_t v = 0; v < mapped.size(); ++v) EXPECT_LE(norm(mapped[v] - skin.X[v]), 1e-11);
  }
}

const auto laws = elasticLaws(1e4);

struct Answer {
  double energy;
  Vec3 onParticle;
  std::vector<Vec3> onNodes;
};

/// A particle of radius 0.35 pressed into the top of the skin.
class Press {
public:
  Press(ElementShape shape, unsigned seed)
      : mesh(crooked(shape, 0.04, seed)), seam_(makeSkin(mesh.X, mesh.faceSets.at("skin"))) {
    Random random(seed + 100);
    u = random.field(mesh.X.size(), 0.03);
    v = random.field(mesh.X.size(), 1.0);
    dem::addParticle(particles, {random(0.6, 3.4), random(0.6, 3.4), 0.28}, {}, 0.35, dem::Mass{1.0});
  }
  Answer at(const Vec3& x, std::span<const Vec3> displacement) {
    dem::Particles moved = particles;
    moved.x[0] = x;
    dem::clearForces(moved);
    const double energy = seam_.exchange(moved, displacement, v, *laws, 1e-3).storedEnergy();
    return {energy, moved.f[0], seam_.load().force};
  }
  const SurfaceCoupler& seam() const { return seam_; }

  fem::SolidMesh mesh;
  std::vector<Vec3> u, v;
  dem::Particles particles;

private:
  SurfaceCoupler seam_;
};

/// Forces of one potential, in balance with their moments, whose power on the skin is that on the nodes.
TEST_P(SkinOf, ContactConserves) {
  int touching = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Press press(GetParam(), seed);
    const Vec3 x = press.particles.x[0];
    const Answer answer = press.at(x, press.u);
    if (!(answer.energy > 0.0)) continue;
    ++touching;
    const double size = norm(answer.onParticle);
    Vec3 force = answer.onParticle, moment = cross(x, answer.onParticle);
    for (std::size_t n = 0; n < press.u.size(); ++n) {
      force += answer.onNodes[n];
      moment += cross(press.mesh.X[n] + press.u[n], answer.onNodes[n]);
    }
    EXPECT_LT(norm(force), 1e-13 * size);
    EXPECT_LT(norm(moment), 1e-12 * size);

    double onSkin = 0.0, onNodes = 0.0;
    const dem::WallContacts& contacts = press.seam().contacts();
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (int k = 0; k < 3; ++k)
        onSkin -=
            contacts.weight[c][k] *
            dot(contacts.force[c], press.seam().skin().wall.v[press.seam().skin().wall.facets[contacts.facet[c]][k]]);
    for (std::size_t n = 0; n < press.v.size(); ++n) onNodes += dot(answer.onNodes[n], press.v[n]);
    EXPECT_NEAR(onSkin, onNodes, 1e-12 * size);

    Random random(seed + 200);
    for (int k = 0; k < 3; ++k) {
      const Vec3 dx = k == 1 ? Vec3{} : random.vector(1.0);
      const std::vector<Vec3> du = random.field(press.u.size(), k == 0 ? 0.0 : 1.0);
      const double h = 1e-7;
      const auto energyAt = [&](double s) {
        std::vector<Vec3> displaced = press.u;
        for (std::size_t n = 0; n < du.size(); ++n) displaced[n] += s * du[n];
        return press.at(x + s * dx, displaced).energy;
      };
      double work = dot(answer.onParticle, dx);
      for (std::size_t n = 0; n < du.size(); ++n) work += dot(answer.onNodes[n], du[n]);
      EXPECT_NEAR((energyAt(h) - energyAt(-h)) / (2.0 * h), -work, 1e-5 * size) << seed;
    }
  }
  EXPECT_GE(touching, 15);
}

TEST(SkinShapes, OnlyFacesOfFourNodesHaveASmoothSurfaceOrSpreadLoads) {
  for (const ElementShape shape : {ElementShape::hex20, ElementShape::hex27, ElementShape::tet4, ElementShape::tet10}) {
    const fem::SolidMesh mesh = block(shape);
    const std::vector<fem::Face>& faces = mesh.faceSets.at("skin");
    const Skin skin = makeSkin(mesh.X, faces);
    const auto refusal = [&](auto&& make) -> std::string {
      try {
        make();
      } catch (const InputError& error) {
        return error.what();
      }
      return "accepted";
    };
    EXPECT_NE(refusal([&] { makeSmoothSurface(skin); }).find("smooth surface"), std::string::npos);
    EXPECT_NE(refusal([&] {
                SpreadLoad({{cg::KernelShape::lucy, 2, 1.0}, {}}, mesh.X, skin, faces);
              }).find("SpreadLoad"),
              std::string::npos);
  }
}

TEST(SkinShapes, LinesOfPlaneMeshesAreRefused) {
  for (const ElementShape shape : {ElementShape::quad4, ElementShape::quad8}) {
    const fem::SolidMesh mesh = fem::boxOf(shape, {2, 2, 1}, {0, 0, 0}, {1, 1, 1});
    const std::vector<fem::Face>& faces = mesh.faceSets.at("skin");
    try {
      makeSkin(mesh.X, faces);
      FAIL() << fem::name(shape);
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(fem::name(faces[0].shape)), std::string::npos) << text;
      EXPECT_NE(text.find("plane mesh"), std::string::npos) << text;
    }
  }
}

TEST(SkinShapes, BadFacesAreNamed) {
  const fem::SolidMesh mesh = block(ElementShape::tet10);
  std::vector<fem::Face> faces = mesh.faceSets.at("skin");
  faces[3].node[4] = faces[3].node[0];
  EXPECT_THROW(makeSkin(mesh.X, faces), InputError);
  faces = mesh.faceSets.at("skin");
  std::vector<Vec3> X = mesh.X;
  X[static_cast<std::size_t>(faces[2].node[5])].x = NAN;
  EXPECT_THROW(makeSkin(X, faces), InputError);
  X = mesh.X;
  X[static_cast<std::size_t>(faces[2].node[2])] =
      0.5 * (X[static_cast<std::size_t>(faces[2].node[0])] + X[static_cast<std::size_t>(faces[2].node[1])]);
  EXPECT_THROW(makeSkin(X, faces), InputError);
}

}  // namespace
}  // namespace dovetail::surface
