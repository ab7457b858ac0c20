// Weighted integrals: the solid's fraction of an overlap.
#include <gtest/gtest.h>

#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "solid_helpers.hpp"
#include "term_checks.hpp"

namespace dovetail::fem {
namespace {

const StVenantKirchhoff law{2e6, 0.3, 1200.0};

std::vector<double> slope(const SolidMesh& mesh) {
  std::vector<double> fraction;
  for (const Vec3& X : mesh.X) fraction.push_back(0.2 + 0.5 * X.x);
  return fraction;
}

/// All formulations, those with hand-written kernels too, and the general standard brick.
struct WeightedKind {
  SolidKind kind;
  std::shared_ptr<const PointMaterial> material;
  SolidScene scene(const SolidMesh& mesh, std::vector<double> fraction) const {
    return sceneOf(mesh, material, {.formulation = kind.formulation, .fraction = std::move(fraction)});
  }
};

template <class Check>
void forEachKind(Check&& check) {
  std::vector<WeightedKind> kinds;
  for (const SolidKind& kind : allSolidKinds()) kinds.push_back({kind, pointMaterial(Material(law))});
  kinds.push_back({{ElementShape::hex8, Formulation::assumedStress}, pointMaterial(Material(law))});
  kinds.push_back({{ElementShape::hex8, Formulation::standard}, std::make_shared<PlainNeoHookean>(1e6, 1e6, 1200.0)});
  for (const WeightedKind& kind : kinds) {
    SCOPED_TRACE(kind.kind.label() + ", " + kind.material->name());
    check(kind);
  }
}

double largestDifference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double most = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, norm(a[n] - b[n]));
  return most;
}

TEST(Weighted, ForcesAreMinusTheGradientOfTheEnergyAndTangentsTheirs) {
  forEachKind([](const WeightedKind& kind) {
    for (const bool distorted : {false, true}) {
      const SolidMesh mesh = testSolidMesh(kind.kind.shape, distorted);
      SolidScene scene = kind.scene(mesh, slope(mesh));
      setRandom(scene.model.nodes.u, 0.03, 3);
      expectForceFromEnergy(*scene.solid, scene.model.nodes, {}, 1e-7);
      expectTangents(*scene.solid, scene.model.nodes, {}, 1e-6);
    }
  });
}

/// ∫w ρ N_a = Σ_b w_b ∫ρ N_a N_b for w = Σ w_b N_b.
TEST(Weighted, MassesAreIntegralsOfTheWeightedDensity) {
  forEachKind([](const WeightedKind& kind) {
    const SolidMesh mesh = testSolidMesh(kind.kind.shape, true);
    const std::vector<double> fraction = slope(mesh);
    const SolidScene whole = kind.scene(mesh, {}), part = kind.scene(mesh, fraction);
    const Eigen::MatrixXd M = massMatrixOf(*part.solid, mesh.X.size());
    const Eigen::VectorXd w =
        Eigen::Map<const Eigen::VectorXd>(fraction.data(), static_cast<Eigen::Index>(fraction.size()));
    const Eigen::VectorXd expected = massMatrixOf(*whole.solid, mesh.X.size()) * w;
    EXPECT_LT((M.rowwise().sum() - expected).norm(), 1e-13 * expected.norm());
    EXPECT_LT((M - M.transpose()).norm(), 1e-14 * M.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M, Eigen::EigenvaluesOnly).eigenvalues()[0], 0.0);
    std::vector<double> lumped(mesh.X.size());
    part.solid->addMass(lumped);
    EXPECT_NEAR(std::accumulate(lumped.begin(), lumped.end(), 0.0), expected.sum(), 1e-12 * expected.sum());
    const ElementShape shape = kind.kind.shape;
    const bool scaled = shape == ElementShape::hex20 || shape == ElementShape::tet10 || shape == ElementShape::quad8;
    for (std::size_t n = 0; n < lumped.size(); ++n) {
      EXPECT_GT(lumped[n], 0.0);
      if (!scaled) {
        EXPECT_NEAR(lumped[n], expected[static_cast<Eigen::Index>(n)], 1e-12 * lumped[n]);
      }
    }
  });
}

/// ∫w ∂W/∂F dV of a uniform state, which every point shows.
TEST(Weighted, PatchesHaveTheStressOfTheLawEverywhere) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 0) = 1.3;
  F(0, 1) = 0.4;
  forEachKind([&](const WeightedKind& kind) {
    const SolidMesh mesh = testSolidMesh(kind.kind.shape, true);
    SolidScene scene = kind.scene(mesh, slope(mesh));
    setAffine(scene.model.nodes, F);
    const Solid::Sample sample = scene.solid->sample(scene.model.nodes, {});
    Eigen::Matrix3d P;
    for (int k = 0; k < 9; ++k) P(k / 3, k % 3) = sample.P[static_cast<std::size_t>(k)];
    for (std::size_t p = 0; p < sample.P.size(); ++p)
      EXPECT_NEAR(sample.P[p], P(static_cast<int>(p % 9) / 3, static_cast<int>(p % 3)), 1e-11 * P.norm());
    // Rules of forces and masses differ by their order where sides are curved.
    const double volume = std::accumulate(sample.volume.begin(), sample.volume.end(), 0.0);
    EXPECT_NEAR(volume, volumeOf(scene), 1e-4 * volume);
    if (dimensionOf(kind.kind.shape) == 2) P(2, 2) = 0.0;  // no node feels it
    EXPECT_LT((volumeOf(scene) / volume * meanFirstStress(scene) - P).norm(), 1e-10 * P.norm());
    EXPECT_NEAR(scene.solid->energy(scene.model.nodes, {}), sample.energy[0] * volume,
                1e-10 * sample.energy[0] * volume);
  });
}

TEST(Weighted, TwoSharesMakeTheWhole) {
  forEachKind([](const WeightedKind& kind) {
    const SolidMesh mesh = testSolidMesh(kind.kind.shape, true);
    const std::vector<double> fraction = slope(mesh);
    std::vector<double> rest;
    for (const double w : fraction) rest.push_back(1.0 - w);
    const SolidScene whole = kind.scene(mesh, {}), a = kind.scene(mesh, fraction), b = kind.scene(mesh, rest);
    Nodes nodes = whole.model.nodes;
    // Displacement elements at any state, those with fields of their own where these are uniform.
    if (kind.kind.formulation == Formulation::standard) {
      setRandom(nodes.u, 0.03, 6);
    } else {
      Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
      F(0, 1) = 0.2;
      F(2, 2) = 1.1;
      setAffine(nodes, F);
    }
    const double energy = whole.solid->energy(nodes, {});
    EXPECT_NEAR(a.solid->energy(nodes, {}) + b.solid->energy(nodes, {}), energy, 1e-10 * energy);
    EXPECT_NEAR(volumeOf(a) + volumeOf(b), volumeOf(whole), 1e-12 * volumeOf(whole));
    const std::vector<Vec3> f = forcesOf(*whole.solid, nodes);
    std::vector<Vec3> sum = forcesOf(*a.solid, nodes);
    b.solid->addForces(nodes, {}, sum);
    EXPECT_LT(largestDifference(sum, f), 1e-10 * largest(f));
  });
}

TEST(Weighted, AUniformShareScalesEverythingAndShareOneChangesNoBit) {
  forEachKind([](const WeightedKind& kind) {
    const SolidMesh mesh = testSolidMesh(kind.kind.shape, kind.kind.formulation != Formulation::standard);
    const auto uniform = [&](double fraction) {
      return kind.scene(mesh, std::vector<double>(mesh.X.size(), fraction));
    };
    SolidScene whole = kind.scene(mesh, {}), third = uniform(1.0 / 3.0), one = uniform(1.0);
    for (SolidScene* scene : {&whole, &third, &one}) {
      setRandom(scene->model.nodes.u, 0.02, 5);
      addMass(scene->model);
    }
    const Nodes& nodes = whole.model.nodes;
    const double energy = whole.solid->energy(nodes, {});
    EXPECT_NEAR(third.solid->energy(nodes, {}), energy / 3.0, 1e-12 * energy);
    EXPECT_NEAR(stableStep(third.model).dt, stableStep(whole.model).dt, 1e-9 * stableStep(whole.model).dt);
    const std::vector<Vec3> f = forcesOf(*whole.solid, nodes);
    std::vector<Vec3> scaled = forcesOf(*third.solid, nodes);
    for (Vec3& force : scaled) force *= 3.0;
    EXPECT_LT(largestDifference(scaled, f), 1e-11 * largest(f));
    // Share 1.
    EXPECT_EQ(one.solid->energy(nodes, {}), energy);
    EXPECT_EQ(forcesOf(*one.solid, nodes), f);
    EXPECT_EQ(one.model.nodes.mass, nodes.mass);
    EXPECT_EQ(stableStep(one.model).dt, stableStep(whole.model).dt);
    EXPECT_EQ(dense(tangentOf(*one.solid, nodes)), dense(tangentOf(*whole.solid, nodes)));
    EXPECT_EQ(massMatrixOf(*one.solid, nodes.u.size()), massMatrixOf(*whole.solid, nodes.u.size()));
  });
}

TEST(Weighted, EqualSharesKeepTheFastKernel) {
  const SolidMesh mesh = testMesh({4, 4, 4}, false);
  for (const Formulation formulation : brickFormulations) {
    const auto memory = [&](std::vector<double> fraction) {
      return sceneOf(mesh, pointMaterial(Material(law)), {.formulation = formulation, .fraction = std::move(fraction)})
          .solid->memory();
    };
    EXPECT_LT(memory(std::vector<double>(mesh.X.size(), 0.3)) + 64 * 8 * 60, memory(slope(mesh)));
  }
}

TEST(Weighted, ElementsOfShareZeroAreLeftOut) {
  forEachKind([](const WeightedKind& kind) {
    SolidMesh mesh = testSolidMesh(kind.kind.shape, false);
    std::vector<double> fraction;
    for (const Vec3& X : mesh.X) fraction.push_back(std::max(0.0, X.x - 0.55));  // 0 in the lower half, x ≤ 0.55
    const SolidScene part = kind.scene(mesh, fraction);
    std::vector<int> upper;
    for (std::size_t e = 0; e < mesh.elementCount(); ++e) {
      const ElementGroup& group = mesh.groups[0];
      const auto n = static_cast<std::size_t>(nodesOf(group.shape));
      double sum = 0.0;
      for (std::size_t a = 0; a < n; ++a) sum += fraction[static_cast<std::size_t>(group.node[n * e + a])];
      if (sum > 1e-9) upper.push_back(static_cast<int>(e));
    }
    ASSERT_EQ(part.solid->size(), upper.size());
    ASSERT_EQ(2 * upper.size(), mesh.elementCount());
    for (std::size_t e = 0; e < upper.size(); ++e) EXPECT_EQ(part.solid->number(e), upper[e]);
    mesh.elementSets["upper"] = upper;
    const SolidScene same = sceneOf(
        mesh, kind.material, {.formulation = kind.kind.formulation, .elementSet = "upper", .fraction = fraction});
    Nodes nodes = part.model.nodes;
    setRandom(nodes.u, 0.02, 5);
    EXPECT_EQ(forcesOf(*part.solid, nodes), forcesOf(*same.solid, nodes));
    EXPECT_EQ(part.solid->energy(nodes, {}), same.solid->energy(nodes, {}));
    // Nodes of left-out elements alone: no force, no mass, no place in the matrix.
    const std::vector<Vec3> f = forcesOf(*part.solid, nodes);
    std::vector<double> mass(f.size());
    part.solid->addMass(mass);
    for (std::size_t n = 0; n < f.size(); ++n)
      if (mesh.X[n].x < 0.5) {
        EXPECT_EQ(f[n], Vec3{});
        EXPECT_EQ(mass[n], 0.0);
      }
  });
}

TEST(Weighted, ImpossibleSharesAreRefused) {
  const SolidMesh mesh = testMesh({1, 1, 1}, false);
  const auto make = [&](std::vector<double> fraction) {
    return sceneOf(mesh, pointMaterial(Material(law)), {.fraction = std::move(fraction)});
  };
  EXPECT_THROW(make({0.5, 0.5, 0.5}), InputError);
  EXPECT_THROW(make(std::vector<double>(8, 0.0)), InputError);
  for (const double bad : {-0.1, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    std::vector<double> fraction(8, 0.5);
    fraction[2] = bad;
    EXPECT_THROW(make(fraction), InputError);
  }
}

}  // namespace
}  // namespace dovetail::fem
