// What acts on plane strain: loads and contact on lines, ties.
#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/fem/laws/material_probe.hpp"
#include "dovetail/fem/model/ties.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "face_integrals.hpp"
#include "plane_layer.hpp"

namespace dovetail::fem {
namespace {

TEST(PlaneStrain, ContactIsThatOfALayerOfBricks) {
  ContactOptions options;
  options.penalty = 1e6;
  options.friction = 0.3;
  forEachPair(rubber, [&](Pair& pair) {
    pair.displace(0.02, 7);
    std::vector<Vec3> f[2];
    ContactPlane::Report reports[2];
    int which = 0;
    pair.both([&](Body& body) {
      const auto faces = faceSet(body.mesh, "y-");
      const auto contact = makeContactPlane(body.mesh, faces, {{0, 0.02, 0}, {-0.05, 1, 0}, {}}, options);
      contact->commit(body.model.nodes, {});
      for (Vec3& u : body.model.nodes.u) u.x += 0.003, u.y -= 0.01;
      f[which] = forcesOf(*contact, body.model.nodes);
      reports[which++] = contact->report(body.model.nodes, {});
      if (dimensionOf(body.mesh) == 2) {
        const double length = integrateFaces(body.mesh, faces).length / static_cast<double>(faces.size());
        EXPECT_NEAR(contactPenalty(body.mesh, faces, moduliAtRest(*body.solid->material()).confined) * length,
                    10.0 * 4e6, 1e-2);
      }
    });
    EXPECT_GT(largest(f[0]), 1.0);
    EXPECT_LT(largestDifference(pair.gathered(f[1]), f[0]), 1e-12 * largest(f[0]));
    EXPECT_NEAR(reports[0].area, reports[1].area, 1e-14);
    EXPECT_NEAR(reports[0].largestPressure, reports[1].largestPressure, 1e-9);
  });
}

TEST(PlaneStrain, ContactHasItsEnergyAndTangent) {
  for (const ElementShape shape : {ElementShape::quad4, ElementShape::quad8}) {
    const SolidMesh mesh = bentBox(shape);
    Model model = makeModel(mesh);
    setRandomDisplacement(model.nodes, 0.03, 3);
    ContactOptions options;
    options.penalty = 1e3;
    const auto contact = makeContactPlane(mesh, faceSet(mesh, "y-"), {{0, 0.02, 0}, {-0.05, 1, 0}, {}}, options);
    expectForceFromEnergy(*contact, model.nodes, {}, 1e-6, 1e-7);
    expectTangents(*contact, model.nodes, {}, 1e-6, 1e-7);
  }
}

TEST(PlaneStrain, LoadsOnLinesAreThoseOnFacesOfTheLayer) {
  for (const ElementShape shape : {ElementShape::quad4, ElementShape::quad8}) {
    Pair pair({shape, Formulation::standard}, rubber);
    pair.displace(0.03, 9);
    const auto expectSame = [&](auto&& make) {
      const std::vector<Vec3> f = forcesOf(*make(pair.plane.mesh), pair.plane.model.nodes, {0.5, 0.1});
      const std::vector<Vec3> expected =
          pair.gathered(forcesOf(*make(pair.bricks.mesh), pair.bricks.model.nodes, {0.5, 0.1}));
      EXPECT_GT(largest(f), 0.01);
      EXPECT_LT(largestDifference(f, expected), 1e-13 * largest(f));
    };
    expectSame([](const SolidMesh& mesh) { return followingPressure(mesh, faceSet(mesh, "y+"), 3.0); });
    expectSame([](const SolidMesh& mesh) { return deadPressure(mesh, faceSet(mesh, "x+"), 3.0); });
    expectSame([](const SolidMesh& mesh) { return deadTraction(mesh, faceSet(mesh, "y-"), {1.0, 2.0, 0.0}); });
    expectSame([](const SolidMesh& mesh) {
      return deadTraction(mesh, faceSet(mesh, "y-"), [](const Vec3& X, double t) { return Vec3{t, X.x * X.x, 0.0}; });
    });
  }
}

TEST(PlaneStrain, PressureOnARingIsTheGradientOfPressureTimesItsVolume) {
  for (const ElementShape shape : {ElementShape::quad4, ElementShape::quad8}) {
    const SolidMesh ring = cylinderSector(shape, {2, 16, 1}, 1.0, 1.5, 2.0 * std::numbers::pi, depth);
    Model model = makeModel(ring);
    const auto inside = followingPressure(ring, faceSet(ring, "inner"), 7.0);
    ASSERT_TRUE(inside->hasEnergy());
    const double hole = -integrateFaces(ring, faceSet(ring, "inner")).volume;
    EXPECT_NEAR(hole, std::numbers::pi * depth, shape == ElementShape::quad4 ? 0.04 : 1e-4);
    EXPECT_NEAR(inside->energy(model.nodes, {}), -7.0 * hole, 1e-13);
    setRandomDisplacement(model.nodes, 0.02, 3);
    const auto [force, moment] = resultant(model.nodes, forcesOf(*inside, model.nodes));
    EXPECT_LT(norm(force), 1e-13);
    EXPECT_LT(norm(moment), 1e-13);
    expectForceFromEnergy(*inside, model.nodes, {}, 1e-9);
    expectTangents(*inside, model.nodes, {}, 1e-9);
    const auto closed = followingPressure(ring, faceSet(ring, "skin"), 7.0);
    EXPECT_TRUE(closed->isSymmetric());
    EXPECT_LT(norm(resultant(model.nodes, forcesOf(*closed, model.nodes)).first), 1e-13);
  }
}

TEST(PlaneStrain, ALineOfFacesHasItsEndsAsRim) {
  const SolidMesh mesh = bentBox(ElementShape::quad8);
  std::vector<int> ends;
  for (const int n : nodeSet(mesh, "y+"))
    for (const char* side : {"x-", "x+"})
      if (std::ranges::binary_search(nodeSet(mesh, side), n)) ends.push_back(n);
  ASSERT_EQ(ends.size(), 2u);
  EXPECT_TRUE(followingPressure(mesh, faceSet(mesh, "y+"), 1.0, ends)->isSymmetric());
  ends.pop_back();
  EXPECT_FALSE(followingPressure(mesh, faceSet(mesh, "y+"), 1.0, ends)->isSymmetric());
}

TEST(PlaneStrain, TiesOfLinesPassLinearDisplacements) {
  for (const ElementShape shape : {ElementShape::quad4, ElementShape::quad8}) {
    const SolidMesh parts[] = {boxOf(shape, {2, 2, 1}, {}, {1, 1, 1}),
                               boxOf(shape, {2, 3, 1}, {1.5, 0, 0}, {2.5, 1, 1})};
    SolidMesh mesh = joinMeshes(parts, 1e-9);
    const auto count = parts[0].X.size();
    std::vector<int> slaves;
    for (std::size_t n = count; n < mesh.X.size(); ++n) {
      mesh.X[n].x -= 0.5;
      if (mesh.X[n].x == 1.0) slaves.push_back(static_cast<int>(n));
    }
    std::vector<Face> masters;
    for (const Face& face : faceSet(mesh, "x+"))
      if (static_cast<std::size_t>(face.node[0]) < count) masters.push_back(face);
    Model model = makeModel(mesh);
    model.constraints.ties = tieInterface(mesh, slaves, masters, 1e-9);
    EXPECT_EQ(model.constraints.ties.size(), 2 * slaves.size());
    setAffine(model.nodes, inPlane(shape, Eigen::Matrix3d{{1.1, 0.2, 0}, {-0.1, 0.9, 0}, {0, 0, 1}}));
    const std::vector<Vec3> exact = model.nodes.u;
    for (const int n : slaves) model.nodes.u[static_cast<std::size_t>(n)] = {};
    DofMap(model.constraints, model.nodes).apply(0.0, model.nodes.u);
    EXPECT_LT(largestDifference(model.nodes.u, exact), 1e-12);
  }
}

TEST(PlaneStrain, PeriodicCellsHaveTheMacroscopicGradient) {
  const SolidMesh mesh = boxOf(ElementShape::quad8, {2, 2, 1}, {0.1, 0.2, 0.3}, {1.0, 1.2, 1.0});
  SolidScene scene = sceneOf(mesh, rubber);
  const std::array<double, 9> F = {1.1, 0.05, 0, 0.03, 0.92, 0, 0, 0, 1};
  const PeriodicTies cell = periodicTies(mesh, [&](double t) {
    std::array<double, 9> now{};
    for (std::size_t k = 0; k < 9; ++k) now[k] = (k % 4 == 0 ? 1.0 - t : 0.0) + t * F[k];
    return now;
  });
  EXPECT_NEAR(cell.volume, 0.9 * 1.0 * 0.7, 1e-15);
  scene.model.constraints.ties = cell.ties;
  scene.model.constraints.hold(std::array{cell.corner});
  solveStatics(scene.model, 1.0, {.newton = {.relativeTolerance = 1e-12}});
  const Solid::Sample sample = scene.solid->sample(scene.model.nodes, {});
  for (std::size_t k = 0; k < sample.F.size(); ++k) EXPECT_NEAR(sample.F[k], F[k % 9], 1e-9);
  evaluateForces(scene.model, {});
  const auto P = averageFirstStress(scene.model.nodes, scene.model.nodes.f, cell.volume);
  for (std::size_t k = 0; k < 8; ++k) EXPECT_NEAR(P[k], sample.P[k], 1e-3);
}

}  // namespace
}  // namespace dovetail::fem
