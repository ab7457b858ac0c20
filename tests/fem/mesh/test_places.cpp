#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/material_point.hpp"
#include "dovetail/fem/mesh/mesh_places.hpp"
#include "solid_helpers.hpp"
#include "term_checks.hpp"

namespace dovetail::fem {
namespace {

TEST(Places, BoxesAndConditionsFindTheSetsOfABox) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = boxOf(shape, layered(shape, {3, 2, 2}), {}, {1.0, 0.8, 0.6});
    const Place end = inBox({1, 0, 0}, {1, 0.8, 0.6}, 1e-9);
    EXPECT_EQ(nodesWhere(mesh, end), nodeSet(mesh, "x+")) << name(shape);
    EXPECT_EQ(nodesWhere(mesh, [](const Vec3& X) { return X.y < 1e-9; }), nodeSet(mesh, "y-")) << name(shape);
    EXPECT_EQ(facesWhere(mesh, end).size(), faceSet(mesh, "x+").size()) << name(shape);
    for (const Face& face : facesWhere(mesh, end))
      for (int k = 0; k < nodesOf(face.shape); ++k)
        EXPECT_NEAR(mesh.X[static_cast<std::size_t>(face.node[static_cast<std::size_t>(k)])].x, 1.0, 1e-9);
  }
}

TEST(Places, WhereNothingIsAreRefused) {
  const SolidMesh mesh = boxOf(ElementShape::hex8, {1, 1, 1}, {}, {1, 1, 1});
  EXPECT_THROW(nodesWhere(mesh, inBox({2, 2, 2}, {3, 3, 3})), InputError);
  EXPECT_THROW(facesWhere(mesh, inBox({0.2, 0, 0}, {0.8, 1, 1})), InputError);
}

const Eigen::Matrix3d freeStretch{{1.1, 0.05, 0.0}, {-0.1, 0.95, 0.1}, {0.02, 0.0, 1.05}};

TEST(MaterialPoint, HasTheDisplacementAndStressOfAUniformDeformation) {
  std::mt19937 random(5);
  for (const SolidKind& kind : allSolidKinds()) {
    const SolidMesh mesh = testSolidMesh(kind.shape, true);
    SolidScene scene = solidScene(kind, true);
    const Eigen::Matrix3d stretch = inPlane(kind.shape, freeStretch);
    const bool plane = dimensionOf(kind.shape) == 2;
    setAffine(scene.model.nodes, stretch, {0.1, 0.2, 0.3});
    const Solid::Sample sample = scene.solid->sample(scene.model.nodes, {});
    const double J = stretch.determinant();
    const Eigen::Matrix3d T = stretch.inverse().transpose(),
                          sigma = (1e6 * (stretch - T) + 2e6 * std::log(J) * T) * stretch.transpose() / J;
    for (int k = 0; k < 10; ++k) {
      Vec3 X = Vec3{0.5, 0.1, 0.6} + randomVec3(random, 0.15);
      if (plane) X.z = mesh.X[0].z;
      const MaterialPoint point(mesh, X);
      const Eigen::Vector3d u = (stretch - Eigen::Matrix3d::Identity()) * Eigen::Vector3d(X.x, X.y, X.z);
      EXPECT_LT(norm(point.valueOf(scene.model.nodes.u) - Vec3{u[0] + 0.1, u[1] + 0.2, u[2] + 0.3}), 1e-12)
          << kind.label();
      const std::array<double, 9> stress = point.stress(sample);
      for (int i = 0; i < 9; ++i)
        EXPECT_NEAR(stress[static_cast<std::size_t>(i)], sigma(i / 3, i % 3), 1e-4) << kind.label();
    }
  }
}

/// Trilinear in bricks of eight points and more, bilinear in plane cells, linear in tet10.
TEST(MaterialPoint, FollowsStressesThatVaryInTheElement) {
  for (const ElementShape shape : {ElementShape::hex8, ElementShape::hex20, ElementShape::hex27, ElementShape::tet10,
                                   ElementShape::quad4, ElementShape::quad8}) {
    const SolidMesh mesh = testSolidMesh(shape, false);
    SolidScene scene = solidScene({shape, Formulation::standard}, false);
    Solid::Sample sample = scene.solid->sample(scene.model.nodes, {});
    const double product = shape == ElementShape::tet10 ? 0.0 : 6.0;
    const bool plane = dimensionOf(shape) == 2;
    const auto stress = [&](const Vec3& X) {
      return 3.0 + 2.0 * X.x - 5.0 * X.y + 4.0 * X.z + product * X.x * (plane ? X.y : X.z);
    };
    for (std::size_t q = 0; q < sample.X.size(); ++q) sample.P[9 * q + 4] = stress(sample.X[q]);
    for (Vec3 X : {Vec3{0.45, 0.05, 0.7}, Vec3{0.1, 0.4, 1.0}, Vec3{0.55, 0.0, 0.65}}) {
      if (plane) X.z = mesh.X[0].z;
      EXPECT_NEAR(MaterialPoint(mesh, X).stress(sample)[4], stress(X), 1e-12) << name(shape);
    }
  }
}

TEST(MaterialPoint, CornersAreFoundAndPlacesOutsideRefused) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = testSolidMesh(shape, true);
    for (std::size_t n = 0; n < mesh.X.size(); ++n)
      EXPECT_LT(norm(MaterialPoint(mesh, mesh.X[n]).valueOf(mesh.X) - mesh.X[n]), 1e-12) << name(shape) << n;
    EXPECT_THROW(MaterialPoint(mesh, {3.0, 0.1, 0.6}), InputError) << name(shape);
  }
  const SolidMesh mesh = boxOf(ElementShape::hex8, {2, 1, 1}, {}, {1, 1, 1});
  EXPECT_THROW(MaterialPoint(mesh, {0.5, 0.5, 0.5}).stress({}), InputError);
}

}  // namespace
}  // namespace dovetail::fem
