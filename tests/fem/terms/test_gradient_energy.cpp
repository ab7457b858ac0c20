// The energy of the gradient of F: identities at random states, exact values of polynomials and waves.
#include <gtest/gtest.h>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/gradient_energy.hpp"
#include "solid_helpers.hpp"
#include "term_checks.hpp"

namespace dovetail::fem {
namespace {

constexpr double D = 300.0;
constexpr std::array shapes = {ElementShape::quad4, ElementShape::quad8, ElementShape::hex8};

/// 4 × 3 (× 3) elements, smoothly distorted.
SolidMesh bentMesh(ElementShape shape) {
  SolidMesh mesh = boxOf(shape, layered(shape, {4, 3, 3}), {0.1, -0.2, 0.3}, {1.0, 0.4, 1.0});
  for (Vec3& X : mesh.X) {
    X.x += 0.05 * std::sin(3.0 * X.y);
    X.y += 0.06 * X.x * X.x;
    if (dimensionOf(shape) == 3) X.z += 0.04 * std::sin(2.0 * X.x + X.y);
  }
  return mesh;
}

std::vector<double> unevenFraction(const SolidMesh& mesh) {
  std::vector<double> fraction;
  for (const Vec3& X : mesh.X) fraction.push_back(std::clamp(1.5 * X.x - 0.4, 0.0, 1.0));
  return fraction;
}

/// Calls check(term, model) for every shape, with and without fractions.
template <class Check>
void forEachTerm(Check&& check) {
  for (const ElementShape shape : shapes)
    for (const bool weighted : {false, true}) {
      SCOPED_TRACE(std::string(name(shape)) + (weighted ? " weighted" : ""));
      const SolidMesh mesh = bentMesh(shape);
      Model model = makeModel(mesh);
      const auto term =
          gradientEnergy(mesh, {.modulus = D, .fraction = weighted ? unevenFraction(mesh) : std::vector<double>{}});
      setRandomDisplacement(model.nodes, 0.02, 7);
      check(*term, model);
    }
}

TEST(GradientEnergy, ForceIsItsNegativeGradientAndTheTangentSymmetric) {
  forEachTerm([](Term& term, Model& model) {
    expectForceFromEnergy(term, model.nodes, {}, 1e-7);
    expectTangents(term, model.nodes, {}, 1e-7);
    const Eigen::MatrixXd K = dense(tangentOf(term, model.nodes));
    EXPECT_LT((K - K.transpose()).norm(), 1e-12 * K.norm());
    EXPECT_GT(K.norm(), 0.0);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, Eigen::EigenvaluesOnly);
    EXPECT_GT(solver.eigenvalues()[0], -1e-12 * solver.eigenvalues().tail(1)[0]);
  });
}

TEST(GradientEnergy, UniformGradientsHaveNoForce) {
  forEachTerm([](Term& term, Model& model) {
    const double scale = largest(forcesOf(term, model.nodes));  // of random u of 0.02 m
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() +
                              0.02 * inPlane(ElementShape::quad4, Eigen::Matrix3d{{1, 2, 0}, {-1, 3, 0}, {0, 0, 1}});
    setAffine(model.nodes, F, {0.01, 0.02, 0.0});
    EXPECT_LT(largest(forcesOf(term, model.nodes)), 1e-12 * scale);
    EXPECT_LT(std::abs(term.energy(model.nodes, {})), 1e-12 * scale * 0.02);
  });
}

TEST(GradientEnergy, TurnsWithTheBodyWithoutSumOrMoment) {
  forEachTerm([](Term& term, Model& model) {
    const std::vector<Vec3> before = forcesOf(term, model.nodes);
    const double energy = term.energy(model.nodes, {});
    const auto [force, moment] = resultant(model.nodes, before);
    double all = 0.0;
    for (const Vec3& f : before) all += norm(f);
    EXPECT_LT(norm(force), 1e-12 * all);
    EXPECT_LT(norm(moment), 1e-12 * all);
    const double c = std::cos(1.0), s = std::sin(1.0);
    const auto turned = [&](const Vec3& x) { return Vec3{c * x.x - s * x.y, s * x.x + c * x.y, x.z}; };
    for (std::size_t n = 0; n < before.size(); ++n)
      model.nodes.u[n] = turned(model.nodes.X[n] + model.nodes.u[n]) - model.nodes.X[n];
    const std::vector<Vec3> after = forcesOf(term, model.nodes);
    for (std::size_t n = 0; n < before.size(); ++n)
      EXPECT_LT(norm(after[n] - turned(before[n])), 1e-12 * largest(before)) << "node " << n;
    EXPECT_NEAR(term.energy(model.nodes, {}), energy, 1e-12 * energy);
  });
}

TEST(GradientEnergy, ConservingForcesDoTheWorkOfTheEnergy) {
  forEachTerm([](Term& term, Model& model) {
    const std::vector<Vec3> u0 = model.nodes.u;
    const double before = term.energy(model.nodes, {});
    setRandomDisplacement(model.nodes, 0.05, 8);
    std::vector<Vec3> f(u0.size()), motion = model.nodes.u;
    ASSERT_TRUE(term.addConservingForces(model.nodes, u0, {}, f));
    for (std::size_t n = 0; n < motion.size(); ++n) motion[n] -= u0[n];
    const double after = term.energy(model.nodes, {});
    EXPECT_NEAR(productOf(f, motion), before - after, 1e-12 * std::max(before, after));
  });
}

// ---- exact values

/// Energy of u(X) in n (× m × k) cubes of edge h.
template <class Field>
double energyOf(ElementShape shape, std::array<int, 3> cells, double h, Field&& field) {
  const SolidMesh mesh = boxOf(shape, layered(shape, cells), {}, {h * cells[0], h * cells[1], h * cells[2]});
  Model model = makeModel(mesh);
  for (std::size_t n = 0; n < mesh.X.size(); ++n) model.nodes.u[n] = field(mesh.X[n]);
  return gradientEnergy(mesh, {.modulus = D})->energy(model.nodes, {});
}

/// Sides, edges and corners drop out of differences by one element in each direction.
TEST(GradientEnergy, IsExactForQuadraticDisplacementsAwayFromBorders) {
  const double h = 0.1;
  std::mt19937 random(3);
  for (const ElementShape shape : shapes) {
    const bool spatial = dimensionOf(shape) == 3;
    std::array<std::array<double, 6>, 3> a{};
    for (auto& row : a)
      for (double& value : row) value = randomVec3(random, 1.0).x;
    const auto field = [&](const Vec3& X) {
      Vec3 u;
      for (int i = 0; i < (spatial ? 3 : 2); ++i) {
        const auto& b = a[static_cast<std::size_t>(i)];
        u[i] = 0.5 * (b[0] * X.x * X.x + b[1] * X.y * X.y) + b[3] * X.x * X.y;
        if (spatial) u[i] += 0.5 * b[2] * X.z * X.z + b[4] * X.y * X.z + b[5] * X.z * X.x;
      }
      return u;
    };
    double expected = 0.0;  // |∇F|²
    for (const auto& b : a) {
      expected += b[0] * b[0] + b[1] * b[1] + 2.0 * b[3] * b[3];
      if (spatial) expected += b[2] * b[2] + 2.0 * (b[4] * b[4] + b[5] * b[5]);
      if (!spatial && &b == &a[1]) break;
    }
    double found = 0.0;
    for (int x = 0; x < 2; ++x)
      for (int y = 0; y < 2; ++y)
        for (int z = 0; z < (spatial ? 2 : 1); ++z) {
          const int sign = (x + y + z + (spatial ? 3 : 2)) % 2 == 0 ? 1 : -1;
          found += sign * energyOf(shape, {3 + x, 3 + y, spatial ? 3 + z : 1}, h, field);
        }
    const double volume = spatial ? h * h * h : h * h * h;  // plane cells are h thick
    EXPECT_NEAR(found, 0.5 * D * expected * volume, 1e-11 * energyOf(shape, {4, 4, 4}, h, field)) << name(shape);
  }
}

TEST(GradientEnergy, LosesOneLayerInNOfALinearShear) {
  const double h = 0.1, slope = 0.3;
  for (const int n : {4, 8, 16})
    EXPECT_NEAR(energyOf(ElementShape::quad4, {1, n, 1}, h,
                         [&](const Vec3& X) {
                           return Vec3{0.5 * slope * X.y * X.y, 0, 0};
                         }),
                0.5 * D * slope * slope * n * h * h * h * (1.0 - 1.0 / n), 1e-10 * D * slope * slope * n * h * h * h);
}

/// Waves of whole periods; what borders do drops out of the difference of lengths by a period.
double densityOfPeriod(ElementShape shape, int period, double h, const std::function<double(double)>& u) {
  const auto field = [&](const Vec3& X) { return Vec3{u(X.y / h), 0, 0}; };
  return (energyOf(shape, {1, 4 * period, 1}, h, field) - energyOf(shape, {1, 3 * period, 1}, h, field)) /
         (period * h * h * h);
}

TEST(GradientEnergy, EveryWaveOfTheGradientHasItsStiffness) {
  const double h = 0.1;
  for (const int period : {2, 3, 4, 7}) {
    const double kh = 2.0 * std::numbers::pi / period, phase = 0.4;
    // F_e = cos(kh (e + ½) + phase) between nodes e and e + 1
    const auto u = [&](double e) { return h * std::sin(kh * e + phase) / (2.0 * std::sin(0.5 * kh)); };
    double squares = 0.0;
    for (int e = 0; e < period; ++e) squares += std::pow(std::cos(kh * (e + 0.5) + phase), 2) / period;
    const double stiffness = 4.0 * D * std::pow(std::sin(0.5 * kh), 2) / (h * h);
    EXPECT_NEAR(densityOfPeriod(ElementShape::quad4, period, h, u), 0.5 * stiffness * squares, 1e-11 * D / (h * h))
        << "period " << period;
  }
}

TEST(GradientEnergy, CheckerboardsAreNotFree) {
  const double h = 0.1, F = 0.02;
  const auto zigzag = [&](double e) { return 0.5 * h * F * (std::lround(e) % 2 == 0 ? -1.0 : 1.0); };
  EXPECT_NEAR(densityOfPeriod(ElementShape::quad4, 2, h, zigzag), 0.5 * 4.0 * D / (h * h) * F * F,
              1e-12 * 4.0 * D / (h * h) * F * F);
  // F from + to − at the two points of each quad8
  const double point = 0.5 / std::sqrt(3.0);
  const auto arch = [&](double e) {
    const double s = e - std::floor(e);
    return 0.5 * h * F / point * (s - s * s);
  };
  EXPECT_NEAR(densityOfPeriod(ElementShape::quad8, 2, h, arch), 0.5 * 8.0 * D / (h * h) * F * F,
              1e-12 * 8.0 * D / (h * h) * F * F);
}

TEST(GradientEnergy, OfALayerOfBricksIsThatOfPlaneElements) {
  const auto field = [](const Vec3& X) { return Vec3{std::sin(9.0 * X.y), std::sin(7.0 * X.x + X.y), 0.0}; };
  const auto energyIn = [&](ElementShape shape, double thickness) {
    const SolidMesh mesh = boxOf(shape, {4, 5, 1}, {}, {0.5, 0.625, thickness});
    Model model = makeModel(mesh);
    for (std::size_t n = 0; n < mesh.X.size(); ++n) model.nodes.u[n] = field(mesh.X[n]);
    return gradientEnergy(mesh, {.modulus = D})->energy(model.nodes, {});
  };
  for (const double thickness : {0.02, 1.0}) {
    const double plane = energyIn(ElementShape::quad4, thickness);
    EXPECT_NEAR(energyIn(ElementShape::hex8, thickness), plane, 1e-12 * plane);
  }
}

// ---- explicit steps

/// A solid of these elements with a gradient of modulus D, with masses.
Model gradientSolid(ElementShape shape, double modulus) {
  const SolidMesh mesh = bentMesh(shape);
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, std::make_shared<PlainNeoHookean>(2e6, 1e6),
                      {.formulation = shape == ElementShape::quad8 ? Formulation::reduced : Formulation::standard}));
  model.add(gradientEnergy(mesh, {.modulus = modulus}));
  addMass(model);
  return model;
}

/// Once the gradient decides, its bound is that of the assembled model but for what Gershgorin's circles overestimate.
TEST(GradientEnergy, HasASayInTheStableStep) {
  for (const ElementShape shape : shapes)
    for (const double modulus : {1.0, 1e3, 1e6}) {
      SCOPED_TRACE(std::string(name(shape)) + ", D = " + std::to_string(modulus));
      Model model = gradientSolid(shape, modulus);
      const StableStep bound = stableStep(model);
      const double exact = assembledStableStep(model, 1e-6);
      EXPECT_LE(bound.dt, exact);
      EXPECT_GT(bound.dt, 0.7 * exact);
      if (modulus < 1e6) continue;
      EXPECT_NE(bound.owner.find("gradient"), std::string::npos) << bound.owner;
      EXPECT_EQ(bound.solid, "gradient of F");
      EXPECT_GE(bound.node, 0);
      try {
        ExplicitIntegrator(model, 1.001 * bound.dt);
        ADD_FAILURE() << "the step is too long";
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("gradient"), std::string::npos) << error.what();
      }
    }
}

TEST(GradientEnergy, KeepsAnExplicitRunAtItsBoundStable) {
  for (const ElementShape shape : shapes) {
    Model model = gradientSolid(shape, 1e6);
    setRandom(model.nodes.v, 1e-3, 4);
    for (Vec3& v : model.nodes.v)
      if (dimensionOf(shape) == 2) v.z = 0.0;
    ExplicitIntegrator run(model, 0.999 * stableStep(model).dt);
    const double before = run.kineticEnergy();
    run.run(2000);
    EXPECT_LT(run.kineticEnergy(), 3.0 * before) << name(shape);
    EXPECT_GT(run.ledger().joules("gradient of F"), 0.0);
    EXPECT_LT(run.ledger().largestResidual(), 0.5 * before);
  }
}

TEST(GradientEnergy, RefusesWhatItCannotDo) {
  const auto why = [](const SolidMesh& mesh, const GradientOptions& options) {
    try {
      gradientEnergy(mesh, options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  for (const ElementShape shape : allCellShapes)
    if (std::ranges::find(shapes, shape) == shapes.end()) {
      EXPECT_NE(why(boxOf(shape, {2, 2, 2}, {}, {1, 1, 1}), {.modulus = D}).find(name(shape)), std::string::npos);
    }
  const SolidMesh mesh = boxOf(ElementShape::quad4, {2, 2, 1}, {}, {1, 1, 1});
  EXPECT_NE(why(mesh, {.modulus = 0.0}).find("modulus"), std::string::npos);
  EXPECT_NE(why(mesh, {.modulus = -1.0}).find("modulus"), std::string::npos);
  EXPECT_NE(why(mesh, {.modulus = D, .fraction = {0.5}}).find("fractions"), std::string::npos);
  EXPECT_THROW(bandWidth(1.0, 0.0, 1.0), InputError);
}

}  // namespace
}  // namespace dovetail::fem
