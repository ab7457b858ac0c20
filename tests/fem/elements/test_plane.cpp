// Plane strain: cells in a plane are one layer of bricks whose z is held, in whatever is asked of them.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "plane_layer.hpp"

namespace dovetail::fem {
namespace {

TEST(PlaneStrain, ForcesEnergiesAndMassesAreThoseOfALayerOfBricks) {
  forEachPair(rubber, [](Pair& pair) {
    pair.displace(0.03, 3);
    const std::vector<Vec3> f = forcesOf(*pair.plane.solid, pair.plane.model.nodes);
    EXPECT_LT(largestDifference(pair.gathered(forcesOf(*pair.bricks.solid, pair.bricks.model.nodes)), f),
              1e-12 * largest(f));
    const double energy = pair.bricks.solid->energy(pair.bricks.model.nodes, {});
    EXPECT_NEAR(pair.plane.solid->energy(pair.plane.model.nodes, {}), energy, 1e-12 * energy);
    const auto count = static_cast<Eigen::Index>(pair.image.size());
    Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(pair.plane.mesh.X.size()));
    for (Eigen::Index n = 0; n < count; ++n)
      spread(n, static_cast<Eigen::Index>(pair.image[static_cast<std::size_t>(n)])) = 1.0;
    const Eigen::MatrixXd M = massMatrixOf(*pair.plane.solid, pair.plane.mesh.X.size());
    EXPECT_LT((spread.transpose() * massMatrixOf(*pair.bricks.solid, pair.image.size()) * spread - M).norm(),
              1e-12 * M.norm());
  });
}

TEST(PlaneStrain, SamplesHaveTheThicknessAndNoStretchAcross) {
  forEachPair(rubber, [](Pair& pair) {
    pair.displace(0.02, 5);
    double volume[2] = {}, across = 0.0;
    int which = 0;
    pair.both([&](Body& body) {
      const Solid::Sample sample = body.solid->sample(body.model.nodes, {});
      for (const double v : sample.volume) volume[which] += v;
      if (body.solid->formulation() == Formulation::standard)
        for (std::size_t q = 0; q < sample.volume.size(); ++q)
          across = std::max(across, std::abs(sample.F[9 * q + 8] - 1.0));
      ++which;
    });
    EXPECT_NEAR(volume[0], volume[1], 1e-13);
    EXPECT_LT(across, 1e-15);
  });
}

TEST(PlaneStrain, StaticsUnderPressureAreThoseOfALayerOfBricks) {
  for (const auto& [material, pressure] :
       {std::pair<std::shared_ptr<const PointMaterial>, double>{rubber, 4e4}, {metal, 4e3}})
    forEachPair(material, [&, pressure = pressure, name = material->name()](Pair& pair) {
      pair.both([&](Body& body) {
        load(body, pressure);
        solveStatics(body.model, 1.0, {.newton = {.relativeTolerance = 1e-13}, .firstStep = 0.25, .largestStep = 0.25});
      });
      pair.expectSameDisplacements(1e-10, name);
    });
}

/// hex20 with lumped masses is no layer of quad8: its nodes between the planes move on their own.
TEST(PlaneStrain, ExplicitMotionIsThatOfALayerOfBricks) {
  forEachPair(rubber, [](Pair& pair) {
    pair.both([&](Body& body) {
      load(body, 1e6);
      const double fraction =
          body.solid->shape() == ElementShape::quad4 || body.solid->shape() == ElementShape::hex8 ? 0.0 : 1.0;
      ExplicitIntegrator integrator(body.model, 1e-4, {.massFraction = fraction});
      integrator.run(150);
      EXPECT_LT(std::abs(integrator.ledger().residual()), 0.01 * storedEnergy(body.model, {}));
    });
    pair.expectSameDisplacements(1e-10, "explicit");
  });
}

/// Energy-momentum steps of other formulations correct forces along the lines between all nodes of an element, of which
/// bricks have more.
TEST(PlaneStrain, ImplicitMotionIsThatOfALayerOfBricks) {
  for (const Scheme& scheme : {newmark(), energyMomentum()})
    forEachPair(rubber, [&](Pair& pair) {
      if (scheme.conserving && pair.plane.solid->formulation() != Formulation::standard) return;
      pair.both([&](Body& body) {
        load(body, 1e6);
        ImplicitOptions options;
        options.scheme = scheme;
        options.massFraction = 1.0;
        options.relativeTolerance = 1e-13;
        ImplicitIntegrator(body.model, 2e-3, options).run(8);
      });
      pair.expectSameDisplacements(1e-10, scheme.name);
    });
}

TEST(PlaneStrain, AFreeBodySpinsOnWithoutLosingEnergyOrMomenta) {
  for (const SolidKind& kind : kindsOfBricks) {
    SCOPED_TRACE(kind.label());
    Body body(kind.shape, kind.formulation, rubber);
    Nodes& nodes = body.model.nodes;
    for (std::size_t n = 0; n < nodes.X.size(); ++n)
      nodes.v[n] = cross(Vec3{0, 0, 60.0}, nodes.X[n] - Vec3{0.5, 0.2, 0.2}) + Vec3{1.0, 20.0 * nodes.X[n].x, 0.0};
    const Vec3 momentumBefore = momentum(nodes), spinBefore = angularMomentum(nodes);
    const double before = kineticEnergy(nodes);
    ImplicitOptions options;
    options.scheme = energyMomentum();
    options.massFraction = 0.0;
    options.relativeTolerance = 1e-12;
    ImplicitIntegrator integrator(body.model, 2e-3, options);
    integrator.run(40);  // five radians
    EXPECT_LT(norm(momentum(nodes) - momentumBefore), 1e-9 * norm(momentumBefore));
    EXPECT_LT(std::abs(angularMomentum(nodes).z - spinBefore.z), 1e-9 * norm(spinBefore));
    EXPECT_NEAR(kineticEnergy(nodes) + storedEnergy(body.model, {}), before, 1e-7 * before);
    for (const Vec3& u : nodes.u) EXPECT_EQ(u.z, 0.0);
  }
}

TEST(PlaneStrain, RunsAreContinuedFromCheckpointsToTheLastBit) {
  for (const SolidKind& kind : kindsOfBricks) {
    SCOPED_TRACE(kind.label());
    const auto run = [&](bool interrupted) {
      Body body(kind.shape, kind.formulation, metal);
      load(body, 1e6);
      ByteWriter state;
      {
        ExplicitIntegrator integrator(body.model, 1e-4);
        integrator.run(40);
        integrator.save(state);
        if (!interrupted) {
          integrator.run(40);
          return body.model.nodes.u;
        }
      }
      Body again(kind.shape, kind.formulation, metal);
      load(again, 1e6);
      ExplicitIntegrator integrator(again.model, 1e-4);
      ByteReader reader(state.bytes());
      integrator.load(reader);
      integrator.run(40);
      return again.model.nodes.u;
    };
    EXPECT_EQ(run(true), run(false));
  }
}

TEST(PlaneStrain, TheStableStepOfOneElementIsItsOwn) {
  for (const ElementShape shape : {ElementShape::quad4, ElementShape::quad8}) {
    const SolidMesh mesh = boxOf(shape, {1, 1, 1}, {}, {0.3, 0.2, depth});
    SolidScene scene = sceneOf(mesh, rubber);
    addMass(scene.model);
    EXPECT_NEAR(stableStep(scene.model).dt, assembledStableStep(scene.model, 1e-8), 1e-6 * stableStep(scene.model).dt);
  }
}

TEST(PlaneStrain, MeanDilatationDoesNotLock) {
  const auto tip = [](ElementShape shape, Formulation formulation) {
    const SolidMesh mesh = cookMembrane(shape, {4, 4});
    Model model = makeModel(mesh);
    model.add(makeSolid(mesh, pointMaterial(NeoHookean{800e6, 0.16e6, 1000.0}), {.formulation = formulation}));
    model.constraints.hold(nodeSet(mesh, "clamped"));
    model.add(deadTraction(mesh, faceSet(mesh, "loaded"), {0.0, 1e3, 0.0}, [](double t) { return t; }));
    solveStatics(model, 1.0);
    return model.nodes.u[static_cast<std::size_t>(nodeSet(mesh, "tip")[0])].y;
  };
  const double fine = tip(ElementShape::quad8, Formulation::meanDilatation);
  EXPECT_GT(tip(ElementShape::quad4, Formulation::meanDilatation), 0.8 * fine);
  EXPECT_LT(tip(ElementShape::quad4, Formulation::standard), 0.5 * fine);
  EXPECT_NEAR(tip(ElementShape::quad8, Formulation::reduced), fine, 0.1 * fine);
}

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(PlaneStrain, WhatItDoesNotHaveIsRefusedByName) {
  const SolidMesh plane = bentBox(ElementShape::quad4), bricks = bentBox(ElementShape::hex8);
  const auto refusal = [&](ElementShape shape, Formulation formulation) {
    return messageOf([&] {
      makeSolid(bentBox(shape), pointMaterial(StVenantKirchhoff{1e6, 0.3, 1.0}), {.formulation = formulation});
    });
  };
  EXPECT_NE(refusal(ElementShape::quad4, Formulation::enhanced).find("\"enhanced\" is for hex8, not for quad4"),
            std::string::npos);
  EXPECT_NE(refusal(ElementShape::quad8, Formulation::assumedStress).find("not for quad8"), std::string::npos);
  EXPECT_NE(refusal(ElementShape::quad4, Formulation::reduced).find("\"reduced\" is for hex8 and quad8, not for quad4"),
            std::string::npos);
  EXPECT_NE(messageOf([&] { deadPressure(bricks, faceSet(plane, "x+"), 1.0); }).find("line2"), std::string::npos);
  EXPECT_NE(messageOf([&] { followingPressure(plane, faceSet(bentBox(ElementShape::hex8), "x-"), 1.0); }).size(), 0u);
  Model model = makeModel(plane);
  model.constraints.prescribe(std::array{2}, 2, [](double t) { return t; });
  EXPECT_NE(messageOf([&] { DofMap(model.constraints, model.nodes); }).find("component z of node 2"),
            std::string::npos);
}

TEST(PlaneStrain, InvertedElementsAreNamed) {
  for (const SolidKind& kind : kindsOfBricks) {
    Body body(kind.shape, kind.formulation, rubber);
    Nodes& nodes = body.model.nodes;
    body.solid->requireValid(nodes, "now", Scrutiny::all);
    const auto node = [&](std::size_t a) {
      return static_cast<std::size_t>(body.mesh.groups[0].node[3 * static_cast<std::size_t>(nodesOf(kind.shape)) + a]);
    };
    nodes.u[node(1)] = 1.5 * (nodes.X[node(3)] - nodes.X[node(1)]);
    EXPECT_NE(messageOf([&] { body.solid->requireValid(nodes, "now", Scrutiny::inversion); }).find("element 3 "),
              std::string::npos)
        << kind.label();
  }
}

}  // namespace
}  // namespace dovetail::fem
