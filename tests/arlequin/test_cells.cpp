#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/shape.hpp"
#include "scenes.hpp"

namespace dovetail::arlequin {
namespace {

using namespace test;

constexpr std::array shapes = {fem::ElementShape::hex8, fem::ElementShape::hex20, fem::ElementShape::hex27,
                               fem::ElementShape::tet4, fem::ElementShape::tet10};

TEST(Cells, PointsIntegrateVolumesHatsAndTheirProducts) {
  for (const fem::ElementShape shape : shapes)
    for (const int parts : {1, 2, 3}) {
      fem::SolidMesh mesh = fem::boxOf(shape, {2, 1, 1}, {}, {1.0, 0.6, 0.4});
      for (Vec3& X : mesh.X) X = {X.x + 0.3 * X.y, X.y - 0.2 * X.z, X.z + 0.1 * X.x};
      const double volume = 0.24 * (1.0 + 0.3 * -0.2 * 0.1);
      double sum = 0.0, products = 0.0, linear = 0.0;
      for (int e = 0; e < static_cast<int>(mesh.elementCount()); ++e) {
        const Cell cell = cellOf(mesh, e);
        for (const CellPoint& point : cellPoints(mesh, mesh.X, e, parts)) {
          sum += point.weight;
          for (const double a : point.vertexShape)
            for (const double b : point.vertexShape) products += point.weight * a * b;
          Vec3 x;
          for (std::size_t a = 0; a < cell.corner().size(); ++a)
            x += point.vertexShape[a] * mesh.X[static_cast<std::size_t>(cell.corner()[a])];
          linear = std::max(linear, norm(x - point.x));
        }
      }
      EXPECT_NEAR(sum, volume, 1e-13);
      EXPECT_NEAR(products, volume, 1e-13);
      EXPECT_LT(linear, 1e-14) << "straight cells: vertex shape functions of the corners carry the place";
    }
}

TEST(Cells, SizesAreThoseOfTheCubeAndOfTheRegularTetrahedron) {
  const fem::SolidMesh cubes = fem::boxOf(fem::ElementShape::hex20, {2, 2, 2}, {}, {1, 1, 1});
  EXPECT_NEAR(elementSize(cubes, 5), 0.5, 1e-14);
  fem::SolidMesh tet = fem::boxOf(fem::ElementShape::tet4, {1, 1, 1}, {}, {1, 1, 1});
  EXPECT_NEAR(cellVolume(tet, 0), 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(elementSize(tet, 0), std::cbrt(std::sqrt(2.0)), 1e-14);
}

TEST(Cells, HatsGoOnBeyondTheCellAsTheyAreAtItsBorder) {
  for (const fem::ElementShape shape : shapes) {
    const std::span<const Vec3> nodes = fem::parentNodes(shape);
    Vec3 centre;
    const std::size_t corners = fem::shapeRow(shape, nodes[0]).size() > 8 ? 8 : nodes.size();
    const std::size_t count = shape == fem::ElementShape::tet4 || shape == fem::ElementShape::tet10 ? 4 : corners;
    for (std::size_t a = 0; a < count; ++a) centre += (1.0 / static_cast<double>(count)) * nodes[a];
    for (std::size_t a = 0; a < count; ++a) {
      const std::vector<double> at = vertexShapes(shape, nodes[a]);
      const std::vector<double> beyond = vertexShapes(shape, nodes[a] + 0.3 * (nodes[a] - centre));
      EXPECT_NEAR(at[a], 1.0, 1e-14);
      double sum = 0.0;
      for (const double vertexShape : beyond) {
        EXPECT_GE(vertexShape, 0.0);
        sum += vertexShape;
      }
      EXPECT_NEAR(sum, 1.0, 1e-14);
    }
  }
}

TEST(Cells, MidNodesAreLevelledSoThatSharesGoByTheHats) {
  for (const fem::ElementShape shape : {fem::ElementShape::hex20, fem::ElementShape::hex27, fem::ElementShape::tet10}) {
    const fem::SolidMesh mesh = fem::boxOf(shape, {2, 2, 2}, {}, {1, 1, 1});
    std::mt19937 random(2);
    std::uniform_real_distribution<double> drawn(0.0, 1.0);
    std::vector<double> weight;
    for (std::size_t n = 0; n < mesh.X.size(); ++n) weight.push_back(drawn(random));
    levelMidNodes(mesh, weight);
    for (int k = 0; k < 50; ++k) {
      const Vec3 xi{0.3 * drawn(random), 0.3 * drawn(random), 0.3 * drawn(random)};
      const int e = k % static_cast<int>(mesh.elementCount());
      const std::vector<double> row = fem::shapeRow(shape, xi);
      double full = 0.0;
      for (std::size_t a = 0; a < row.size(); ++a)
        full += row[a] * weight[static_cast<std::size_t>(cellOf(mesh, e).node[a])];
      EXPECT_NEAR(full, weightAt(mesh, {e, xi, row}, weight), 1e-14);
    }
  }
}

TEST(Cells, LinearFieldsMakeNoGapInAnyShapeAndForcesBalance) {
  std::mt19937 random(4);
  for (const fem::ElementShape shape : shapes)
    for (const double width : {0.0, 0.4}) {
      fem::SolidMesh mesh = fem::boxOf(shape, {3, 3, 3}, {}, {1.5, 1.5, 1.5});
      std::vector<double> weight;
      for (const Vec3& X : mesh.X) weight.push_back(0.9 - 0.5 * X.x);
      dem::Particles particles;  // some of them beyond the faces
      for (int i = 0; i < 300; ++i)
        dem::addParticle(particles, Vec3{0.75, 0.75, 0.75} + randomVector(random, 0.82), {}, 0.1, dem::Mass{1.0});
      const Still s = locate(mesh, particles, weight);
      EXPECT_EQ(s.overlap.size() + s.overlap.stray.size(), 300u);
      const GapOperator gap = makeGapOperator(s.overlap, s.mesh, particles.mass, GapForm::atParticles, {width});
      const auto field = [](const Vec3& x) { return Vec3{x.y + 0.2 * x.x, 0.3 - x.z, 2.0 * x.x + x.z}; };
      std::vector<Vec3> v, u, g(gap.rows()), lambda(gap.rows());
      for (const Vec3& x : particles.x) v.push_back(field(x));
      for (const Vec3& X : mesh.X) u.push_back(field(X));
      gapOf(gap, s.overlap, v, u, g);
      for (const Vec3& each : g) EXPECT_LT(norm(each), 1e-12) << fem::name(shape);
      for (const double each : gap.particles.weight) EXPECT_GT(each, 0.0);
      for (Vec3& each : lambda) each = randomVector(random, 1.0);
      std::vector<Vec3> onParticles(v.size()), onNodes(u.size());
      pullParticles(gap, s.overlap, lambda, onParticles);
      pullNodes(gap, lambda, onNodes);
      Vec3 force, moment;
      for (std::size_t i = 0; i < v.size(); ++i)
        force += onParticles[i], moment += cross(particles.x[i], onParticles[i]);
      for (std::size_t n = 0; n < u.size(); ++n) force += onNodes[n], moment += cross(mesh.X[n], onNodes[n]);
      EXPECT_LT(norm(force), 1e-12);
      EXPECT_LT(norm(moment), 1e-11);
    }
}

TEST(Cells, SlicesOfPlaneStrainAreRefused) {
  const fem::SolidMesh plane = fem::boxOf(fem::ElementShape::quad4, {2, 2, 1}, {}, {1, 1, 0.1});
  const dem::Particles particles = lattice({0, 0, 0}, {1, 1, 0.5}, 1);
  EXPECT_THROW(locateOverlap(particles, plane, nodesAt(plane.X), std::vector<double>(plane.X.size(), 0.5)), InputError);
}

TEST(Cells, LaplaceOnTetrahedraOfSecondOrderIsTheStraightLine) {
  for (const fem::ElementShape shape : shapes) {
    const fem::SolidMesh mesh = fem::boxOf(shape, {2, 4, 2}, {}, {1, 2, 1});
    std::vector<int> all(mesh.elementCount());
    for (std::size_t e = 0; e < all.size(); ++e) all[e] = static_cast<int>(e);
    const auto s = laplaceCoordinate(mesh, all, fem::nodeSet(mesh, "y-"), fem::nodeSet(mesh, "y+"));
    for (std::size_t n = 0; n < s.size(); ++n) EXPECT_NEAR(s[n], mesh.X[n].y / 2.0, 1e-12);
  }
}

}  // namespace
}  // namespace dovetail::arlequin
