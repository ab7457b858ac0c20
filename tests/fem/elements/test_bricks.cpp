// Bricks with hand-written kernels, in all laws that these know, at random states of large strain.
#include <gtest/gtest.h>

#include <algorithm>

#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

constexpr double young = 1.0e6;

/// 2 × 3 × 3 bricks: a last batch that is not full.
SolidScene randomScene(Formulation formulation, const Material& law, bool distorted, unsigned seed) {
  SolidScene scene = sceneOf(testMesh({2, 3, 3}, distorted, seed), formulation, law);
  setRandom(scene.model.nodes.u, 0.06, seed + 100);
  return scene;
}

std::vector<Material> lawsOf(Formulation formulation) {
  std::vector<Material> laws = {StVenantKirchhoff{young, 0.0, 1.0}, StVenantKirchhoff{young, 0.3, 1.0}};
  if (formulation == Formulation::standard) {
    laws.push_back(DeformedMetricHooke{young, 0.0, 1.0});
    laws.push_back(AxialSprings{young, 1.0});
    laws.push_back(DeformedMetricHooke{young, 0.3, 1.0});
  }
  return laws;
}

template <class Check>
void forEachCase(Check&& check) {
  unsigned seed = 1;
  for (const Formulation formulation : brickFormulations)
    for (const Material& law : lawsOf(formulation))
      for (const bool distorted : {false, true}) {
        SolidScene scene = randomScene(formulation, law, distorted, seed++);
        check(*scene.solid, scene.model.nodes);
      }
}

Eigen::VectorXd internalForce(Solid& solid, const Nodes& nodes) { return -flat(forcesOf(solid, nodes)); }

/// d/ds of value(u + s d) at s = 0 by five points: exact for polynomials of degree four.
template <class Value>
auto derivative(Nodes& nodes, const std::vector<Vec3>& direction, double step, Value&& value) {
  const std::vector<Vec3> u = nodes.u;
  const auto at = [&](double s) {
    for (std::size_t n = 0; n < u.size(); ++n) nodes.u[n] = u[n] + s * direction[n];
    return value();
  };
  const auto near = at(step), nearBack = at(-step), far = at(2.0 * step), farBack = at(-2.0 * step);
  nodes.u = u;
  using Result = std::decay_t<decltype(near)>;
  return Result((8.0 * (near - nearBack) - (far - farBack)) / (12.0 * step));
}

bool isPolynomial(const Solid& solid) {
  return std::holds_alternative<StVenantKirchhoff>(*solid.material()->brickLaw());
}

TEST(Bricks, BoxesTakeLessMemory) {
  for (const Formulation formulation : brickFormulations) {
    const Material law = StVenantKirchhoff{young, 0.3, 1.0};
    const auto memory = [&](bool distorted) {
      return sceneOf(testMesh({6, 6, 6}, distorted), formulation, law).solid->memory();
    };
    EXPECT_LT(memory(false) + 216 * 8 * 60, memory(true));
  }
}

TEST(Bricks, ForceIsMinusTheDerivativeOfTheEnergy) {
  forEachCase([](Solid& solid, Nodes& nodes) {
    if (!solid.material()->isElastic()) return;
    const bool polynomial = isPolynomial(solid);
    std::vector<Vec3> direction(nodes.X.size());
    setRandom(direction, 1.0, 42);
    const double change =
        derivative(nodes, direction, polynomial ? 0.02 : 1e-3, [&] { return solid.energy(nodes, {}); });
    const Eigen::VectorXd force = internalForce(solid, nodes);
    EXPECT_NEAR(force.dot(flat(direction)), change,
                (polynomial ? 1e-11 : 1e-9) * force.norm() * flat(direction).norm());
  });
}

TEST(Bricks, TangentIsTheDerivativeOfTheForce) {
  forEachCase([](Solid& solid, Nodes& nodes) {
    std::vector<Vec3> direction(nodes.X.size());
    setRandom(direction, 1.0, 43);
    const bool polynomial = isPolynomial(solid);
    const Eigen::VectorXd change =
        derivative(nodes, direction, polynomial ? 0.02 : 1e-4, [&] { return internalForce(solid, nodes); });
    const Eigen::VectorXd product = dense(tangentOf(solid, nodes)) * flat(direction);
    EXPECT_LT((product - change).norm(), (polynomial ? 1e-12 : 1e-9) * product.norm());
  });
}

TEST(Bricks, TangentIsSymmetricWhereThereIsAPotential) {
  forEachCase([](Solid& solid, Nodes& nodes) {
    const Eigen::MatrixXd K = dense(tangentOf(solid, nodes));
    const double skew = (K - K.transpose()).norm() / K.norm();
    if (isPolynomial(solid) || poissonRatio(*solid.material()->brickLaw()) == 0.0) {
      EXPECT_LT(skew, 1e-14);
    } else {
      EXPECT_GT(skew, 1e-4);
      EXPECT_FALSE(solid.isSymmetric());
    }
  });
}

TEST(Bricks, ForcesAndMomentsSumToZero) {
  forEachCase([](Solid& solid, Nodes& nodes) {
    const std::vector<Vec3> f = forcesOf(solid, nodes);
    Vec3 force, moment;
    for (std::size_t n = 0; n < f.size(); ++n) {
      force += f[n];
      moment += cross(nodes.X[n] + nodes.u[n], f[n]);
    }
    EXPECT_LT(norm(force), 1e-14 * flat(f).lpNorm<1>());
    EXPECT_LT(norm(moment), 1e-14 * flat(f).lpNorm<1>());
  });
}

TEST(Bricks, RestIsFreeOfForceToTheLastBit) {
  forEachCase([](Solid& solid, Nodes& nodes) {
    for (Vec3& u : nodes.u) u = {0.25, -0.5, 1.0};
    EXPECT_EQ(internalForce(solid, nodes).lpNorm<Eigen::Infinity>(), 0.0);
    EXPECT_EQ(solid.energy(nodes, {}), 0.0);
  });
}

TEST(Bricks, EnergiesAgree) {
  forEachCase([](Solid& solid, Nodes& nodes) {
    const std::vector<double> energies = solid.elementEnergies(nodes, {});
    const double sum = std::accumulate(energies.begin(), energies.end(), 0.0);
    EXPECT_EQ(energies.size(), solid.size());
    EXPECT_GT(*std::min_element(energies.begin(), energies.end()), 0.0);
    EXPECT_NEAR(solid.energy(nodes, {}), sum, 1e-14 * sum);
  });
}

TEST(Bricks, ForcesAreAdded) {
  forEachCase([](Solid& solid, Nodes& nodes) {
    std::vector<Vec3> f(nodes.X.size(), {1.0, 2.0, 3.0});
    solid.addForces(nodes, {}, f);
    const Eigen::VectorXd sum = flat(f) + internalForce(solid, nodes);
    for (Eigen::Index i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], 1.0 + static_cast<double>(i % 3), 1e-9);
  });
}

TEST(Bricks, BoxAndGeneralKernelsAgree) {
  for (const Formulation formulation : brickFormulations)
    for (const Material& law : lawsOf(formulation)) {
      const SolidScene box = randomScene(formulation, law, false, 9);
      SolidMesh nearly = testMesh({2, 3, 3}, false);
      for (Vec3& X : nearly.X) X.x += 1e-11 * X.y;  // no box any more, but only just
      const SolidScene general = sceneOf(nearly, formulation, law);
      EXPECT_GT(general.solid->memory(), box.solid->memory());
      const Eigen::VectorXd expected = internalForce(*box.solid, box.model.nodes);
      EXPECT_LT((internalForce(*general.solid, box.model.nodes) - expected).norm(), 1e-9 * expected.norm());
    }
}

TEST(Bricks, LumpedMassesOfABoxAreEqualSharesOfItsElements) {
  const SolidMesh mesh = testMesh({2, 2, 3}, false);
  Model model = sceneOf(mesh, Formulation::standard, StVenantKirchhoff{young, 0.3, 700.0}).model;
  addMass(model);
  const double mass = 700.0 * 0.9 * 1.1 * 0.7;
  EXPECT_NEAR(*std::min_element(model.nodes.mass.begin(), model.nodes.mass.end()), mass / 12.0 / 8.0, 1e-12 * mass);
}

}  // namespace
}  // namespace dovetail::fem
