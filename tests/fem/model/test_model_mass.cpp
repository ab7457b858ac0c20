#include <gtest/gtest.h>

#include <numbers>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/model/model_mass.hpp"
#include "dovetail/fem/motion/support_kick.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

const StVenantKirchhoff material{1e6, 0.0, 1000.0};
constexpr std::array fractions = {0.0, 0.4, 1.0};

/// What the free components are restricted by.
enum class Support { none, held, perComponent, tied };

Model modelOf(Support support) {
  const SolidMesh mesh = testMesh({2, 3, 2}, true);
  Model model = sceneOf(mesh, Formulation::standard, material).model;
  addMass(model);
  if (support == Support::held) fix(model.nodes, nodeSet(mesh, "y+"));
  if (support == Support::perComponent || support == Support::tied) {
    fix(model.nodes, nodeSet(mesh, "y+"));
    fix(model.nodes, nodeSet(mesh, "x-"), componentX);
    model.constraints.prescribe(nodeSet(mesh, "y-"), 1, [](double t) { return 0.3 * t * t; });
    model.constraints.hold(nodeSet(mesh, "y-"), componentZ);
  }
  if (support == Support::tied)  // to free, prescribed and fixed components
    model.constraints.ties = {{13, 0, {{17, 0, 0.5}, {16, 1, 0.25}, {0, 1, 0.5}, {11, 0, 2.0}}, 0.0, {}},
                              {20, 2, {{17, 2, -1.0}}, 0.0, {}}};
  return model;
}

constexpr std::array allSupports = {Support::none, Support::held, Support::perComponent, Support::tied};

std::vector<double> reduced(const DofMap& dofs, std::span<const Vec3> f) {
  std::vector<double> r(dofs.size());
  dofs.reduce(f, r);
  return r;
}

std::vector<Vec3> multiplied(const ModelMass& mass, std::span<const Vec3> x) {
  std::vector<Vec3> y(x.size());
  mass.multiply(x, y);
  return y;
}

/// Tᵀ M a = Tᵀ f, with a of the form that the constraints allow.
TEST(ModelMass, SolvesWhatItMultiplies) {
  for (const Support support : allSupports)
    for (const double fraction : fractions) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(support) << ' ' << fraction);
      const Model model = modelOf(support);
      const DofMap dofs(model.constraints, model.nodes);
      const ModelMass mass(model, dofs, fraction);
      EXPECT_EQ(mass.isDiagonal(), fraction == 0.0 && support != Support::tied);
      std::vector<Vec3> f(model.nodes.X.size());
      setRandom(f, 100.0, 7);
      for (int repeat = 0; repeat < 2; ++repeat) {  // factors are made once
        std::vector<Vec3> a = f;
        mass.solve(a);
        const std::vector<double> left = reduced(dofs, multiplied(mass, a)), right = reduced(dofs, f);
        for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 1e-10);
        std::vector<Vec3> allowed = a;
        dofs.applyVelocity(0.0, 0.0, allowed);
        for (std::size_t n = 0; n < a.size(); ++n)
          for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(a[n][c], allowed[n][c], 1e-13);
            if (model.nodes.fixed[n] >> c & 1) {
              EXPECT_EQ(a[n][c], 0.0);
            }
          }
      }
    }
}

/// The same beside prescribed accelerations, which come out as they went in.
TEST(ModelMass, IterationsFindWhatFactorsFind) {
  for (const Support support : allSupports) {
    const Model model = modelOf(support);
    const DofMap dofs(model.constraints, model.nodes);
    const ModelMass direct(model, dofs, 1.0),
        iterative(model, dofs, 1.0, {.method = linalg::LinearMethod::conjugateGradients});
    std::vector<Vec3> f(model.nodes.X.size());
    setRandom(f, 100.0, 7);
    std::vector<Vec3> a = f, b = f;
    direct.solve(a);
    iterative.solve(b);
    double largest = 0.0;
    for (const Vec3& value : a) largest = std::max(largest, norm(value));
    for (std::size_t n = 0; n < a.size(); ++n) EXPECT_LT(norm(a[n] - b[n]), 1e-12 * largest);
  }
}

TEST(ModelMass, AcceleratesBesidePrescribedMotion) {
  for (const Support support : {Support::held, Support::perComponent, Support::tied})
    for (const double fraction : fractions) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(support) << ' ' << fraction);
      const Model model = modelOf(support);
      const DofMap dofs(model.constraints, model.nodes);
      const ModelMass mass(model, dofs, fraction);
      std::vector<Vec3> f(model.nodes.X.size()), given(f.size());
      setRandom(f, 100.0, 7);
      dofs.applyAcceleration(1.0, 1e-2, given);
      std::vector<Vec3> a = given;
      mass.accelerate(f, a);
      const std::vector<double> left = reduced(dofs, multiplied(mass, a)), right = reduced(dofs, f);
      for (std::size_t i = 0; i < left.size(); ++i) EXPECT_NEAR(left[i], right[i], 1e-10);
      std::vector<Vec3> allowed = a;
      dofs.applyAcceleration(1.0, 1e-2, allowed);
      double most = 0.0;
      for (std::size_t n = 0; n < a.size(); ++n) {
        EXPECT_LT(norm(a[n] - allowed[n]), 1e-12);
        most = std::max(most, norm(given[n]));
      }
      EXPECT_NEAR(most, support == Support::held ? 0.0 : 0.6, support == Support::tied ? 0.4 : 1e-9);
    }
}

/// Both momenta change by the kick and by what supports and ties give in it.
TEST(ModelMass, MomentaChangeByLoadAndSupports) {
  constexpr double dt = 1e-2;
  for (const Support support : {Support::none, Support::held, Support::perComponent, Support::tied})
    for (const double fraction : fractions) {
      Model model = modelOf(support);
      const DofMap dofs(model.constraints, model.nodes);
      const ModelMass mass(model, dofs, fraction);
      std::vector<Vec3> f(model.nodes.X.size()), a(f.size());
      setRandom(f, 1.0, 9);
      setRandom(model.nodes.u, 0.1, 10);
      setRandom(model.nodes.v, 1.0, 11);
      dofs.applyAcceleration(1.0, dt, a);
      mass.accelerate(f, a);
      const std::vector<Vec3> before = model.nodes.v;
      const Momenta start = momentaOf(model.nodes, mass), load = dt * momentaOf(model.nodes, f);
      for (std::size_t n = 0; n < a.size(); ++n) model.nodes.v[n] += dt * a[n];
      const SupportKick supports = supportKick(model.nodes, mass, before, f, dt);
      const Momenta left = momentaOf(model.nodes, mass) - start - load - supports.impulse;
      EXPECT_LT(norm(left.linear), 1e-11);
      EXPECT_LT(norm(left.angular), 1e-11);
      double work = supports.work;
      for (std::size_t n = 0; n < f.size(); ++n) work += 0.5 * dt * dot(f[n], before[n] + model.nodes.v[n]);
      EXPECT_NEAR(mass.kineticEnergy(model.nodes.v) - mass.kineticEnergy(before), work, 1e-10);
      EXPECT_EQ(norm(supports.impulse.linear) > 1e-5, support != Support::none);
    }
}

TEST(ModelMass, RowSumsAreTheLumpedMassesAndMatricesTakeIt) {
  const Model model = modelOf(Support::none);
  const DofMap dofs(model.constraints, model.nodes);
  const std::vector<Vec3> ones(model.nodes.X.size(), Vec3{1.0, 2.0, 3.0});
  const double total = std::accumulate(model.nodes.mass.begin(), model.nodes.mass.end(), 0.0);
  for (const double fraction : fractions) {
    const ModelMass mass(model, dofs, fraction);
    const std::vector<Vec3> sums = multiplied(mass, ones);
    for (std::size_t n = 0; n < sums.size(); ++n)
      EXPECT_LT(norm(sums[n] - model.nodes.mass[n] * ones[n]), 1e-11 * model.nodes.mass[n]);
    EXPECT_NEAR(mass.kineticEnergy(ones), 0.5 * total * 14.0, 1e-9 * total);
    std::vector<Vec3> x(ones.size()), y(ones.size());
    setRandom(x, 1.0, 3);
    linalg::BlockMatrix S = zeroTangent(model);
    mass.addTo(S, -2.0);
    S.multiply(x, y);
    const std::vector<Vec3> expected = multiplied(mass, x);
    for (std::size_t n = 0; n < y.size(); ++n) EXPECT_LT(norm(y[n] + 2.0 * expected[n]), 1e-12 * norm(y[n]));
  }
}

TEST(ModelMass, ConsistentMassesAreExactForLinearVelocities) {
  for (const SolidKind& kind : allSolidKinds()) {
    const SolidMesh mesh = boxOf(kind.shape, {1, 3, 1}, {}, {1.0, 3.0, 1.0});
    Model model = sceneOf(mesh, pointMaterial(neoHookean(1e6, 0.3, 2.0)), {.formulation = kind.formulation}).model;
    addMass(model);
    const DofMap dofs(model.constraints, model.nodes);
    for (std::size_t n = 0; n < mesh.X.size(); ++n) model.nodes.v[n].x = mesh.X[n].y;
    EXPECT_NEAR(ModelMass(model, dofs, 1.0).kineticEnergy(model.nodes.v), 9.0, 1e-12) << kind.label();  // ½ρ ∫ y² dy
  }
}

/// Explicit integrators take the step of lumped masses times √(1 − 26/27 share).
TEST(ModelMass, ConsistentMassesAreAtLeastATwentySeventhOfLumpedOnes) {
  for (const ElementShape shape : allCellShapes) {
    const SolidMesh mesh = boxOf(shape, {1, 1, 1}, {}, {1.0, 0.7, 0.5});
    const auto solid = makeSolid(mesh, pointMaterial(neoHookean(1e6, 0.3, 2.0)));
    std::vector<double> lumped(mesh.X.size());
    solid->addMass(lumped);
    const Eigen::VectorXd scale =
        Eigen::Map<const Eigen::VectorXd>(lumped.data(), static_cast<Eigen::Index>(lumped.size()))
            .cwiseSqrt()
            .cwiseInverse();
    const Eigen::MatrixXd M = scale.asDiagonal() * massMatrixOf(*solid, mesh.X.size()) * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(M, Eigen::EigenvaluesOnly);
    EXPECT_GT(solver.eigenvalues()[0], (1.0 - 1e-12) / 27.0) << name(shape);
  }
}

/// ω/(ck) of a standing wave of a bar of n bricks per wave length with M = share · consistent + …
double phaseRatio(double fraction, int perWave) {
  const double h = 0.1;
  SolidScene bar =
      sceneOf(boxOf(ElementShape::hex8, {1, perWave, 1}, {}, {h, perWave * h, h}), Formulation::standard, material);
  Nodes& nodes = bar.model.nodes;
  addMass(bar.model);
  const DofMap dofs(bar.model.constraints, nodes);
  const double k = 2.0 * std::numbers::pi / (perWave * h);
  for (std::size_t n = 0; n < nodes.u.size(); ++n) nodes.u[n].y = 1e-9 * std::cos(k * nodes.X[n].y);
  const double elastic = bar.solid->energy(nodes, {}),
               inertia = ModelMass(bar.model, dofs, fraction).kineticEnergy(nodes.u);
  return std::sqrt(elastic / inertia) / (k * std::sqrt(material.youngsModulus / material.density));
}

TEST(ModelMass, TheMatchedShareGivesTheDispersionOfAChain) {
  for (const int n : {1, 2, 3, 4})
    for (const int perWave : {12, 24}) {
      const double h = 0.1, d = h / n, k = 2.0 * std::numbers::pi / (perWave * h);
      const double chain = std::sin(0.5 * k * d) / (0.5 * k * d);
      const double error = std::abs(phaseRatio(matchedFraction(d, h), perWave) - chain);
      EXPECT_LT(error, 0.2 * std::pow(k * h, 4)) << n;
      if (n > 1) {
        EXPECT_LT(error, 0.2 * std::abs(phaseRatio(0.0, perWave) - chain));
      }
    }
}

TEST(ModelMass, ImpossibleInputIsRefused) {
  Model model = modelOf(Support::none);
  const DofMap dofs(model.constraints, model.nodes);
  EXPECT_THROW(ModelMass(model, dofs, -0.1), InputError);
  EXPECT_THROW(ModelMass(model, dofs, 1.1), InputError);
  linalg::BlockMatrix other((linalg::MatrixPattern(model.nodes.X.size())));
  EXPECT_THROW(ModelMass(model, dofs, 0.5).addTo(other, 1.0), InputError);
  model.nodes.mass[3] = 0.0;
  EXPECT_THROW(ModelMass(model, dofs, 0.5), InputError);
  EXPECT_THROW(matchedFraction(2.0, 1.0), InputError);
  EXPECT_THROW(matchedFraction(0.1, 0.0), InputError);
}

}  // namespace
}  // namespace dovetail::fem
