// How thick meshes are, and how many elements lie across.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/mesh/mesh_thickness.hpp"

namespace dovetail::fem {
namespace {

TEST(MeshThickness, CountsTheLayersOfPlates) {
  for (const ElementShape shape : {ElementShape::hex8, ElementShape::hex20, ElementShape::tet4, ElementShape::tet10})
    for (const int layers : {1, 2, 5}) {
      const SolidMesh mesh = boxOf(shape, {8, 6, layers}, {3, 0, -2}, {7, 3, -1.8});
      std::size_t across = 0;
      for (const MeshThickness& place : measureThickness(mesh)) {
        if (std::abs(place.normal.z) < 0.5) continue;
        ++across;
        EXPECT_NEAR(place.thickness, 0.2, 1e-12);
        EXPECT_NEAR(place.layers, layers, 1e-9);
        EXPECT_GT(place.length, 3.0);
        EXPECT_LE(place.length, 5.0 + 1e-9);
        EXPECT_EQ(place.shape, shape);
      }
      EXPECT_GT(across, 40U);
    }
}

TEST(MeshThickness, GoesAlongWithTurns) {
  SolidMesh mesh = boxOf(ElementShape::hex8, {20, 1, 2}, {0, 0, 0}, {10, 1, 1});
  const double c = std::cos(0.7), s = std::sin(0.7);
  for (Vec3& X : mesh.X) X = {c * X.x - s * X.z, X.y, s * X.x + c * X.z};
  const Vec3 up{-s, 0, c};
  for (const MeshThickness& place : measureThickness(mesh)) {
    if (std::abs(dot(place.normal, up)) < 0.9) continue;
    EXPECT_NEAR(place.layers, 2.0, 1e-9);
    EXPECT_GT(place.length, 5.0);
    EXPECT_LT(place.elementLength, 1.2);
  }
}

TEST(MeshThickness, HasNoneInWedges) {
  SolidMesh wedge = boxOf(ElementShape::hex8, {4, 4, 1}, {0, 0, 0}, {1, 1, 1});
  for (Vec3& X : wedge.X) X.z *= 0.1 + 0.9 * X.x;
  for (const MeshThickness& place : measureThickness(wedge)) EXPECT_LT(std::abs(place.normal.z), 0.9);
}

TEST(MeshThickness, OfCubesIsTheirEdge) {
  const SolidMesh cube = boxOf(ElementShape::tet4, {3, 3, 3}, {0, 0, 0}, {1, 1, 1});
  const auto places = measureThickness(cube, 20);
  EXPECT_GE(places.size(), 15U);
  EXPECT_LE(places.size(), 30U);
  for (const MeshThickness& place : places) {
    EXPECT_NEAR(place.thickness, 1.0, 1e-12);
    EXPECT_LT(place.length, 1.5);
  }
}

}  // namespace
}  // namespace dovetail::fem
