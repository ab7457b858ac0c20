// Elements that are inverted, or whose material cannot be trusted, are named.
#include <gtest/gtest.h>

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

const Material kirchhoff = StVenantKirchhoff{1e6, 0.3, 1000.0};

std::string complaint(Solid& solid, const Nodes& nodes, Scrutiny scrutiny, const std::string& when = "now") {
  try {
    solid.requireValid(nodes, when, scrutiny);
  } catch (const NumericalError& error) {
    return error.what();
  }
  return "";
}

/// Solids of hex8 by kernels and by points.
std::vector<SolidScene> hexScenes(const SolidMesh& mesh) {
  std::vector<SolidScene> scenes;
  for (const Formulation formulation : brickFormulations) scenes.push_back(sceneOf(mesh, formulation, kirchhoff));
  for (const SolidKind& kind : allSolidKinds())
    if (kind.shape == ElementShape::hex8)
      scenes.push_back(sceneOf(mesh, std::make_shared<PlainNeoHookean>(1e6, 1e6), {.formulation = kind.formulation}));
  return scenes;
}

/// Pushes the far corner of a brick through the opposite one; elements before it do not have that node.
void invert(const SolidMesh& mesh, std::size_t element, Nodes& nodes) {
  const int* const node = &mesh.groups[0].node[8 * element];
  const auto far = static_cast<std::size_t>(node[6]), near = static_cast<std::size_t>(node[0]);
  nodes.u[far] = 2.0 * (mesh.X[near] - mesh.X[far]);
}

TEST(Validity, TheFirstInvertedElementIsNamedOnAnyNumberOfThreads) {
  for (const bool distorted : {false, true}) {
    const SolidMesh mesh = testMesh({10, 10, 10}, distorted);
    for (SolidScene& scene : hexScenes(mesh)) {
      SCOPED_TRACE(std::string(name(scene.solid->formulation())) + ", " + scene.solid->material()->name());
      Nodes& nodes = scene.model.nodes;
      setRandom(nodes.u, 0.004, 8);
      for (const Scrutiny scrutiny : {Scrutiny::inversion, Scrutiny::all})
        EXPECT_EQ(complaint(*scene.solid, nodes, scrutiny), "");
      for (const std::size_t element : {999, 731, 317}) {
        invert(mesh, element, nodes);
        for (const Scrutiny scrutiny : {Scrutiny::inversion, Scrutiny::all}) {
          const auto ask = [&] { return complaint(*scene.solid, nodes, scrutiny, "step 7"); };
          const std::string one = onThreads(1, ask);
          EXPECT_NE(one.find("element " + std::to_string(element) + ' '), std::string::npos) << one;
          EXPECT_NE(one.find("\"elastic\""), std::string::npos) << one;
          EXPECT_NE(one.find("step 7"), std::string::npos) << one;
          EXPECT_EQ(one, onThreads(2, ask));
          EXPECT_EQ(one, onThreads(3, ask));
        }
      }
    }
  }
}

TEST(Validity, ElementsThatAreNotFiniteAreNamed) {
  const SolidMesh mesh = testMesh({2, 3, 3}, true);
  for (SolidScene& scene : hexScenes(mesh)) {
    scene.model.nodes.u.back().x = std::numeric_limits<double>::quiet_NaN();
    for (const Scrutiny scrutiny : {Scrutiny::inversion, Scrutiny::all})
      EXPECT_NE(complaint(*scene.solid, scene.model.nodes, scrutiny).find("element 17 "), std::string::npos);
  }
}

TEST(Validity, NumbersAreThoseOfTheMesh) {
  SolidMesh mesh = testMesh({2, 3, 3}, false);
  mesh.elementSets["some"] = {3, 11, 17};
  for (const Formulation formulation : brickFormulations) {
    SolidScene scene = sceneOf(mesh, pointMaterial(kirchhoff), {.formulation = formulation, .elementSet = "some"});
    invert(mesh, 11, scene.model.nodes);
    EXPECT_NE(complaint(*scene.solid, scene.model.nodes, Scrutiny::inversion).find("element 11 "), std::string::npos);
  }
}

/// A law past its limit point has a stress, and its elements are upright.
TEST(Validity, OnlyFullScrutinyLooksForLimitPointsOfLaws) {
  SolidScene scene = sceneOf(testMesh({2, 1, 1}, false), Formulation::standard, kirchhoff);
  setAffine(scene.model.nodes, Eigen::Vector3d(1.0, 1.0, 0.45).asDiagonal());
  EXPECT_EQ(complaint(*scene.solid, scene.model.nodes, Scrutiny::inversion), "");
  EXPECT_NE(complaint(*scene.solid, scene.model.nodes, Scrutiny::all), "");
}

TEST(Validity, ForeignNodesAreRefused) {
  const Nodes others = makeModel(testMesh({1, 1, 1}, false)).nodes;
  for (SolidScene& scene : hexScenes(testMesh({2, 3, 3}, false))) {
    std::vector<Vec3> f(others.u.size());
    linalg::BlockMatrix K = zeroTangent(scene.model);
    EXPECT_THROW(scene.solid->addForces(others, {}, f), InputError);
    EXPECT_THROW(scene.solid->addForcesAndEnergy(others, {}, f), InputError);
    EXPECT_THROW(scene.solid->energy(others, {}), InputError);
    EXPECT_THROW(scene.solid->elementEnergies(others, {}), InputError);
    EXPECT_THROW(scene.solid->addTangent(others, {}, K), InputError);
    EXPECT_THROW(scene.solid->stableStep(others), InputError);
    EXPECT_THROW(scene.solid->sample(others, {}), InputError);
    EXPECT_THROW(scene.solid->requireValid(others, "now", Scrutiny::inversion), InputError);
  }
}

/// One corner moves steadily through its element: forces stay finite, the state is not.
TEST(Validity, ExplicitRunsDoNotEndWithAnInvertedElement) {
  const SolidMesh mesh = testMesh({3, 1, 1}, false);
  for (const Formulation formulation : brickFormulations)
    for (const int checkEvery : {1, 10, 100}) {
      Model model = sceneOf(mesh, formulation, kirchhoff).model;
      addMass(model);
      for (int n = 0; n < static_cast<int>(mesh.X.size()); ++n) fix(model.nodes, std::array{n});
      ExplicitIntegrator integrator(model, 1e-4, {.checkEvery = checkEvery});
      EXPECT_NO_THROW(integrator.run(5));
      const auto corner = static_cast<std::size_t>(mesh.groups[0].node[8 * 2 + 6]);
      model.nodes.v[corner] = {-800.0, -1400.0, -900.0};  // through the element in 8 steps
      try {
        integrator.run(30);
        ADD_FAILURE() << "an inverted element was accepted, checkEvery " << checkEvery;
      } catch (const NumericalError& error) {
        EXPECT_NE(std::string(error.what()).find("element 2 "), std::string::npos) << error.what();
      }
      EXPECT_TRUE(std::isfinite(flat(model.nodes.f).norm()));
      EXPECT_LE(integrator.report().steps, checkEvery == 1 ? 15 : checkEvery == 10 ? 20 : 35);
    }
}

}  // namespace
}  // namespace dovetail::fem
