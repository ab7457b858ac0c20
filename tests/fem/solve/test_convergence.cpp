#include <gtest/gtest.h>

#include "../../../src/fem/mesh/shapes.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/mesh/mesh_shapes.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "solid_helpers.hpp"

namespace dovetail::fem {
namespace {

const NeoHookean rubber{2.0e6, 1.0e6, 1000.0};

/// The motion that is manufactured: strains of up to 0.2; that of z = 0 in plane strain.
Vec3 exactDisplacement(const Vec3& X, int dimension) {
  if (dimension == 2) return {0.05 * std::sin(2.0 * X.x + X.y), 0.04 * std::cos(2.0 * X.y) * X.x, 0.0};
  return {0.05 * std::sin(2.0 * X.x + X.y) + 0.02 * X.z * X.z, 0.04 * std::cos(2.0 * X.y - X.z) * X.x,
          0.05 * std::sin(X.x * X.y + 2.0 * X.z)};
}

Eigen::Matrix3d exactGradient(const Vec3& X, int dimension) {
  constexpr double h = 1e-5;
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  for (int j = 0; j < 3; ++j) {
    Vec3 step;
    step[j] = h;
    const Vec3 slope = (exactDisplacement(X + step, dimension) - exactDisplacement(X - step, dimension)) / (2.0 * h);
    for (int i = 0; i < 3; ++i) F(i, j) += slope[i];
  }
  return F;
}

Eigen::Matrix3d firstStress(const PointMaterial& material, const Eigen::Matrix3d& F) {
  std::array<double, 9 * pointLanes> in{}, out{};
  for (std::size_t k = 0; k < 9; ++k)
    for (std::size_t l = 0; l < pointLanes; ++l)
      in[k * pointLanes + l] = F(static_cast<int>(k) / 3, static_cast<int>(k) % 3);
  material.evaluate({1, in.data(), out.data(), nullptr, nullptr, nullptr, nullptr, nullptr, 0.0});
  Eigen::Matrix3d P;
  for (int k = 0; k < 9; ++k) P(k / 3, k % 3) = out[static_cast<std::size_t>(k) * pointLanes];
  return P;
}

/// −Div P of the exact motion, N/m³.
Vec3 bodyForce(const PointMaterial& material, const Vec3& X, int dimension) {
  constexpr double h = 1e-4;
  Vec3 b;
  for (int j = 0; j < dimension; ++j) {
    Vec3 step;
    step[j] = h;
    const auto stress = [&](const Vec3& at) { return firstStress(material, exactGradient(at, dimension)); };
    const Eigen::Matrix3d slope = (stress(X + step) - stress(X - step)) / (2.0 * h);
    for (int i = 0; i < 3; ++i) b[i] -= slope(i, j);
  }
  return b;
}

/// Calls visit(nodes, ψ, X, dV) at the points of the mass rule of every element.
template <class Visit>
void integrate(const SolidMesh& mesh, Visit&& visit) {
  for (const ElementGroup& group : mesh.groups) {
    const detail::CellRule& rule = detail::massRule(group.shape);
    const auto n = static_cast<std::size_t>(rule.nodes);
    for (std::size_t e = 0; e < group.size(); ++e)
      for (std::size_t q = 0; q < rule.weight.size(); ++q) {
        const auto nodes = std::span(group.node).subspan(n * e, n);
        const auto value = std::span(rule.value).subspan(n * q, n);
        Vec3 X;
        std::array<Vec3, 3> J{Vec3{}, Vec3{}, dimensionOf(mesh) == 2 ? Vec3{0, 0, mesh.thickness} : Vec3{}};
        for (std::size_t a = 0; a < n; ++a) {
          const Vec3& at = mesh.X[static_cast<std::size_t>(nodes[a])];
          X += value[a] * at;
          for (int j = 0; j < 3; ++j) J[static_cast<std::size_t>(j)] += rule.gradient[n * q + a][j] * at;
        }
        visit(nodes, value, X, rule.weight[q] * dot(J[0], cross(J[1], J[2])));
      }
  }
}

/// t ∫ ψ b dV.
class BodyForce : public Term {
public:
  BodyForce(const SolidMesh& mesh, const PointMaterial& material) : force_(mesh.X.size()) {
    integrate(mesh, [&](std::span<const int> nodes, std::span<const double> value, const Vec3& X, double dV) {
      const Vec3 b = bodyForce(material, X, dimensionOf(mesh));
      for (std::size_t a = 0; a < nodes.size(); ++a) force_[static_cast<std::size_t>(nodes[a])] += dV * value[a] * b;
    });
  }
  std::string name() const override { return "body force"; }
  void addForces(const Nodes&, const Instant& now, std::span<Vec3> f) override {
    for (std::size_t n = 0; n < f.size(); ++n) f[n] += now.t * force_[n];
  }

private:
  std::vector<Vec3> force_;
};

/// √∫|u − u_exact|² dV on a bent box of `cells` cells along each edge, with the exact motion on its skin.
double displacementError(const SolidKind& kind, int cells) {
  const int dimension = dimensionOf(kind.shape);
  const std::array counts = layered(kind.shape, {cells, cells, cells});
  const SolidMesh mesh = mappedBox(kind.shape, counts, {}, {1.0, 1.0, 1.0}, [dimension](const Vec3& X) {
    if (dimension == 2) return Vec3{X.x + 0.1 * X.y * X.y, X.y - 0.1 * X.x * X.y, X.z};
    return Vec3{X.x + 0.1 * X.y * X.y, X.y + 0.1 * X.x * X.z, X.z - 0.1 * X.x * X.y};
  });
  const auto material = pointMaterial(rubber);
  Model model = makeModel(mesh);
  model.add(makeSolid(mesh, material, {.formulation = kind.formulation}));
  model.add(std::make_shared<BodyForce>(mesh, *material));
  for (const int n : nodeSet(mesh, "skin"))
    for (int c = 0; c < dimension; ++c) {
      const double target = exactDisplacement(mesh.X[static_cast<std::size_t>(n)], dimension)[c];
      model.constraints.prescribe(std::span(&n, 1), c, [target](double t) { return t * target; });
    }
  solveStatics(model, 1.0, {.firstStep = 1.0});
  double sum = 0.0;
  integrate(mesh, [&](std::span<const int> nodes, std::span<const double> value, const Vec3& X, double dV) {
    Vec3 u;
    for (std::size_t a = 0; a < nodes.size(); ++a) u += value[a] * model.nodes.u[static_cast<std::size_t>(nodes[a])];
    sum += dV * squaredNorm(u - exactDisplacement(X, dimension));
  });
  return std::sqrt(sum);
}

/// Order p + 1 of the displacements for elements of order p at finite strain.
TEST(Convergence, DisplacementsHaveTheOrderOfTheirElements) {
  for (const SolidKind& kind : allSolidKinds()) {
    const bool second = nodesOf(kind.shape) > 8 || kind.shape == ElementShape::quad8,
               plane = dimensionOf(kind.shape) == 2;
    const int coarse = plane ? 8 : second ? 3 : 4, fine = plane ? 16 : second ? 5 : 8;
    const double order = std::log(displacementError(kind, coarse) / displacementError(kind, fine)) /
                         std::log(static_cast<double>(fine) / coarse);
    const double expected = second ? 3.0 : 2.0;
    EXPECT_GT(order, expected - 0.1) << kind.label();
    // Mixed elements come to their order from above.
    EXPECT_LT(order, expected + (second && kind.formulation == Formulation::meanDilatation ? 0.3 : 0.1))
        << kind.label();
  }
}

/// From rest, with an affine motion on the skin of a patch whose inner nodes are out of place, the solution is affine.
TEST(Convergence, PatchesAreSolvedExactly) {
  Eigen::Matrix3d small = Eigen::Matrix3d::Identity(), finite = small;
  small += 1e-4 * (Eigen::Matrix3d() << 1.0, 0.4, -0.2, 0.3, -0.7, 0.5, 0.1, 0.6, 0.2).finished();
  finite(0, 0) = 1.3;
  finite(0, 1) = 0.4;
  for (const SolidKind& kind : allSolidKinds())
    for (const Eigen::Matrix3d& F : {small, finite}) {
      const bool plane = dimensionOf(kind.shape) == 2;
      SolidMesh mesh = boxOf(kind.shape, layered(kind.shape, {2, 2, 2}), {}, {1.0, 1.0, 1.0});
      for (Vec3& X : mesh.X) {
        const double inside = 16.0 * X.x * (1.0 - X.x) * X.y * (1.0 - X.y) * (plane ? 1.0 : 4.0 * X.z * (1.0 - X.z));
        X += inside * Vec3{0.08, -0.06, plane ? 0.0 : 0.07};
      }
      Model model = makeModel(mesh);
      model.add(makeSolid(mesh, pointMaterial(rubber), {.formulation = kind.formulation}));
      Nodes exact = model.nodes;
      setAffine(exact, inPlane(kind.shape, F));
      for (const int n : nodeSet(mesh, "skin"))
        for (int c = 0; c < dimensionOf(kind.shape); ++c)
          model.constraints.prescribe(std::span(&n, 1), c,
                                      [u = exact.u[static_cast<std::size_t>(n)][c]](double t) { return t * u; });
      solveStatics(model, 1.0, {.newton = {.relativeTolerance = 1e-12}, .firstStep = 0.25});
      double size = 0.0, error = 0.0;
      for (std::size_t n = 0; n < mesh.X.size(); ++n) {
        size = std::max(size, norm(exact.u[n]));
        error = std::max(error, norm(exact.u[n] - model.nodes.u[n]));
      }
      EXPECT_LT(error, 1e-9 * size) << kind.label();
    }
}

}  // namespace
}  // namespace dovetail::fem
