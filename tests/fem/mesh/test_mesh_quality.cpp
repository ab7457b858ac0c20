#include <gtest/gtest.h>

#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "face_integrals.hpp"

namespace dovetail::fem {
namespace {

SolidMesh oneTet(const std::array<Vec3, 4>& corners) {
  SolidMesh mesh;
  mesh.X.assign(corners.begin(), corners.end());
  mesh.groups.push_back({ElementShape::tet4, {0, 1, 2, 3}});
  return mesh;
}

template <class Call>
std::string messageOf(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(MeshQuality, CubesAndRegularTetrahedraAreOne) {
  for (const ElementShape shape :
       {ElementShape::hex8, ElementShape::hex20, ElementShape::hex27, ElementShape::quad4, ElementShape::quad8}) {
    const MeshQuality quality = measureQuality(boxOf(shape, {2, 1, 1}, {}, {2.0, 1.0, 1.0}));
    for (const ElementQuality& e : quality.element) {
      EXPECT_NEAR(e.scaledJacobian, 1.0, 1e-14);
      EXPECT_NEAR(e.aspect, 1.0, 1e-14);
      EXPECT_NEAR(e.volume, 1.0, 1e-14);
    }
  }
  const MeshQuality tet = measureQuality(oneTet({{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}}}));
  EXPECT_NEAR(tet.element[0].scaledJacobian, 1.0, 1e-14);
  EXPECT_NEAR(tet.element[0].aspect, 1.0, 1e-14);
  EXPECT_NEAR(tet.element[0].volume, 8.0 / 3.0, 1e-14);
}

TEST(MeshQuality, ShearedStretchedAndInvertedElementsAreMeasured) {
  const auto sheared = mappedBox(ElementShape::hex8, {1, 1, 1}, {}, {1.0, 1.0, 4.0}, [](const Vec3& X) {
    return Vec3{X.x + X.y, X.y, X.z};
  });
  const ElementQuality e = measureQuality(sheared).element[0];
  EXPECT_NEAR(e.scaledJacobian, std::sqrt(0.5), 1e-14);  // sin 45°
  EXPECT_NEAR(e.aspect, 4.0, 1e-14);
  SolidMesh inverted = boxOf(ElementShape::tet10, {2, 1, 1}, {}, {2.0, 1.0, 1.0});
  std::swap(inverted.groups[0].node[70], inverted.groups[0].node[72]);
  const MeshQuality quality = measureQuality(inverted, 3);
  ASSERT_EQ(quality.worst.size(), 3u);
  EXPECT_EQ(quality.worst[0], 7);
  EXPECT_LT(quality.element[7].scaledJacobian, 0.0);
  EXPECT_EQ(quality.shapes[0].histogram[0], 1u);
  const ElementQuality flat = measureQuality(oneTet({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}})).element[0];
  EXPECT_EQ(flat.scaledJacobian, 0.0);
  EXPECT_TRUE(std::isinf(flat.aspect));
}

TEST(MeshQuality, VolumesAreThoseInsideTheSkin) {
  for (const ElementShape shape : allCellShapes) {
    const bool plane = dimensionOf(shape) == 2;
    SolidMesh mesh = boxOf(shape, {2, 2, plane ? 1 : 2}, {}, {1.0, 1.0, 0.6});
    for (Vec3& X : mesh.X)
      X = {X.x + 0.1 * X.y * X.y, X.y + 0.2 * X.x * (plane ? X.y : X.z),
           plane ? X.z : X.z * (1.0 + 0.2 * X.x) - 0.1 * X.x * X.y};
    const MeshQuality quality = measureQuality(mesh);
    ASSERT_EQ(quality.shapes.size(), 1u);
    EXPECT_NEAR(quality.shapes[0].volume, integrateFaces(mesh, boundaryFaces(mesh)).volume, 1e-13) << name(shape);
    std::size_t counted = 0;
    for (const std::size_t count : quality.shapes[0].histogram) counted += count;
    EXPECT_EQ(counted, mesh.elementCount());
    std::ostringstream text;
    print(text, quality);
    EXPECT_NE(text.str().find(name(shape)), std::string::npos);
    EXPECT_NE(text.str().find("worst elements"), std::string::npos);
  }
}

TEST(MeshTopology, PiecesAreCountedAndNamed) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh parts[] = {boxOf(shape, {2, 1, 1}, {}, {2.0, 1.0, 1.0}),
                               boxOf(shape, {1, 1, 1}, {2.0, 1.0, 0.0}, {3.0, 2.0, 1.0})};
    EXPECT_NO_THROW(requireConnected(parts[0]));
    const SolidMesh touching = joinMeshes(parts, 1e-9);  // along an edge: a hinge
    const MeshTopology topology = analyseTopology(touching);
    ASSERT_EQ(topology.firstElement.size(), 2u);
    EXPECT_EQ(topology.firstElement[1], static_cast<int>(parts[0].elementCount()));
    EXPECT_EQ(topology.piece.back(), 1);
    const std::string text = messageOf([&] { requireConnected(touching); });
    EXPECT_NE(text.find("2 pieces"), std::string::npos);
    EXPECT_NE(text.find("elements 0, " + std::to_string(topology.firstElement[1])), std::string::npos) << text;
  }
}

TEST(MeshTopology, DuplicatesCrowdedFacesAndUnusedNodesAreFound) {
  const SolidMesh mesh = boxOf(ElementShape::tet10, {1, 1, 1}, {}, {1.0, 1.0, 1.0});
  EXPECT_NO_THROW(requireConforming(mesh));
  SolidMesh doubled = mesh;
  for (std::size_t a = 0; a < 10; ++a) doubled.groups[0].node.push_back(doubled.groups[0].node[20 + a]);
  const MeshTopology topology = analyseTopology(doubled);
  ASSERT_EQ(topology.duplicates.size(), 1u);
  EXPECT_EQ(topology.duplicates[0], std::pair(2, 6));
  EXPECT_EQ(topology.crowdedFaces.size(), 2u);
  EXPECT_NE(messageOf([&] { requireConforming(doubled); }).find("element 6"), std::string::npos);
  SolidMesh lonely = mesh;
  lonely.X.push_back({5.0, 5.0, 5.0});
  EXPECT_NE(messageOf([&] { requireConforming(lonely); }).find("node 27"), std::string::npos);
}

TEST(MeshTopology, NeighboursOfOtherOrderAreFound) {
  SolidMesh mesh = boxOf(ElementShape::hex20, {2, 1, 1}, {}, {2.0, 1.0, 1.0});
  ElementGroup& second = mesh.groups[0];
  std::vector<int> corners(second.node.begin() + 20, second.node.begin() + 28);
  second.node.resize(20);
  mesh.groups.push_back({ElementShape::hex8, corners});
  EXPECT_EQ(analyseTopology(mesh).mismatchedFaces.size(), 1u);
  EXPECT_NE(messageOf([&] { requireConforming(mesh); }).find("other mid nodes"), std::string::npos);
}

}  // namespace
}  // namespace dovetail::fem
