#include <cmath>

#include "dovetail/core/error.hpp"
#include "dovetail/fem/laws/history_law.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "point_helpers.hpp"

namespace dovetail::fem {
namespace {

constexpr double young = 3.0e6, nu = 0.3, rho = 1200.0;
const LameConstants lame = lameConstants(young, nu);
using MaterialPointer = std::shared_ptr<const PointMaterial>;

/// A law as a user writes it: fibres along x in a matrix.
struct Fibres {
  double mu, lambda, stiffness;
  template <class T>
  T energy(const Tensor<T>& F) const {
    using std::log;
    const T logJ = log(determinant(F));
    const T stretch = gram(F)[0] - 1.0;
    return 0.5 * mu * (contraction(F, F) - 3.0 - 2.0 * logJ) + 0.5 * lambda * logJ * logJ +
           stiffness * stretch * stretch;
  }
};
/// The same with a branch: fibres bear no compression.
struct Threads : Fibres {
  static constexpr bool branches = true;
  template <class T>
  T energy(const Tensor<T>& F) const {
    const Fibres bare{mu, lambda, gram(F)[0] > 1.0 ? stiffness : 0.0};
    return bare.energy(F);
  }
};

std::vector<MaterialPointer> elasticMaterials() {
  return {pointMaterial(StVenantKirchhoff{young, nu, rho}),
          pointMaterial(AxialSprings{young, rho}),
          pointMaterial(neoHookean(young, nu, rho)),
          pointMaterial(neoHookean(young, 0.49999, rho)),
          pointMaterial(CoupledNeoHookean{lame.lambda, lame.mu, rho}),
          pointMaterial(CoupledNeoHookean{lame.lambda, lame.mu, rho, CoupledNeoHookean::Volume::quadratic}),
          pointMaterial(Hencky{young, nu, rho}),
          elasticMaterial("fibres", rho, Fibres{1e6, 2e6, 5e6}),
          elasticMaterial("threads", rho, Threads{{1e6, 2e6, 5e6}})};
}
std::vector<MaterialPointer> allMaterials() {
  std::vector<MaterialPointer> materials = elasticMaterials();
  materials.push_back(pointMaterial(DeformedMetricHooke{young, nu, rho}));
  return materials;
}

TEST(PointLaws, TangentIsTheDerivativeOfTheStress) {
  std::mt19937 random(1);
  for (const MaterialPointer& material : allMaterials())
    for (int i = 0; i < 20; ++i) {
      const Eigen::Matrix3d F = randomGradient(random, 0.4);
      const Matrix9 tangent = evaluate(*material, F).tangent;
      EXPECT_LT((tangent - differencedTangent(*material, F, {})).norm(), 1e-8 * tangent.norm()) << material->name();
    }
}

TEST(PointLaws, StressIsTheDerivativeOfTheEnergy) {
  std::mt19937 random(2);
  for (const MaterialPointer& material : elasticMaterials()) {
    EXPECT_TRUE(material->isElastic() && material->isSymmetric());
    EXPECT_EQ(material->historySize(), 0u);
    EXPECT_EQ(material->density(), rho);
    for (int i = 0; i < 20; ++i) {
      const Eigen::Matrix3d F = randomGradient(random, 0.4), dF = randomMatrix(random, 1.0);
      const auto difference = [&](double h) {
        return (evaluate(*material, F + h * dF).energy - evaluate(*material, F - h * dF).energy) / (2.0 * h);
      };
      const double rate = (4.0 * difference(5e-5) - difference(1e-4)) / 3.0;
      const PointResult result = evaluate(*material, F);
      EXPECT_NEAR(rate, result.P.cwiseProduct(dF).sum(), 1e-8 * result.tangent.norm()) << material->name();
      EXPECT_LT((result.tangent - result.tangent.transpose()).norm(), 1e-13 * result.tangent.norm());
    }
  }
}

TEST(PointLaws, ALawWithoutPotentialSaysSo) {
  const MaterialPointer material = pointMaterial(DeformedMetricHooke{young, nu, rho});
  EXPECT_FALSE(material->isElastic() || material->isSymmetric());
}

TEST(PointLaws, TurningThePointTurnsTheStress) {
  std::mt19937 random(3);
  for (const MaterialPointer& material : allMaterials())
    for (int i = 0; i < 20; ++i) {
      const Eigen::Matrix3d F = randomGradient(random, 0.4), R = randomRotation(random);
      const PointResult bare = evaluate(*material, F), turned = evaluate(*material, R * F);
      EXPECT_LT((turned.P - R * bare.P).norm(), 1e-12 * bare.tangent.norm()) << material->name();
      EXPECT_NEAR(turned.energy, bare.energy, 1e-12 * bare.tangent.norm());
      EXPECT_LT(evaluate(*material, R).P.norm(), 1e-12 * bare.tangent.norm());
    }
}

TEST(PointLaws, SmallStrainsFollowHooke) {
  std::mt19937 random(4);
  for (const MaterialPointer& material :
       {pointMaterial(StVenantKirchhoff{young, nu, rho}), pointMaterial(DeformedMetricHooke{young, nu, rho}),
        pointMaterial(neoHookean(young, nu, rho)), pointMaterial(CoupledNeoHookean{lame.lambda, lame.mu, rho}),
        pointMaterial(CoupledNeoHookean{lame.lambda, lame.mu, rho, CoupledNeoHookean::Volume::quadratic}),
        pointMaterial(Hencky{young, nu, rho})}) {
    const Eigen::Matrix3d H = randomMatrix(random, 1e-6), strain = 0.5 * (H + H.transpose());
    const Eigen::Matrix3d stress = lame.lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2.0 * lame.mu * strain;
    EXPECT_LT((evaluate(*material, Eigen::Matrix3d::Identity() + H).P - stress).norm(), 1e-5 * stress.norm())
        << material->name();
  }
}

TEST(PointLaws, LanesAgreeWithOneByOne) {
  std::mt19937 random(5);
  for (const MaterialPointer& material : allMaterials()) {
    std::array<Eigen::Matrix3d, 4> F;
    for (Eigen::Matrix3d& f : F) f = randomGradient(random, 0.5);
    const std::array<PointResult, 4> together = evaluateFour(*material, F, {}, 0.0);
    for (std::size_t l = 0; l < 4; ++l) {
      const PointResult alone = evaluate(*material, F[l]);
      EXPECT_EQ(alone.P, together[l].P);
      EXPECT_EQ(alone.tangent, together[l].tangent);
      EXPECT_EQ(alone.energy, together[l].energy);
    }
  }
}

TEST(PointLaws, NeoHookeanOfCooksMembraneInItsOwnForm) {
  const NeoHookean law{915416.6666666666, 422500.0, rho};
  const MaterialPointer material = pointMaterial(law);
  for (const double stretch : {0.05, 0.4, 1.0 + 1e-7, 1.7, 6.0}) {
    // τ = μ J^(−2/3) dev b + κ/2 (J² − 1) 1, P = τ F⁻ᵀ
    const Eigen::Matrix3d F = stretches(stretch, 1.0, 1.0);
    const double side = law.shearModulus * std::pow(stretch, -2.0 / 3.0) * (stretch * stretch - 1.0) / 3.0;
    const double pressure = 0.5 * law.bulkModulus * (stretch * stretch - 1.0);
    const PointResult result = evaluate(*material, F);
    EXPECT_NEAR(result.P(0, 0), (2.0 * side + pressure) / stretch, 1e-12 * result.tangent.norm());
    EXPECT_NEAR(result.P(1, 1), pressure - side, 1e-12 * result.tangent.norm());
    const double shape = std::pow(stretch, -2.0 / 3.0) * (stretch * stretch + 2.0) - 3.0;
    EXPECT_NEAR(
        result.energy,
        0.5 * law.shearModulus * shape + 0.25 * law.bulkModulus * (stretch * stretch - 1.0 - 2.0 * std::log(stretch)),
        1e-12 * result.tangent.norm());
  }
}

TEST(PointLaws, StVenantKirchhoffClosedForms) {
  const MaterialPointer material = pointMaterial(StVenantKirchhoff{young, nu, rho});
  for (const double stretch : {0.8, 1.1, 1.4}) {
    const double change = stretch * stretch - 1.0, side = std::sqrt(1.0 - nu * change);
    const Eigen::Matrix3d P = evaluate(*material, stretches(stretch, side, side)).P;
    EXPECT_NEAR(P(0, 0), young * stretch * change / 2.0, 1e-12 * young);
    EXPECT_NEAR(P(1, 1), 0.0, 1e-12 * young);
    EXPECT_NEAR(evaluate(*material, stretches(1, stretch, 1)).P(1, 1),
                (lame.lambda + 2.0 * lame.mu) * stretch * change / 2.0, 1e-12 * young);
  }
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  const double gamma = F(0, 1) = 0.4;
  EXPECT_NEAR(evaluate(*material, F).P(0, 1), lame.mu * gamma + (lame.lambda / 2.0 + lame.mu) * gamma * gamma * gamma,
              1e-12 * young);
}

TEST(PointLaws, AxialSpringsAreLinearAlongTheAxes) {
  const MaterialPointer material = pointMaterial(AxialSprings{young, rho});
  for (const double stretch : {0.2, 1.0 + 1e-9, 2.0})
    EXPECT_NEAR(evaluate(*material, stretches(1, stretch, 1)).P(1, 1), young * (stretch - 1.0), 1e-12 * young);
}

TEST(PointLaws, HenckyIsLinearInTheLogarithm) {
  const MaterialPointer material = pointMaterial(Hencky{young, nu, rho});
  const Eigen::Matrix3d F = stretches(1.5, 1.5 + 1e-9, 0.7);
  const Eigen::Vector3d strain = F.diagonal().array().log();
  const Eigen::Vector3d stress = lame.lambda * strain.sum() * Eigen::Vector3d::Ones() + 2.0 * lame.mu * strain;
  const PointResult result = evaluate(*material, F);
  EXPECT_LT((result.P.diagonal() - stress.cwiseQuotient(F.diagonal())).norm(), 1e-12 * young);
  EXPECT_NEAR(result.energy, 0.5 * stress.dot(strain), 1e-12 * young);
}

TEST(PointLaws, HenckyTangentWithEqualStretches) {
  const MaterialPointer material = pointMaterial(Hencky{young, nu, rho});
  std::mt19937 random(6);
  const Eigen::Matrix3d R = randomRotation(random), Q = randomRotation(random);
  for (const double apart : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 4e-3, 6e-3, 1e-2, 1.5e-2})
    for (const Eigen::Matrix3d& F :
         {stretches(1.3, 1.3 + apart, 0.8), stretches(1.3, 1.3 + apart, 1.3 - 0.7 * apart)}) {
      const Matrix9 tangent = evaluate(*material, R * F * Q).tangent;
      EXPECT_LT((tangent - differencedTangent(*material, R * F * Q, {}, 0.0, 1e-3)).norm(), 1e-9 * tangent.norm())
          << apart;
    }
}

TEST(PointLaws, FlatPointsHaveAnAnswerAndTurnedOnesHaveNone) {
  for (const MaterialPointer& material : allMaterials()) {
    EXPECT_TRUE(evaluate(*material, stretches(0.05, 1, 1)).tangent.allFinite()) << material->name();
    EXPECT_TRUE(evaluate(*material, stretches(0.4, 0.3, 0.4)).P.allFinite());
    for (const double J : {0.0, -0.3}) {
      const PointResult result = evaluate(*material, stretches(J, 1, 1));
      for (int i = 0; i < 9; ++i) EXPECT_TRUE(std::isnan(result.P(i / 3, i % 3)));
      const std::array<double, 9> F = {J, 0, 0, 0, 1, 0, 0, 0, 1};
      EXPECT_NE(material->whyInvalid(F.data()).find("inside out"), std::string::npos);
    }
  }
}

TEST(PointLaws, StVenantKirchhoffSaysWhenItIsPastItsLimit) {
  const StVenantKirchhoff law{young, nu, rho};
  const MaterialPointer material = pointMaterial(law);
  const double limit = 1.0 / std::sqrt(3.0);
  const auto bar = [](double stretch) {
    const double side = std::sqrt(1.0 - nu * (stretch * stretch - 1.0));
    return std::array<double, 9>{stretch, 0, 0, 0, side, 0, 0, 0, side};
  };
  EXPECT_GT(stiffnessLeft(law, bar(limit * 1.001).data()), 0.0);
  EXPECT_NEAR(stiffnessLeft(law, bar(limit).data()), 0.0, 1e-14);
  EXPECT_LT(stiffnessLeft(law, bar(limit * 0.999).data()), 0.0);
  EXPECT_TRUE(material->whyInvalid(bar(0.6).data()).empty());
  EXPECT_TRUE(material->whyInvalid(bar(1.5).data()).empty());
  EXPECT_NE(material->whyInvalid(bar(0.57).data()).find("limit point"), std::string::npos);
  EXPECT_TRUE(pointMaterial(neoHookean(young, nu, rho))->whyInvalid(bar(0.2).data()).empty());
}

TEST(PointLaws, RefusesImpossibleConstants) {
  EXPECT_THROW(pointMaterial(StVenantKirchhoff{young, 0.5, rho}), InputError);
  EXPECT_THROW(neoHookean(young, 0.5, rho), InputError);
  EXPECT_THROW(neoHookean(-young, 0.2, rho), InputError);
  EXPECT_THROW(pointMaterial(NeoHookean{1e6, 0.0, rho}), InputError);
  EXPECT_THROW(pointMaterial(NeoHookean{std::nan(""), 1e6, rho}), InputError);
  EXPECT_THROW(pointMaterial(NeoHookean{1e6, 1e6, 0.0}), InputError);
  EXPECT_THROW(pointMaterial(CoupledNeoHookean{-1e6, 1e6, rho}), InputError);
  EXPECT_THROW(pointMaterial(Hencky{young, -1.0, rho}), InputError);
}

/// A law with memory as a user writes it: stiffness is lost with the greatest energy so far.
struct Damage {
  Fibres bare;
  double scale;  ///< J/m³
  std::size_t historySize() const { return 1; }
  template <class T>
  void step(PointStep<T>& step) const {
    using std::exp;
    Tensor<Jet<T, 1>> variables;
    for (std::size_t i = 0; i < 9; ++i) variables[i] = Jet<T, 1>::variable(step.F[i], i);
    const Jet<T, 1> W = bare.energy(variables);
    T greatest = step.history[0];
    if (W.value > greatest) greatest = W.value;
    const T intact = exp(-1.0 / scale * greatest);
    step.P = scaled(intact, W.gradient);
    step.newHistory[0] = valueOf(greatest);
    step.energy = valueOf(intact * W.value);
    // −∂(d W)/∂d along d = e^(−m/scale), at the energy of the end
    step.dissipated = valueOf(W.value) * (std::exp(-step.history[0] / scale) - std::exp(-step.newHistory[0] / scale));
  }
};

TEST(HistoryLaws, AUsersLawIsDifferentiatedAndRemembers) {
  const MaterialPointer material = historyMaterial("damage", rho, Damage{{1e6, 2e6, 5e6}, 3e6});
  EXPECT_FALSE(material->isElastic() || material->isSymmetric());
  std::mt19937 random(7);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Matrix3d F = randomGradient(random, 0.4);
    const PointResult first = evaluate(*material, F);
    EXPECT_LT((first.tangent - differencedTangent(*material, F, {0.0})).norm(), 1e-8 * first.tangent.norm());
    EXPECT_GT(first.dissipated, 0.0);
    const Eigen::Matrix3d half = Eigen::Matrix3d::Identity() + 0.2 * (F - Eigen::Matrix3d::Identity());
    if (half.determinant() <= 0.1) continue;
    const PointResult back = evaluate(*material, half, first.history);
    if (evaluate(*material, half).history[0] > first.history[0]) continue;
    EXPECT_EQ(back.history, first.history);
    EXPECT_EQ(back.dissipated, 0.0);
    EXPECT_LT((back.tangent - differencedTangent(*material, half, first.history)).norm(), 1e-8 * back.tangent.norm());
  }
}

TEST(FourDoubles, LogarithmAndExponential) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> exponent(-200.0, 200.0), near(-0.3, 0.3);
  for (int i = 0; i < 20000; ++i) {
    const double x = i % 2 ? exponent(random) : near(random);
    const double y = std::exp(x);
    EXPECT_NEAR(exp(Four(x)).v[1], y, 4.5e-16 * y);
    EXPECT_NEAR(log(Four(y)).v[2], std::log(y), 2.3e-16 * std::abs(std::log(y)));
  }
  EXPECT_EQ(log(Four(1.0)).v[0], 0.0);
  EXPECT_EQ(exp(Four(0.0)).v[0], 1.0);
  EXPECT_TRUE(std::isnan(log(Four(0.0)).v[0]) && std::isnan(log(Four(-1.0)).v[3]));
}

}  // namespace
}  // namespace dovetail::fem
