#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "face_integrals.hpp"

namespace dovetail::fem {
namespace {

constexpr Vec3 lower{0.1, -0.2, 0.3}, upper{1.0, 0.9, 1.0};
constexpr double boxVolume = 0.9 * 1.1 * 0.7;

bool isTet(ElementShape shape) { return shape == ElementShape::tet4 || shape == ElementShape::tet10; }
SolidMesh testBox(ElementShape shape) { return boxOf(shape, {2, 3, 1}, lower, upper); }

/// A smooth map with curved faces.
void bend(SolidMesh& mesh) {
  if (dimensionOf(mesh) == 2) {
    for (Vec3& X : mesh.X) X = {X.x + 0.1 * X.y * X.y, X.y + 0.2 * X.x * X.y, X.z};
    return;
  }
  for (Vec3& X : mesh.X) X = {X.x + 0.1 * X.y * X.y, X.y + 0.2 * X.x * X.z, X.z * (1.0 + 0.2 * X.x) - 0.1 * X.x * X.y};
}

std::string messageOf(const SolidMesh& mesh) {
  try {
    validate(mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SolidMesh, BoxesHaveTheNodesAndElementsOfTheirShape) {
  const std::map<ElementShape, std::size_t> nodes = {
      {ElementShape::hex8, 24},         {ElementShape::hex20, 24 + 16 + 18 + 12}, {ElementShape::hex27, 5 * 7 * 3},
      {ElementShape::tet4, 24},         {ElementShape::tet10, 5 * 7 * 3},         {ElementShape::quad4, 12},
      {ElementShape::quad8, 12 + 8 + 9}};
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = testBox(shape);
    EXPECT_EQ(mesh.X.size(), nodes.at(shape)) << name(shape);
    EXPECT_EQ(mesh.elementCount(), isTet(shape) ? 36u : 6u) << name(shape);
    EXPECT_EQ(messageOf(mesh), "") << name(shape);
    std::set<std::array<double, 3>> places;
    for (const Vec3& X : mesh.X) places.insert({X.x, X.y, X.z});
    EXPECT_EQ(places.size(), mesh.X.size()) << name(shape) << ": a node occurs twice";
    const std::set<int> used(mesh.groups[0].node.begin(), mesh.groups[0].node.end());
    EXPECT_EQ(used.size(), mesh.X.size()) << name(shape) << ": a node is not used";
  }
}

TEST(SolidMesh, MidNodesLieBetweenTheirCorners) {
  for (const ElementShape shape : allCellShapes) {
    if (nodesOf(shape) == cornersOf(shape)) continue;
    const SolidMesh mesh = testBox(shape);
    const ElementGroup& group = mesh.groups[0];
    for (std::size_t e = 0; e < group.size(); ++e) {
      const auto X = [&](std::size_t a) {
        return mesh.X[static_cast<std::size_t>(group.node[e * static_cast<std::size_t>(nodesOf(shape)) + a])];
      };
      const auto edges = edgesOf(shape);
      for (std::size_t k = 0; k < edges.size(); ++k) {
        const Vec3 middle = 0.5 * (X(static_cast<std::size_t>(edges[k][0])) + X(static_cast<std::size_t>(edges[k][1])));
        EXPECT_LT(norm(X(static_cast<std::size_t>(cornersOf(shape)) + k) - middle), 1e-15) << name(shape);
      }
    }
    for (const Face& face : boundaryFaces(mesh))
      if (face.shape == FaceShape::quad9) {
        Vec3 centre;
        for (std::size_t k = 0; k < 4; ++k) centre += 0.25 * mesh.X[static_cast<std::size_t>(face.node[k])];
        EXPECT_LT(norm(mesh.X[static_cast<std::size_t>(face.node[8])] - centre), 1e-15);
      }
  }
}

TEST(SolidMesh, FacesPointOutwardAndCloseTheBody) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = testBox(shape);
    const std::vector<Face> boundary = boundaryFaces(mesh);
    const bool plane = dimensionOf(shape) == 2;
    EXPECT_EQ(boundary.size(), plane ? 2u * (2u + 3u) : (isTet(shape) ? 2u : 1u) * 2u * (6u + 3u + 2u)) << name(shape);
    EXPECT_EQ(faceSet(mesh, "skin").size(), boundary.size());
    const FaceIntegrals all = integrateFaces(mesh, boundary);
    EXPECT_LT(norm(all.area), 1e-15) << name(shape);
    EXPECT_NEAR(all.volume, boxVolume, 1e-14) << name(shape);
    const std::map<std::string, Vec3> sides = {{"x-", {-0.77, 0, 0}}, {"x+", {0.77, 0, 0}},  {"y-", {0, -0.63, 0}},
                                               {"y+", {0, 0.63, 0}},  {"z-", {0, 0, -0.99}}, {"z+", {0, 0, 0.99}}};
    EXPECT_EQ(mesh.faceSets.size(), plane ? 5u : 7u);
    for (const auto& [side, area] : sides)
      if (!plane || side[0] != 'z') {
        EXPECT_LT(norm(integrateFaces(mesh, faceSet(mesh, side)).area - area), 1e-14) << name(shape) << side;
      }
  }
}

TEST(SolidMesh, EveryFaceOfEveryElementPointsOutOfIt) {
  for (const ElementShape shape : allCellShapes) {
    SolidMesh mesh = testBox(shape);
    bend(mesh);
    ASSERT_EQ(messageOf(mesh), "") << name(shape);
    const ElementGroup& group = mesh.groups[0];
    double sum = 0.0;
    for (std::size_t e = 0; e < group.size(); ++e) {
      std::vector<Face> faces;
      for (std::size_t side = 0; side < localFacesOf(shape).size(); ++side) faces.push_back(faceOf(group, e, side));
      const FaceIntegrals own = integrateFaces(mesh, faces);
      EXPECT_LT(norm(own.area), 1e-15) << name(shape) << " element " << e;
      EXPECT_GT(own.volume, 0.0) << name(shape) << " element " << e;
      sum += own.volume;
      Vec3 centre;
      const auto n = static_cast<std::size_t>(nodesOf(shape));
      for (std::size_t a = 0; a < n; ++a)
        centre += mesh.X[static_cast<std::size_t>(group.node[e * n + a])] / static_cast<double>(n);
      for (const Face& face : faces)
        EXPECT_GT(dot(integrateFaces(mesh, {face}).area, mesh.X[static_cast<std::size_t>(face.node[0])] - centre), 0.0)
            << name(shape) << " element " << e;
    }
    EXPECT_NEAR(integrateFaces(mesh, boundaryFaces(mesh)).volume, sum, 1e-14) << name(shape);
  }
}

TEST(SolidMesh, NodeSetsAreTheNodesOfTheirSides) {
  for (const ElementShape shape : allCellShapes) {
    const int dimension = dimensionOf(shape);
    const SolidMesh mesh = boxOf(shape, {2, 3, dimension == 2 ? 1 : 4}, lower, upper);
    std::set<int> all;
    EXPECT_EQ(mesh.nodeSets.size(), 2u * static_cast<unsigned>(dimension) + 1u) << name(shape);
    for (int side = 0; side < 2 * dimension; ++side) {
      const int axis = side / 2;
      const double value = side % 2 ? upper[axis] : lower[axis];
      std::vector<int> expected;
      for (std::size_t n = 0; n < mesh.X.size(); ++n)
        if (mesh.X[n][axis] == value) expected.push_back(static_cast<int>(n));
      all.insert(expected.begin(), expected.end());
      EXPECT_EQ(nodeSet(mesh, std::string(1, "xyz"[axis]) + "-+"[side % 2]), expected) << name(shape) << side;
    }
    EXPECT_EQ(nodeSet(mesh, "skin"), std::vector<int>(all.begin(), all.end())) << name(shape);
  }
  EXPECT_EQ(nodeSet(boxOf(ElementShape::hex8, {2, 3, 4}, lower, upper), "skin").size(), 60u - 1u * 2u * 3u);
}

TEST(SolidMesh, UnknownSetsListTheKnownOnes) {
  SolidMesh mesh = testBox(ElementShape::tet4);
  mesh.elementSets["matrix"] = {0, 1};
  EXPECT_EQ(elementSet(mesh, "matrix").size(), 2u);
  for (const auto& ask : std::vector<std::function<void()>>{
           [&] { nodeSet(mesh, "top"); }, [&] { faceSet(mesh, "top"); }, [&] { elementSet(mesh, "top"); }}) {
    try {
      ask();
      FAIL();
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_TRUE(text.find("\"z+\"") != std::string::npos || text.find("\"matrix\"") != std::string::npos) << text;
    }
  }
}

TEST(SolidMesh, BadBoxesAreRefused) {
  EXPECT_THROW(boxOf(ElementShape::tet10, {0, 1, 1}, {}, {1.0, 1.0, 1.0}), InputError);
  EXPECT_THROW(boxOf(ElementShape::quad4, {1, 1, 2}, {}, {1.0, 1.0, 1.0}), InputError);
  EXPECT_THROW(boxOf(ElementShape::quad4, {1, 1, 1}, {}, {1.0, 1.0, 0.0}), InputError);
  EXPECT_THROW(boxOf(ElementShape::hex8, {1, 1, 1}, {}, {1.0, 0.0, 1.0}), InputError);
  EXPECT_THROW(boxOf(ElementShape::hex27, {1, 1, 1}, {}, {1.0, std::numeric_limits<double>::quiet_NaN(), 1.0}),
               InputError);
}

TEST(SolidMesh, BadElementsAreRefusedByNumber) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = testBox(shape);
    const auto n = static_cast<std::size_t>(nodesOf(shape));
    SolidMesh inverted = mesh;
    std::swap(inverted.groups[0].node[n], inverted.groups[0].node[n + 2]);
    EXPECT_NE(messageOf(inverted).find("[element 1]"), std::string::npos) << messageOf(inverted);
    SolidMesh flat = mesh;
    for (Vec3& X : flat.X) (dimensionOf(shape) == 2 ? X.y : X.z) = 0.0;
    const std::string all = !isTet(shape) ? "[elements 0, 1, 2, 3, 4, 5]" : "8, 9 and 26 more]";
    EXPECT_NE(messageOf(flat).find(all), std::string::npos) << messageOf(flat);
    SolidMesh wrongNode = mesh;
    wrongNode.groups[0].node[2 * n + 1] = 999;
    EXPECT_NE(messageOf(wrongNode).find("node 999 does not exist [element 2]"), std::string::npos);
    SolidMesh twice = mesh;
    twice.groups[0].node[2 * n + 1] = twice.groups[0].node[2 * n + 3];
    EXPECT_NE(messageOf(twice).find("occurs twice in it [element 2]"), std::string::npos) << messageOf(twice);
    SolidMesh part = mesh;
    part.groups[0].node.pop_back();
    EXPECT_NE(messageOf(part).find(name(shape)), std::string::npos) << messageOf(part);
    SolidMesh notFinite = mesh;
    notFinite.X[3].y = std::numeric_limits<double>::infinity();
    EXPECT_NE(messageOf(notFinite).find("node 3"), std::string::npos);
    SolidMesh huge = mesh;
    for (Vec3& X : huge.X) X *= 1e200;
    EXPECT_NE(messageOf(huge), "");
  }
  EXPECT_NE(messageOf(SolidMesh{}), "");
}

TEST(SolidMesh, MidNodesOutOfPlaceAreFound) {
  for (const ElementShape shape :
       {ElementShape::hex20, ElementShape::hex27, ElementShape::tet10, ElementShape::quad8}) {
    SolidMesh mesh = boxOf(shape, {1, 1, 1}, {}, {1.0, 1.0, 1.0});
    const ElementGroup& group = mesh.groups[0];
    const int mid = group.node[static_cast<std::size_t>(cornersOf(shape))], end = group.node[1];
    mesh.X[static_cast<std::size_t>(mid)] += 0.3 * (mesh.X[static_cast<std::size_t>(end)] - mesh.X[0]);
    EXPECT_NE(messageOf(mesh).find("element"), std::string::npos) << name(shape);
  }
}

TEST(SolidMesh, BadSetsAreRefusedByName) {
  SolidMesh mesh = testBox(ElementShape::hex20);
  mesh.nodeSets["mine"] = {-1};
  EXPECT_NE(messageOf(mesh).find("\"mine\""), std::string::npos);
  mesh.nodeSets["mine"] = {4, 3};
  EXPECT_NE(messageOf(mesh).find("\"mine\""), std::string::npos);
  mesh.nodeSets["mine"] = {3, 4};
  EXPECT_EQ(messageOf(mesh), "");
  mesh.elementSets["grains"] = {0, 6};
  EXPECT_NE(messageOf(mesh).find("\"grains\""), std::string::npos);
  mesh.elementSets["grains"] = {2, 2};
  EXPECT_NE(messageOf(mesh).find("\"grains\""), std::string::npos);
  mesh.elementSets["grains"] = {2, 5};
  EXPECT_EQ(messageOf(mesh), "");
  mesh.faceSets["x-"][0].node[7] = -1;
  EXPECT_NE(messageOf(mesh).find("\"x-\""), std::string::npos);
}

TEST(SolidMesh, PlaneStrainLiesInOnePlaneWithAThicknessAndAlone) {
  const SolidMesh plane = testBox(ElementShape::quad8);
  EXPECT_EQ(plane.thickness, upper.z - lower.z);
  for (const Vec3& X : plane.X) EXPECT_EQ(X.z, lower.z);
  SolidMesh crooked = plane;
  crooked.X[7].z += 1e-6;
  EXPECT_NE(messageOf(crooked).find("[node 7]"), std::string::npos) << messageOf(crooked);
  EXPECT_NE(messageOf(crooked).find("one plane z = const"), std::string::npos) << messageOf(crooked);
  for (const double thickness : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    SolidMesh thin = plane;
    thin.thickness = thickness;
    EXPECT_NE(messageOf(thin).find("thickness"), std::string::npos);
  }
  SolidMesh thick = testBox(ElementShape::hex8);
  thick.thickness = 2.0;
  EXPECT_NE(messageOf(thick).find("three dimensions"), std::string::npos) << messageOf(thick);
  SolidMesh mixed = testBox(ElementShape::hex8);
  mixed.groups.push_back({ElementShape::quad4, {0, 1, 4, 3}});
  EXPECT_NE(messageOf(mixed).find("hex8 and quad4"), std::string::npos) << messageOf(mixed);
}

}  // namespace
}  // namespace dovetail::fem
