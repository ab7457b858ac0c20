#include <gtest/gtest.h>

#include "../../../src/fem/mesh/shapes.hpp"
#include "dovetail/core/vec3.hpp"
#include "helpers.hpp"

namespace dovetail::fem::detail {
namespace {

constexpr std::array allFaces = {FaceShape::quad4, FaceShape::quad8, FaceShape::quad9, FaceShape::tri3,
                                 FaceShape::tri6};

struct Functions {
  std::vector<double> value;
  std::vector<Vec3> gradient;
  Functions(ElementShape shape, const Vec3& xi)
      : value(static_cast<std::size_t>(nodesOf(shape))), gradient(static_cast<std::size_t>(nodesOf(shape))) {
    shapeFunctions(shape, xi, value, gradient);
  }
};

TEST(Shapes, AreOneAtTheirOwnNodeAndZeroAtTheOthers) {
  for (const ElementShape shape : allCellShapes) {
    const auto nodes = parentNodes(shape);
    for (std::size_t b = 0; b < nodes.size(); ++b) {
      const Functions at(shape, nodes[b]);
      for (std::size_t a = 0; a < nodes.size(); ++a) EXPECT_NEAR(at.value[a], a == b ? 1.0 : 0.0, 1e-14);
    }
  }
}

TEST(Shapes, SumToOneAndTheirGradientsAreTheirDerivatives) {
  std::mt19937 random(3);
  for (const ElementShape shape : allCellShapes)
    for (int trial = 0; trial < 5; ++trial) {
      const Vec3 xi = randomVec3(random, 0.9);
      const Functions here(shape, xi);
      double sum = 0.0;
      for (const double value : here.value) sum += value;
      EXPECT_NEAR(sum, 1.0, 1e-13);
      for (int j = 0; j < 3; ++j) {
        Vec3 step;
        step[j] = 1e-6;
        const Functions plus(shape, xi + step), minus(shape, xi - step);
        for (std::size_t a = 0; a < here.value.size(); ++a)
          EXPECT_NEAR(here.gradient[a][j], (plus.value[a] - minus.value[a]) / 2e-6, 1e-8);
      }
    }
}

TEST(Shapes, OfBricksAreThereOnTheirOwnToo) {
  std::mt19937 random(4);
  const Vec3 xi = randomVec3(random, 0.9);
  const Functions at(ElementShape::hex8, xi);
  for (std::size_t a = 0; a < 8; ++a) {
    EXPECT_NEAR(shapeValues(xi)[a], at.value[a], 1e-15);
    EXPECT_LT(norm(parentGradients(xi)[a] - at.gradient[a]), 1e-15);
  }
}

/// ∫ ξ^i η^j ζ^k over the parent cell, of plane cells at ζ = 0.
double monomial(ElementShape shape, int i, int j, int k) {
  const auto factorial = [](int n) { return std::tgamma(n + 1.0); };
  if (isTet(shape)) return factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
  double product = 1.0;
  for (const int n : {i, j}) product *= n % 2 ? 0.0 : 2.0 / (n + 1);
  if (dimensionOf(shape) == 2) return k == 0 ? product : 0.0;
  return k % 2 ? 0.0 : product * 2.0 / (k + 1);
}

void expectExact(const CellRule& rule, ElementShape shape, int degree) {
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j)
      for (int k = 0; i + j + k <= degree; ++k) {
        double sum = 0.0;
        for (std::size_t q = 0; q < rule.point.size(); ++q)
          sum += rule.weight[q] * std::pow(rule.point[q].x, i) * std::pow(rule.point[q].y, j) *
                 std::pow(rule.point[q].z, k);
        EXPECT_NEAR(sum, monomial(shape, i, j, k), 1e-14) << i << j << k;
      }
}

TEST(Quadrature, IsExactToItsDegree) {
  const auto expectForces = [](ElementShape shape, int degree) { expectExact(forceRule(shape), shape, degree); };
  expectForces(ElementShape::hex8, 3);
  expectForces(ElementShape::hex20, 5);
  expectForces(ElementShape::tet4, 1);
  expectForces(ElementShape::tet10, 2);
  expectForces(ElementShape::quad4, 3);
  expectForces(ElementShape::quad8, 5);
  expectExact(reducedRule(ElementShape::quad8), ElementShape::quad8, 3);
  for (const ElementShape shape : allCellShapes) {
    expectExact(massRule(shape), shape, isTet(shape) ? 4 : 5);
    expectExact(centreRule(shape), shape, 1);
  }
}

TEST(FaceShapes, AgreeWithTheCellOnItsFaces) {
  for (const ElementShape shape : allCellShapes) {
    const CellFaces& faces = facesOf(shape);
    const auto nodes = parentNodes(shape);
    const auto n = static_cast<std::size_t>(nodesOf(faces.shape));
    std::vector<double> value(n), byXi(n), byEta(n);
    for (const auto& face : faces.node) {
      faceFunctions(faces.shape, 0.3, 0.2, value, byXi, byEta);
      Vec3 xi, tangentXi, tangentEta;
      for (std::size_t a = 0; a < n; ++a) {
        const Vec3& X = nodes[static_cast<std::size_t>(face[a])];
        xi += value[a] * X;
        tangentXi += byXi[a] * X;
        tangentEta += byEta[a] * X;
      }
      const Functions cell(shape, xi);
      for (std::size_t a = 0; a < n; ++a) EXPECT_NEAR(cell.value[static_cast<std::size_t>(face[a])], value[a], 1e-13);
      const Vec3 centre = isTet(shape) ? Vec3{0.25, 0.25, 0.25} : Vec3{};
      if (dimensionOf(shape) == 2) tangentEta += Vec3{0, 0, 1};
      EXPECT_GT(dot(cross(tangentXi, tangentEta), xi - centre), 0.0);
    }
  }
}

TEST(FaceQuadrature, IsExactToDegreeTwo) {
  for (const FaceShape shape : allFaces) {
    const FaceRule& rule = faceRule(shape);
    const bool triangle = shape == FaceShape::tri3 || shape == FaceShape::tri6;
    for (int i = 0; i <= 2; ++i)
      for (int j = 0; i + j <= 2; ++j) {
        double sum = 0.0;
        for (std::size_t q = 0; q < rule.point.size(); ++q)
          sum += rule.weight[q] * std::pow(rule.point[q][0], i) * std::pow(rule.point[q][1], j);
        const double exact = triangle ? std::tgamma(i + 1.0) * std::tgamma(j + 1.0) / std::tgamma(i + j + 3.0)
                                      : monomial(ElementShape::quad4, i, j, 0);
        EXPECT_NEAR(sum, exact, 1e-14);
      }
  }
}

TEST(FaceQuadrature, OfLinesIsExactToDegreeThreeAndFive) {
  for (const auto& [shape, degree] : {std::pair(FaceShape::line2, 3), {FaceShape::line3, 5}}) {
    const FaceRule& rule = faceRule(shape);
    for (int i = 0; i <= degree; ++i) {
      double sum = 0.0;
      for (std::size_t q = 0; q < rule.point.size(); ++q) sum += rule.weight[q] * std::pow(rule.point[q][0], i);
      EXPECT_NEAR(sum, i % 2 ? 0.0 : 2.0 / (i + 1), 1e-14);
    }
  }
}

}  // namespace
}  // namespace dovetail::fem::detail
