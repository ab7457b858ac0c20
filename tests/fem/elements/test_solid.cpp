#include <gtest/gtest.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "../../../src/fem/mesh/shapes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

double largest(const std::vector<Vec3>& field) {
  double result = 0.0;
  for (const Vec3& value : field) result = std::max({result, std::abs(value.x), std::abs(value.y), std::abs(value.z)});
  return result;
}

template <class Check>
void forEachSolid(Check&& check) {
  for (const SolidKind& kind : allSolidKinds())
    for (const bool distorted : {false, true}) {
      SCOPED_TRACE(kind.label() + (distorted ? " distorted" : ""));
      SolidScene scene = solidScene(kind, distorted);
      check(scene);
    }
}

TEST(Solid, ForceIsMinusTheGradientOfTheEnergy) {
  forEachSolid([](SolidScene& scene) {
    Nodes& nodes = scene.model.nodes;
    setRandom(nodes.u, 0.04, 7);
    const std::vector<Vec3> f = forcesOf(*scene.solid, nodes);
    std::mt19937 random(5);
    for (int trial = 0; trial < 6; ++trial) {
      const std::size_t n = random() % nodes.u.size();
      const int c = static_cast<int>(random() % 3);
      const double step = 1e-6, before = nodes.u[n][c];
      nodes.u[n][c] = before + step;
      const double plus = scene.solid->energy(nodes, {});
      nodes.u[n][c] = before - step;
      const double minus = scene.solid->energy(nodes, {});
      nodes.u[n][c] = before;
      EXPECT_NEAR(f[n][c], -(plus - minus) / (2.0 * step), 1e-6 * largest(f));
    }
  });
}

TEST(Solid, TangentIsMinusTheDerivativeOfTheForceAndSymmetric) {
  forEachSolid([](SolidScene& scene) {
    Nodes& nodes = scene.model.nodes;
    setRandom(nodes.u, 0.04, 11);
    const Eigen::MatrixXd K = dense(tangentOf(*scene.solid, nodes));
    EXPECT_LT((K - K.transpose()).norm(), 1e-9 * K.norm());
    std::mt19937 random(5);
    for (int trial = 0; trial < 4; ++trial) {
      const std::size_t n = random() % nodes.u.size();
      const int c = static_cast<int>(random() % 3);
      const double step = 1e-6, before = nodes.u[n][c];
      nodes.u[n][c] = before + step;
      const Eigen::VectorXd plus = flat(forcesOf(*scene.solid, nodes));
      nodes.u[n][c] = before - step;
      const Eigen::VectorXd minus = flat(forcesOf(*scene.solid, nodes));
      nodes.u[n][c] = before;
      const Eigen::VectorXd expected = -(plus - minus) / (2.0 * step);
      EXPECT_LT((K.col(static_cast<Eigen::Index>(3 * n) + c) - expected).norm(), 1e-6 * expected.norm());
    }
  });
}

TEST(Solid, ForcesAndTheirMomentsVanish) {
  forEachSolid([](SolidScene& scene) {
    Nodes& nodes = scene.model.nodes;
    setRandomDisplacement(nodes, 0.05, 3);
    const std::vector<Vec3> f = forcesOf(*scene.solid, nodes);
    Vec3 sum, moment;
    for (std::size_t n = 0; n < f.size(); ++n) {
      sum += f[n];
      moment += cross(nodes.X[n] + nodes.u[n], f[n]);
    }
    EXPECT_LT(norm(sum), 1e-11 * largest(f));
    EXPECT_LT(norm(moment), 1e-9 * largest(f));
  });
}

TEST(Solid, RigidMotionIsFreeOfForce) {
  forEachSolid([&](SolidScene& scene) {
    const bool plane = dimensionOf(scene.solid->shape()) == 2;
    const Eigen::Vector3d axis = plane ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(1.0, -2.0, 0.5).normalized();
    setAffine(scene.model.nodes, Eigen::AngleAxisd(1.7, axis).toRotationMatrix(), {0.3, -2.0, plane ? 0.0 : 1.0});
    EXPECT_LT(largest(forcesOf(*scene.solid, scene.model.nodes)), 1e-9 * 1e6);
    EXPECT_LT(std::abs(scene.solid->energy(scene.model.nodes, {})), 1e-9 * 1e6);
  });
}

/// The patch test: an affine state gives the stress of the law at every point, and no force at inner nodes.
TEST(Solid, PatchTestAtSmallAndFiniteStrain) {
  Eigen::Matrix3d small = Eigen::Matrix3d::Identity(), finite = small;
  small += 1e-4 * (Eigen::Matrix3d() << 1.0, 0.4, -0.2, 0.3, -0.7, 0.5, 0.1, 0.6, 0.2).finished();
  finite(0, 0) = 1.3;
  finite(0, 1) = 0.4;
  for (const SolidKind& kind : allSolidKinds())
    for (const Eigen::Matrix3d& F : {small, finite}) {
      SCOPED_TRACE(kind.label());
      SolidScene scene = solidScene(kind, true);
      Nodes& nodes = scene.model.nodes;
      setAffine(nodes, inPlane(kind.shape, F));
      const std::vector<Vec3> f = forcesOf(*scene.solid, nodes);
      const Solid::Sample sample = scene.solid->sample(nodes, {});
      Eigen::Matrix3d P;
      for (int k = 0; k < 9; ++k) P(k / 3, k % 3) = sample.P[static_cast<std::size_t>(k)];
      double volume = 0.0;
      for (std::size_t p = 0; p < sample.volume.size(); ++p) {
        volume += sample.volume[p];
        for (int k = 0; k < 9; ++k)
          EXPECT_NEAR(sample.P[9 * p + static_cast<std::size_t>(k)], P(k / 3, k % 3), 1e-11 * P.norm() + 1e-8);
      }
      if (dimensionOf(kind.shape) == 2) P(2, 2) = 0.0;  // no node feels it
      // −Σ f ⊗ X = P V, and Σ over any boundary node is what the stress gives; inner nodes balance.
      Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
      for (std::size_t n = 0; n < f.size(); ++n)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) mean(i, j) -= f[n][i] * nodes.X[n][j];
      EXPECT_LT((mean / volume - P).norm(), 1e-10 * P.norm() + 1e-8);
    }
}

/// Moves inner corners at random and puts all other nodes where straight edges and flat faces want them.
void moveInnerCorners(SolidMesh& mesh, const std::vector<bool>& outside) {
  const ElementShape shape = mesh.groups[0].shape;
  const bool tet = detail::isTet(shape), plane = dimensionOf(shape) == 2;
  const ElementShape linear = plane ? ElementShape::quad4 : tet ? ElementShape::tet4 : ElementShape::hex8;
  const auto n = static_cast<std::size_t>(nodesOf(shape)), corners = static_cast<std::size_t>(nodesOf(linear));
  std::mt19937 random(2);
  std::vector<bool> done(mesh.X.size(), false);
  std::vector<int>& node = mesh.groups[0].node;
  for (std::size_t k = 0; k < node.size(); ++k) {
    const auto here = static_cast<std::size_t>(node[k]);
    if (k % n >= corners || outside[here] || done[here]) continue;
    mesh.X[here] += randomVec3(random, 0.12);
    if (plane) mesh.X[here].z = mesh.X[0].z;
    done[here] = true;
  }
  std::vector<double> value(corners);
  std::vector<Vec3> gradient(corners);
  for (std::size_t first = 0; first < node.size(); first += n)
    for (std::size_t a = corners; a < n; ++a) {
      shapeFunctions(linear, parentNodes(shape)[a], value, gradient);
      Vec3 X;
      for (std::size_t c = 0; c < corners; ++c) X += value[c] * mesh.X[static_cast<std::size_t>(node[first + c])];
      mesh.X[static_cast<std::size_t>(node[first + a])] = X;
    }
}

TEST(Solid, InnerNodesOfADistortedPatchBalance) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 0) = 1.3;
  F(0, 1) = 0.4;
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    SolidMesh mesh = boxOf(kind.shape, layered(kind.shape, {2, 2, 2}), {}, {1.0, 1.0, 1.0});
    std::vector<bool> outside(mesh.X.size(), false);
    for (const int n : nodeSet(mesh, "skin")) outside[static_cast<std::size_t>(n)] = true;
    moveInnerCorners(mesh, outside);
    Model model = makeModel(mesh);
    const auto solid = makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6), {.formulation = kind.formulation});
    setAffine(model.nodes, F);
    const std::vector<Vec3> f = forcesOf(*solid, model.nodes);
    for (std::size_t n = 0; n < f.size(); ++n)
      if (!outside[n]) {
        EXPECT_LT(norm(f[n]), 1e-10 * largest(f));
      }
  }
}

/// Six; in a plane two translations and a turn there and, free here, the translation along z.
TEST(Solid, StiffnessAtRestHasTheZeroModesOfRigidMotion) {
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    SolidMesh mesh = testSolidMesh(kind.shape, true);
    // The first element alone.
    mesh.elementSets["one"] = {0};
    const auto solid = makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6),
                                 {.formulation = kind.formulation, .elementSet = "one"});
    Model model = makeModel(mesh);
    const Eigen::MatrixXd K = dense(tangentOf(*solid, model.nodes));
    const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues();
    const Eigen::Index dofs = 3 * nodesOf(kind.shape);
    const double top = values[values.size() - 1];
    const auto stiff = std::count_if(values.begin(), values.end(), [&](double v) { return v > 1e-7 * top; });
    EXPECT_GT(values[0], -1e-12 * top);
    // hex20 with 3×3×3 points and tet10 with 4 points (24 strains) have no spurious modes either.
    const bool plane = dimensionOf(kind.shape) == 2, spurious = plane && kind.formulation == Formulation::reduced;
    EXPECT_EQ(stiff, dofs - (plane ? 4 : 6) - spurious);
  }
}

TEST(Solid, ConservingForcesDoExactlyTheWorkOfTheEnergy) {
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    SolidScene scene = solidScene(kind, true);
    Nodes& nodes = scene.model.nodes;
    for (const double size : {0.03, 1e-3, 1e-4}) {
      setRandomDisplacement(nodes, 0.03, 3);
      const std::vector<Vec3> start = nodes.u;
      const double before = scene.solid->energy(nodes, {});
      std::vector<Vec3> change(nodes.u.size());
      setRandom(change, size, 4);
      for (std::size_t n = 0; n < change.size(); ++n)
        for (int c = 0; c < dimensionOf(kind.shape); ++c) nodes.u[n][c] += change[n][c];
      const double after = scene.solid->energy(nodes, {});
      std::vector<Vec3> f(nodes.u.size());
      ASSERT_TRUE(scene.solid->addConservingForces(nodes, start, {}, f));
      double work = 0.0;
      Vec3 sum, moment;
      for (std::size_t n = 0; n < f.size(); ++n) {
        work += dot(f[n], nodes.u[n] - start[n]);
        sum += f[n];
        moment += cross(nodes.X[n] + 0.5 * (start[n] + nodes.u[n]), f[n]);
      }
      EXPECT_NEAR(work, before - after, 1e-12 * before);
      EXPECT_LT(norm(sum), 1e-11 * largest(f));
      EXPECT_LT(norm(moment), 1e-10 * largest(f));
    }
  }
}

TEST(Solid, ConservingTangentIsTheDerivativeWhereTheStepIsSmall) {
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    SolidScene scene = solidScene(kind, true);
    Nodes& nodes = scene.model.nodes;
    setRandom(nodes.u, 0.03, 3);
    const std::vector<Vec3> start = nodes.u;
    linalg::MatrixPattern pattern(nodes.u.size());
    scene.solid->addPattern(pattern);
    linalg::BlockMatrix K(std::move(pattern));
    scene.solid->addConservingTangent(nodes, start, {}, K);
    // At u = u₀ it is half the tangent of the force.
    const Eigen::MatrixXd expected = 0.5 * dense(tangentOf(*scene.solid, nodes));
    EXPECT_LT((dense(K) - expected).norm(), 1e-10 * expected.norm());
  }
}

TEST(Solid, DigitsDoNotDependOnTheNumberOfThreads) {
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    // Just enough cells that the loops are cut into chunks.
    std::array counts{12, 12, 6};
    if (kind.shape == ElementShape::hex8) counts = {13, 13, 13};
    if (kind.shape == ElementShape::tet10) counts = {7, 7, 6};
    if (kind.shape == ElementShape::quad4) counts = {66, 66, 1};
    if (kind.shape == ElementShape::quad8) counts = {47, 47, 1};
    const SolidMesh mesh = boxOf(kind.shape, counts, {}, {1.0, 1.0, 2.0});
    const auto compute = [&](int count) {
      setThreads(count);
      Model model = makeModel(mesh);
      const auto solid =
          makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6), {.formulation = kind.formulation});
      setRandom(model.nodes.u, 0.002, 9);
      const linalg::BlockMatrix K = tangentOf(*solid, model.nodes);
      auto f = forcesOf(*solid, model.nodes);
      const double energy = solid->energy(model.nodes, {});
      setThreads(1);
      return std::tuple(f, std::vector(K.values().begin(), K.values().end()), energy);
    };
    const auto one = compute(1);
    EXPECT_TRUE(one == compute(2));
    EXPECT_TRUE(one == compute(3));
  }
}

TEST(Solid, MassesSumToThatOfTheBody) {
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    const SolidMesh mesh = boxOf(kind.shape, layered(kind.shape, {2, 1, 2}), {}, {2.0, 1.0, 0.5});
    const auto solid =
        makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6, 700.0), {.formulation = kind.formulation});
    std::vector<double> lumped(mesh.X.size());
    solid->addMass(lumped);
    double sum = 0.0;
    for (const double m : lumped) {
      EXPECT_GT(m, 0.0);
      sum += m;
    }
    EXPECT_NEAR(sum, 700.0, 1e-9);
    EXPECT_NEAR(massMatrixOf(*solid, mesh.X.size()).sum(), 700.0, 1e-9);
  }
}

TEST(Solid, AnElasticSolidStoresNoHistoryAndInvertedElementsAreNamed) {
  SolidScene scene = solidScene({ElementShape::hex8, Formulation::standard}, false);
  EXPECT_EQ(scene.solid->material()->historySize(), 0u);
  scene.solid->requireValid(scene.model.nodes, "t = 0 s", Scrutiny::all);
  Nodes& nodes = scene.model.nodes;
  for (std::size_t n = 0; n < nodes.X.size(); ++n)
    if (nodes.X[n].x > 0.9) nodes.u[n].x = 0.35 - nodes.X[n].x;
  try {
    scene.solid->requireValid(nodes, "t = 0.5 s", Scrutiny::all);
    FAIL();
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("element 1"), std::string::npos) << error.what();
  }
}

#ifdef __GLIBC__
TEST(Solid, MemoryIsWhatIsTakenFromTheHeap) {
  const auto inUse = [] {
    const struct mallinfo2 heap = mallinfo2();
    return heap.uordblks + heap.hblkhd;
  };
  if (inUse() == 0) GTEST_SKIP() << "this heap does not count";
  for (const SolidKind& kind : allSolidKinds()) {
    SCOPED_TRACE(kind.label());
    const bool plane = dimensionOf(kind.shape) == 2;
    const SolidMesh mesh = boxOf(kind.shape, {16, plane ? 32 : 8, plane ? 1 : 8}, {}, {1.0, 1.0, 1.0});
    Model model = makeModel(mesh);
    linalg::BlockMatrix K = zeroTangent(sceneOf(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6)).model);
    const std::size_t before = inUse();
    const auto solid = makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6), {.formulation = kind.formulation});
    solid->addForces(model.nodes, {}, model.nodes.f);
    solid->addTangent(model.nodes, {}, K);
    const auto taken = static_cast<double>(inUse() - before);
    EXPECT_NEAR(static_cast<double>(solid->memory()), taken, 0.02 * taken);
  }
}
#endif

TEST(Solid, WrongRequestsAreRefused) {
  const auto material = std::make_shared<PlainNeoHookean>(2e6, 1e6);
  const SolidMesh tets = boxOf(ElementShape::tet4, {1, 1, 1}, {}, {1, 1, 1});
  EXPECT_THROW(makeSolid(tets, material, {.formulation = Formulation::enhanced}), InputError);
  EXPECT_THROW(makeSolid(tets, material, {.elementSet = "nothing"}), InputError);
  EXPECT_THROW(makeSolid(tets, std::shared_ptr<const PointMaterial>{}), InputError);
  SolidScene scene = solidScene({ElementShape::hex8, Formulation::standard}, false);
  Model other = makeModel(tets);
  EXPECT_THROW(forcesOf(*scene.solid, other.nodes), InputError);
}

}  // namespace
}  // namespace dovetail::fem
