#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/cell_topology.hpp"
#include "dovetail/fem/mesh/mesh_places.hpp"
#include "dovetail/fem/mesh/mesh_quality.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "face_integrals.hpp"

namespace dovetail::fem {
namespace {

const ElementShape bricks[] = {ElementShape::hex8, ElementShape::hex20, ElementShape::hex27, ElementShape::quad4,
                               ElementShape::quad8};
bool isTet(ElementShape shape) { return shape == ElementShape::tet4 || shape == ElementShape::tet10; }
/// One layer if the cells are plane.
std::array<int, 3> layered(ElementShape shape, std::array<int, 3> cells) {
  if (dimensionOf(shape) == 2) cells[2] = 1;
  return cells;
}
bool isSecondOrder(ElementShape shape) { return nodesOf(shape) > cornersOf(shape); }

double volumeOf(const SolidMesh& mesh) { return measureQuality(mesh).shapes.at(0).volume; }

/// Sound in every respect; the skin is the boundary.
void expectSound(const SolidMesh& mesh, const std::string& what) {
  EXPECT_NO_THROW(validate(mesh)) << what;
  EXPECT_NO_THROW(requireConnected(mesh)) << what;
  EXPECT_NO_THROW(requireConforming(mesh)) << what;
  EXPECT_EQ(faceSet(mesh, "skin").size(), boundaryFaces(mesh).size()) << what;
  const FaceIntegrals skin = integrateFaces(mesh, faceSet(mesh, "skin"));
  EXPECT_NEAR(skin.volume, volumeOf(mesh), 1e-12 * skin.volume) << what;
}

TEST(MeshShapes, CylinderSectorsApproachTheirVolume) {
  const double exact = 0.5 * (4.0 - 1.0) * std::numbers::pi / 2.0 * 0.5;
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh coarse = cylinderSector(shape, {2, 4, 1}, 1.0, 2.0, std::numbers::pi / 2.0, 0.5);
    const SolidMesh fine = cylinderSector(shape, layered(shape, {4, 8, 2}), 1.0, 2.0, std::numbers::pi / 2.0, 0.5);
    expectSound(coarse, name(shape));
    for (const int n : nodeSet(fine, "outer")) {
      const Vec3& X = fine.X[static_cast<std::size_t>(n)];
      EXPECT_NEAR(std::hypot(X.x, X.y), 2.0, 1e-14);
    }
    const double order = std::log2(std::abs(volumeOf(coarse) - exact) / std::abs(volumeOf(fine) - exact));
    EXPECT_NEAR(order, isSecondOrder(shape) ? 4.0 : 2.0, 0.1) << name(shape);
  }
}

TEST(MeshShapes, FullRingsClose) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh ring = cylinderSector(shape, layered(shape, {1, 6, 2}), 1.0, 1.5, 2.0 * std::numbers::pi, 1.0);
    expectSound(ring, name(shape));
    EXPECT_FALSE(ring.faceSets.contains("start"));
    const bool plane = dimensionOf(shape) == 2;
    EXPECT_EQ(ring.faceSets.size(), plane ? 3u : 5u);
    std::size_t faces = faceSet(ring, "inner").size() + faceSet(ring, "outer").size();
    if (!plane) faces += faceSet(ring, "z-").size() + faceSet(ring, "z+").size();
    EXPECT_EQ(faces, faceSet(ring, "skin").size());
  }
  EXPECT_THROW(cylinderSector(ElementShape::hex8, {1, 2, 1}, 1.0, 2.0, 2.0 * std::numbers::pi, 1.0), InputError);
  EXPECT_THROW(cylinderSector(ElementShape::hex8, {1, 2, 1}, 2.0, 1.0, 1.0, 1.0), InputError);
  EXPECT_THROW(cylinderSector(ElementShape::hex8, {1, 2, 1}, 1.0, 2.0, 7.0, 1.0), InputError);
}

TEST(MeshShapes, RoundBarsAreRoundAndOfGoodShape) {
  for (const ElementShape shape : bricks) {
    const unsigned layers = dimensionOf(shape) == 2 ? 1u : 3u;
    const SolidMesh coarse = roundBar(shape, layered(shape, {4, 2, 3}), 0.5, 2.0),
                    fine = roundBar(shape, layered(shape, {8, 4, 3}), 0.5, 2.0);
    expectSound(coarse, name(shape));
    const double exact = std::numbers::pi * 0.25 * 2.0;
    const double order = std::log2(std::abs(volumeOf(coarse) - exact) / std::abs(volumeOf(fine) - exact));
    EXPECT_NEAR(order, isSecondOrder(shape) ? 4.0 : 2.0, 0.1) << name(shape);
    EXPECT_EQ(coarse.elementCount(), (16u + 4u * 8u) * layers);
    EXPECT_EQ(faceSet(coarse, "side").size(), 16u * layers);
    EXPECT_GT(measureQuality(fine).shapes[0].worstJacobian, 0.6);
  }
  EXPECT_THROW(roundBar(ElementShape::tet4, {2, 1, 1}, 1.0, 1.0), InputError);
  EXPECT_THROW(roundBar(ElementShape::hex8, {0, 1, 1}, 1.0, 1.0), InputError);
}

TEST(MeshShapes, CooksMembraneHasItsCorners) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = cookMembrane(shape, {4, 3});
    expectSound(mesh, name(shape));
    EXPECT_NEAR(volumeOf(mesh), 0.5 * (0.044 + 0.016) * 0.048 * 0.001, 1e-18);
    EXPECT_EQ(nodeSet(mesh, "tip").size(), dimensionOf(shape) == 2 ? 1u : isSecondOrder(shape) ? 3u : 2u);
    for (const int n : nodeSet(mesh, "tip")) {
      EXPECT_NEAR(mesh.X[static_cast<std::size_t>(n)].x, 0.048, 1e-16);
      EXPECT_NEAR(mesh.X[static_cast<std::size_t>(n)].y, 0.060, 1e-16);
    }
    EXPECT_EQ(faceSet(mesh, "loaded").size(), isTet(shape) ? 6u : 3u);
  }
}

TEST(MeshShapes, TheRootOfTheBeamIsAnArc) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = arcClampedBeam(shape, {8, 2, 1});
    expectSound(mesh, name(shape));
    for (const int n : nodeSet(mesh, "clamped")) {
      const Vec3& X = mesh.X[static_cast<std::size_t>(n)];
      EXPECT_NEAR(std::hypot(X.x - 0.2, X.y - 0.2), 0.05, 1e-15);
    }
    for (const int n : nodeSet(mesh, "tip")) {
      EXPECT_NEAR(mesh.X[static_cast<std::size_t>(n)].x, 0.6, 1e-15);
      EXPECT_NEAR(mesh.X[static_cast<std::size_t>(n)].y, 0.2, 1e-15);
    }
    // The beam without the segment of the circle beyond x = 0.2 + √(r² − h²/4).
    const double half = 0.01, r = 0.05, angle = 2.0 * std::asin(half / r);
    const double area = 0.02 * (0.4 - std::sqrt(r * r - half * half)) - 0.5 * r * r * (angle - std::sin(angle));
    // Straight edges leave two smaller segments to the beam.
    const double chords = r * r * (0.5 * angle - std::sin(0.5 * angle));
    if (isSecondOrder(shape))
      EXPECT_NEAR(volumeOf(mesh) / (area * 0.01), 1.0, 1e-6) << name(shape);
    else
      EXPECT_NEAR(volumeOf(mesh) / ((area + chords) * 0.01), 1.0, 1e-12) << name(shape);
  }
  EXPECT_FALSE(arcClampedBeam(ElementShape::hex8, {4, 1, 1}).nodeSets.contains("tip"));
  EXPECT_THROW(arcClampedBeam(ElementShape::hex8, {4, 1, 1}, {.end = 0.24}), InputError);
  EXPECT_THROW(arcClampedBeam(ElementShape::hex8, {4, 1, 1}, {.radius = 0.009}), InputError);
}

TEST(MeshShapes, MapsThatTurnElementsInsideOutAreRefused) {
  EXPECT_THROW(mappedBox(ElementShape::hex8, {2, 1, 1}, {}, {1.0, 1.0, 1.0},
                         [](const Vec3& X) {
                           return Vec3{-X.x, X.y, X.z};
                         }),
               InputError);
}

TEST(MeshShapes, JoinedPartsShareNodesAndKeepTheirSets) {
  for (const ElementShape shape : allCellShapes) {
    SolidMesh parts[] = {boxOf(shape, {2, 2, 1}, {}, {2.0, 1.0, 1.0}),
                         boxOf(shape, {1, 2, 1}, {2.0, 0.0, 0.0}, {3.0, 1.0, 1.0})};
    parts[1].elementSets["second"] = {0, 1};
    const SolidMesh joined = joinMeshes(parts, 1e-6), whole = boxOf(shape, {3, 2, 1}, {}, {3.0, 1.0, 1.0});
    EXPECT_EQ(joined.X.size(), whole.X.size());
    EXPECT_EQ(joined.elementCount(), whole.elementCount());
    EXPECT_EQ(joined.groups.size(), 1u);
    expectSound(joined, name(shape));
    EXPECT_EQ(elementSet(joined, "second")[0], static_cast<int>(parts[0].elementCount()));
    EXPECT_EQ(faceSet(joined, "x+").size(), faceSet(whole, "x+").size());
  }
  const SolidMesh box[] = {boxOf(ElementShape::hex8, {2, 1, 1}, {}, {1.0, 1.0, 1.0})};
  EXPECT_THROW(joinMeshes(box, 0.6), InputError);
  EXPECT_THROW(joinMeshes(box, 0.0), InputError);
  const SolidMesh planes[] = {boxOf(ElementShape::quad4, {1, 1, 1}, {}, {1.0, 1.0, 1.0}),
                              boxOf(ElementShape::quad4, {1, 1, 1}, {1.0, 0.0, 0.0}, {2.0, 1.0, 2.0})};
  EXPECT_THROW(joinMeshes(planes, 1e-6), InputError);
}

/// Positions of a node set, sorted.
std::vector<std::array<double, 3>> places(const SolidMesh& mesh, const std::vector<int>& nodes) {
  std::vector<std::array<double, 3>> result;
  for (const int n : nodes) {
    const Vec3& X = mesh.X[static_cast<std::size_t>(n)];
    result.push_back({X.x, X.y, X.z});
  }
  std::sort(result.begin(), result.end());
  return result;
}

TEST(MeshShapes, BoxesOfSecondOrderAreThoseMadeAsSuch) {
  const std::pair<ElementShape, ElementShape> pairs[] = {{ElementShape::hex8, ElementShape::hex20},
                                                         {ElementShape::hex8, ElementShape::hex27},
                                                         {ElementShape::tet4, ElementShape::tet10},
                                                         {ElementShape::quad4, ElementShape::quad8}};
  for (const auto& [first, second] : pairs) {
    const SolidMesh from = boxOf(first, layered(first, {2, 1, 3}), {}, {2.0, 1.0, 3.0}),
                    to = boxOf(second, layered(second, {2, 1, 3}), {}, {2.0, 1.0, 3.0});
    EXPECT_EQ(secondOrder(from).thickness, to.thickness);
    const SolidMesh raised = secondOrder(from, second == ElementShape::hex27);
    expectSound(raised, name(second));
    ASSERT_EQ(raised.groups[0].shape, second);
    ASSERT_EQ(raised.X.size(), to.X.size());
    for (std::size_t k = 0; k < to.groups[0].node.size(); ++k) {
      const auto a = static_cast<std::size_t>(raised.groups[0].node[k]),
                 b = static_cast<std::size_t>(to.groups[0].node[k]);
      EXPECT_EQ(raised.X[a], to.X[b]) << name(second);
    }
    for (const auto& [set, nodes] : to.nodeSets)
      EXPECT_EQ(places(raised, nodeSet(raised, set)), places(to, nodes)) << set;
    for (const auto& [set, faces] : to.faceSets) {
      ASSERT_EQ(faceSet(raised, set).size(), faces.size());
      for (std::size_t f = 0; f < faces.size(); ++f) {
        const Face& face = faceSet(raised, set)[f];
        EXPECT_EQ(face.shape, faces[f].shape);
        for (std::size_t k = 0; k < static_cast<std::size_t>(nodesOf(face.shape)); ++k)
          EXPECT_EQ(raised.X[static_cast<std::size_t>(face.node[k])], to.X[static_cast<std::size_t>(faces[f].node[k])]);
      }
    }
    EXPECT_THROW(secondOrder(raised), InputError);
  }
}

Place insideOf(Vec3 lower, Vec3 upper) { return inBox(lower, upper); }

TEST(MeshShapes, HolesLeaveTheRestAndBareTheirFaces) {
  for (const ElementShape shape : allCellShapes) {
    const bool plane = dimensionOf(shape) == 2;
    const SolidMesh box = boxOf(shape, layered(shape, {6, 4, 3}), {}, {3, 2, 1.5});
    const double depth = plane ? 1.5 : 0.5;
    const SolidMesh mesh = withHole(box, insideOf({0.9, 0.4, plane ? -1.0 : 0.4}, {2.1, 1.6, plane ? 1.0 : 1.1}));
    expectSound(mesh, name(shape));
    EXPECT_NEAR(volumeOf(mesh), 9.0 - depth, 1e-12) << name(shape);
    const FaceIntegrals hole = integrateFaces(mesh, faceSet(mesh, "hole"));
    EXPECT_NEAR(hole.volume, -depth, 1e-12) << name(shape);
    EXPECT_NEAR(norm(hole.area), 0.0, 1e-12) << name(shape);
    EXPECT_EQ(faceSet(mesh, "hole").size() + boundaryFaces(box).size(), faceSet(mesh, "skin").size()) << name(shape);
    for (const char* const side : {"x-", "x+", "y-", "y+"})
      EXPECT_EQ(faceSet(mesh, side).size(), faceSet(box, side).size()) << name(shape);
    for (const int n : nodeSet(mesh, "hole"))
      EXPECT_TRUE(inBox({1, 0.5, -9}, {2, 1.5, 9}, 1e-12)(mesh.X[static_cast<std::size_t>(n)])) << name(shape);
  }
}

TEST(MeshShapes, NotchesTakeFacesOfTheirSidesAlong) {
  const SolidMesh box = boxOf(ElementShape::hex8, {4, 1, 2}, {}, {4, 1, 2});
  const SolidMesh notched = withHole(box, insideOf({1, 0, 1}, {3, 1, 9}));
  expectSound(notched, "notch");
  EXPECT_EQ(faceSet(notched, "z+").size(), 2u);
  EXPECT_EQ(faceSet(notched, "hole").size(), 4u);
  EXPECT_EQ(faceSet(notched, "y-").size(), 6u);
  const SolidMesh step = withHole(box, insideOf({0, 0, 1}, {9, 1, 9}));
  EXPECT_FALSE(step.faceSets.contains("z+"));
  EXPECT_FALSE(step.nodeSets.contains("z+"));
}

TEST(MeshShapes, HolesOfNothingAndOfAllAreRefused) {
  const SolidMesh box = boxOf(ElementShape::hex8, {3, 3, 3}, {}, {3, 3, 3});
  EXPECT_THROW(withHole(box, insideOf({5, 5, 5}, {6, 6, 6})), InputError);
  EXPECT_THROW(withHole(box, insideOf({-1, -1, -1}, {6, 6, 6})), InputError);
  const SolidMesh once = withHole(box, insideOf({1, 1, 1}, {2, 2, 2}));
  EXPECT_THROW(withHole(once, insideOf({0, 0, 0}, {1, 1, 1})), InputError);
}

}  // namespace
}  // namespace dovetail::fem
