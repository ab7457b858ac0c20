#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "dovetail/core/error.hpp"
#include "helpers.hpp"

namespace dovetail::fem {
namespace {

constexpr double young = 1.0e6;

struct Case {
  ElementBlock block;
  Nodes nodes;
};

/// 2 × 3 × 3 bricks (a last batch that is not full) in a random state of large strain.
Case randomCase(ElementType type, const Material& material, bool distorted, unsigned seed) {
  const Mesh mesh = testMesh({2, 3, 3}, distorted, seed);
  Case test{makeElements(mesh, type, material), makeNodes(mesh)};
  setRandom(test.nodes.u, 0.06, seed + 100);
  return test;
}

std::vector<Material> lawsOf(ElementType type) {
  std::vector<Material> laws = {StVenantKirchhoff{young, 0.0, 1.0}, StVenantKirchhoff{young, 0.3, 1.0}};
  if (type == ElementType::hex8) {
    laws.push_back(DeformedMetricHooke{young, 0.0, 1.0});
    laws.push_back(AxialSprings{young, 1.0});
    laws.push_back(DeformedMetricHooke{young, 0.3, 1.0});
  }
  return laws;
}

template <class Check>
void forEachCase(Check&& check) {
  unsigned seed = 1;
  for (const ElementType type : bothTypes)
    for (const Material& material : lawsOf(type))
      for (const bool distorted : {false, true}) {
        Case test = randomCase(type, material, distorted, seed++);
        check(test.block, test.nodes);
      }
}

Eigen::VectorXd internalForce(const ElementBlock& block, Nodes& nodes) {
  clearForces(nodes);
  addInternalForces(block, nodes);
  return -flat(nodes.f);
}

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

bool hasPotential(const ElementBlock& block) { return std::holds_alternative<StVenantKirchhoff>(block.material()); }

TEST(Elements, BoxesAreRecognised) {
  forEachCase([](const ElementBlock& block, Nodes& nodes) {
    const bool distorted = std::abs(nodes.X[0].x - 0.1) > 1e-9;
    EXPECT_EQ(block.boxes(), distorted ? 0u : block.size());
  });
}

TEST(Elements, ForceIsMinusTheDerivativeOfTheEnergy) {
  forEachCase([](const ElementBlock& block, Nodes& nodes) {
    if (!hasPotential(block)) return;
    std::vector<Vec3> direction(nodes.X.size());
    setRandom(direction, 1.0, 42);
    const double change = derivative(nodes, direction, 0.02, [&] { return strainEnergy(block, nodes); });
    const Eigen::VectorXd force = internalForce(block, nodes);
    EXPECT_NEAR(force.dot(flat(direction)), change, 1e-11 * force.norm() * flat(direction).norm());
  });
}

TEST(Elements, TangentIsTheDerivativeOfTheForce) {
  forEachCase([](const ElementBlock& block, Nodes& nodes) {
    std::vector<Vec3> direction(nodes.X.size());
    setRandom(direction, 1.0, 43);
    const bool polynomial = hasPotential(block);
    const Eigen::VectorXd change =
        derivative(nodes, direction, polynomial ? 0.02 : 1e-4, [&] { return internalForce(block, nodes); });
    const Eigen::VectorXd product = dense(tangent(block, nodes)) * flat(direction);
    EXPECT_LT((product - change).norm(), (polynomial ? 1e-12 : 1e-9) * product.norm());
  });
}

TEST(Elements, TangentIsSymmetricWhereThereIsAPotential) {
  forEachCase([](const ElementBlock& block, Nodes& nodes) {
    const Eigen::MatrixXd K = dense(tangent(block, nodes));
    const double skew = (K - K.transpose()).norm() / K.norm();
    if (hasPotential(block) || poissonRatio(block.material()) == 0.0)
      EXPECT_LT(skew, 1e-14);
    else
      EXPECT_GT(skew, 1e-4);
  });
}

TEST(Elements, ForcesAndMomentsSumToZero) {
  forEachCase([](const ElementBlock& block, Nodes& nodes) {
    const double scale = internalForce(block, nodes).lpNorm<1>();
    Vec3 force, moment;
    for (std::size_t n = 0; n < nodes.f.size(); ++n) {
      force += nodes.f[n];
      moment += cross(nodes.X[n] + nodes.u[n], nodes.f[n]);
    }
    EXPECT_LT(norm(force), 1e-14 * scale);
    EXPECT_LT(norm(moment), 1e-14 * scale);
  });
}

TEST(Elements, RestIsFreeOfForceToTheLastBit) {
  forEachCase([](const ElementBlock& block, Nodes& nodes) {
    for (Vec3& u : nodes.u) u = {0.25, -0.5, 1.0};
    EXPECT_EQ(internalForce(block, nodes).lpNorm<Eigen::Infinity>(), 0.0);
    EXPECT_EQ(strainEnergy(block, nodes), 0.0);
  });
}

TEST(Elements, EnergiesAgree) {
  forEachCase([](const ElementBlock& block, Nodes& nodes) {
    const std::vector<double> energies = elementEnergies(block, nodes);
    const double sum = std::accumulate(energies.begin(), energies.end(), 0.0);
    EXPECT_EQ(energies.size(), block.size());
    EXPECT_GT(*std::min_element(energies.begin(), energies.end()), 0.0);
    EXPECT_NEAR(strainEnergy(block, nodes), sum, 1e-14 * sum);
    EXPECT_EQ(addInternalForces(block, nodes, true), strainEnergy(block, nodes));
    EXPECT_EQ(addInternalForces(block, nodes), 0.0);
  });
}

TEST(Elements, ForcesAreAdded) {
  forEachCase([](const ElementBlock& block, Nodes& nodes) {
    const Eigen::VectorXd force = internalForce(block, nodes);
    for (Vec3& f : nodes.f) f = {1.0, 2.0, 3.0};
    addInternalForces(block, nodes);
    Eigen::VectorXd sum = flat(nodes.f) + force;
    for (Eigen::Index i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], 1.0 + static_cast<double>(i % 3), 1e-9);
  });
}

TEST(Elements, BoxAndGeneralKernelsAgree) {
  for (const ElementType type : bothTypes)
    for (const Material& material : lawsOf(type)) {
      Case box = randomCase(type, material, false, 9);
      Mesh nearly = testMesh({2, 3, 3}, false);
      for (Vec3& X : nearly.X) X.x += 1e-11 * X.y;  // no box any more, but only just
      const ElementBlock general = makeElements(nearly, type, material);
      EXPECT_EQ(general.boxes(), 0u);
      const Eigen::VectorXd expected = internalForce(box.block, box.nodes);
      EXPECT_LT((internalForce(general, box.nodes) - expected).norm(), 1e-9 * expected.norm());
    }
}

TEST(Elements, MassesSumToDensityTimesVolume) {
  const Mesh mesh = testMesh({2, 2, 3}, false);
  const ElementBlock block = makeElements(mesh, ElementType::hex8, StVenantKirchhoff{young, 0.3, 700.0});
  Nodes nodes = makeNodes(mesh);
  addLumpedMass(block, nodes);
  const double mass = 700.0 * 0.9 * 1.1 * 0.7;
  EXPECT_NEAR(std::accumulate(nodes.mass.begin(), nodes.mass.end(), 0.0), mass, 1e-12 * mass);
  EXPECT_NEAR(*std::min_element(nodes.mass.begin(), nodes.mass.end()), mass / 12.0 / 8.0, 1e-12 * mass);
}

TEST(Elements, ConsistentMassIsExactForLinearVelocities) {
  const Mesh mesh = testMesh({2, 2, 3}, true);
  const ElementBlock block = makeElements(mesh, ElementType::hex8, StVenantKirchhoff{young, 0.3, 700.0});
  Nodes nodes = makeNodes(mesh);
  addLumpedMass(block, nodes);
  const Eigen::MatrixXd M = dense(consistentMass(block));
  EXPECT_LT((M - M.transpose()).norm(), 1e-14 * M.norm());
  for (std::size_t n = 0; n < nodes.mass.size(); ++n)
    EXPECT_NEAR(M.row(static_cast<Eigen::Index>(3 * n)).sum(), nodes.mass[n], 1e-13);
}

TEST(Elements, ConsistentMassOfABarInLinearMotion) {
  const Mesh mesh = boxMesh({1, 1, 5}, {}, {1.0, 1.0, 3.0});
  const ElementBlock block = makeElements(mesh, ElementType::hex8, StVenantKirchhoff{young, 0.3, 2.0});
  Eigen::VectorXd v = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * mesh.X.size()));
  for (std::size_t n = 0; n < mesh.X.size(); ++n) v[static_cast<Eigen::Index>(3 * n)] = mesh.X[n].z;
  EXPECT_NEAR(v.dot(dense(consistentMass(block)) * v), 2.0 * 9.0, 1e-12);  // ρ ∫ z² dz
}

TEST(Elements, InvertedElementsAreNamed) {
  for (const ElementType type : bothTypes)
    for (const bool distorted : {false, true}) {
      const Mesh mesh = testMesh({2, 3, 3}, distorted);
      const ElementBlock block = makeElements(mesh, type, StVenantKirchhoff{young, 0.3, 1.0});
      Nodes nodes = makeNodes(mesh);
      setRandom(nodes.u, 0.03, 8);
      EXPECT_NO_THROW(requireValid(block, nodes, "now"));
      // The far corner of the last element is pushed through the opposite one.
      const auto& last = mesh.elements.back();
      const auto far = static_cast<std::size_t>(last[6]), near = static_cast<std::size_t>(last[0]);
      nodes.u[far] = 2.0 * (mesh.X[near] - mesh.X[far]);
      try {
        requireValid(block, nodes, "step 7");
        FAIL();
      } catch (const NumericalError& error) {
        EXPECT_NE(std::string(error.what()).find("element 17"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("step 7"), std::string::npos);
      }
      nodes.u[far].x = std::numeric_limits<double>::quiet_NaN();
      EXPECT_THROW(requireValid(block, nodes, "now"), NumericalError);
    }
}

TEST(Elements, ForeignNodesAreRefused) {
  Case test = randomCase(ElementType::hex8, StVenantKirchhoff{young, 0.3, 1.0}, false, 1);
  Nodes others = makeNodes(testMesh({1, 1, 1}, false));
  EXPECT_THROW(addInternalForces(test.block, others), InputError);
  EXPECT_THROW(strainEnergy(test.block, others), InputError);
  EXPECT_THROW(tangent(test.block, others), InputError);
  EXPECT_THROW(addLumpedMass(test.block, others), InputError);
}

}  // namespace
}  // namespace dovetail::fem
