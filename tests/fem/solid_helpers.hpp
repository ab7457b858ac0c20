// A hyperelastic law of the tests' own, and solids of every shape and formulation in random states.
#pragma once

#include <Eigen/Dense>
#include <numeric>

#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/laws/point_laws.hpp"
#include "dovetail/fem/model/model.hpp"
#include "dovetail/linalg/block_matrix.hpp"
#include "helpers.hpp"

namespace dovetail::fem {

/// W = ½ μ (tr C − 3 − 2 ln J) + ½ λ (ln J)², point by point.
class PlainNeoHookean : public PointMaterial {
public:
  PlainNeoHookean(double lambda, double mu, double density = 1000.0) : lambda_(lambda), mu_(mu), density_(density) {}
  std::string name() const override { return "plain neo-Hookean"; }
  double density() const override { return density_; }
  void evaluate(const PointBatch& batch) const override {
    for (std::size_t g = 0; g < batch.groups; ++g)
      for (std::size_t l = 0; l < pointLanes; ++l) at(batch, g, l);
  }

private:
  void at(const PointBatch& batch, std::size_t g, std::size_t l) const {
    Eigen::Matrix3d F;
    for (int k = 0; k < 9; ++k) F(k / 3, k % 3) = batch.F[(9 * g + static_cast<std::size_t>(k)) * pointLanes + l];
    const Eigen::Matrix3d T = F.inverse().transpose();
    const double logJ = std::log(F.determinant());
    const Eigen::Matrix3d P = mu_ * (F - T) + lambda_ * logJ * T;
    for (int k = 0; k < 9; ++k) batch.P[(9 * g + static_cast<std::size_t>(k)) * pointLanes + l] = P(k / 3, k % 3);
    if (batch.energy != nullptr)
      batch.energy[pointLanes * g + l] = 0.5 * mu_ * (F.squaredNorm() - 3.0 - 2.0 * logJ) + 0.5 * lambda_ * logJ * logJ;
    if (batch.tangent == nullptr) return;
    for (int p = 0; p < 9; ++p)
      for (int q = 0; q < 9; ++q)
        batch.tangent[(81 * g + static_cast<std::size_t>(9 * p + q)) * pointLanes + l] =
            mu_ * (p == q) + lambda_ * T(p / 3, p % 3) * T(q / 3, q % 3) +
            (mu_ - lambda_ * logJ) * T(q / 3, p % 3) * T(p / 3, q % 3);
  }
  double lambda_, mu_, density_;
};

struct SolidKind {
  ElementShape shape;
  Formulation formulation;
  std::string label() const { return std::string(name(shape)) + " " + name(formulation); }
};

inline const std::vector<SolidKind>& allSolidKinds() {
  static const std::vector<SolidKind> kinds = {
      {ElementShape::hex8, Formulation::standard},        {ElementShape::hex8, Formulation::meanDilatation},
      {ElementShape::hex8, Formulation::enhanced},        {ElementShape::hex8, Formulation::reduced},
      {ElementShape::hex20, Formulation::standard},       {ElementShape::hex27, Formulation::standard},
      {ElementShape::tet4, Formulation::standard},        {ElementShape::tet10, Formulation::standard},
      {ElementShape::hex20, Formulation::meanDilatation}, {ElementShape::hex27, Formulation::meanDilatation},
      {ElementShape::quad4, Formulation::standard},       {ElementShape::quad4, Formulation::meanDilatation},
      {ElementShape::quad8, Formulation::standard},       {ElementShape::quad8, Formulation::meanDilatation},
      {ElementShape::quad8, Formulation::reduced}};
  return kinds;
}
/// Those of three dimensions.
inline std::vector<SolidKind> spatialSolidKinds() {
  std::vector<SolidKind> kinds = allSolidKinds();
  std::erase_if(kinds, [](const SolidKind& kind) { return dimensionOf(kind.shape) == 2; });
  return kinds;
}

/// A box of 2 × 1 × 2 bricks (or their tetrahedra, or one layer of plane cells) around (0.5, 0.1, 0.6), nodes moved a
/// little if distorted.
inline SolidMesh testSolidMesh(ElementShape shape, bool distorted, unsigned seed = 1) {
  SolidMesh mesh = boxOf(shape, layered(shape, {2, 1, 2}), {0.1, -0.2, 0.3}, {1.0, 0.4, 1.0});
  if (!distorted) return mesh;
  // One smooth map of all nodes keeps second-order cells valid.
  std::mt19937 random(seed);
  const Vec3 a = randomVec3(random, 0.08), b = randomVec3(random, 0.08);
  for (Vec3& X : mesh.X)
    X += {a.x * std::sin(3.0 * X.y + X.z) + b.x * X.y * X.z, a.y * std::sin(2.0 * X.z + X.x) + b.y * X.z * X.x,
          dimensionOf(shape) == 2 ? 0.0 : a.z * std::sin(3.0 * X.x - X.y) + b.z * X.x * X.y};
  return mesh;
}

struct SolidScene {
  Model model;
  std::shared_ptr<Solid> solid;
};

/// A model of one solid, without masses yet.
inline SolidScene sceneOf(const SolidMesh& mesh, const std::shared_ptr<const PointMaterial>& material,
                          const SolidOptions& options = {}) {
  SolidScene scene{makeModel(mesh), makeSolid(mesh, material, options)};
  scene.model.add(scene.solid);
  return scene;
}
inline SolidScene sceneOf(const SolidMesh& mesh, Formulation formulation, const Material& law) {
  return sceneOf(mesh, pointMaterial(law), {.formulation = formulation});
}
inline SolidScene solidScene(const SolidKind& kind, bool distorted, double lambda = 2.0e6, double mu = 1.0e6) {
  return sceneOf(testSolidMesh(kind.shape, distorted), std::make_shared<PlainNeoHookean>(lambda, mu),
                 {.formulation = kind.formulation});
}

/// What the hand-written kernels of bricks compute.
inline constexpr std::array brickFormulations = {Formulation::standard, Formulation::assumedStress};

inline double massOf(const Solid& solid, std::size_t nodes) {
  std::vector<double> mass(nodes);
  solid.addMass(mass);
  return std::accumulate(mass.begin(), mass.end(), 0.0);
}
inline double volumeOf(const SolidScene& scene) {
  return massOf(*scene.solid, scene.model.nodes.X.size()) / scene.solid->material()->density();
}

inline std::vector<Vec3> forcesOf(Term& term, const Nodes& nodes) {
  std::vector<Vec3> f(nodes.u.size());
  term.addForces(nodes, {}, f);
  return f;
}

inline Eigen::MatrixXd dense(const linalg::BlockMatrix& A) {
  const auto size = static_cast<Eigen::Index>(3 * A.nodes());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t n = 0; n < A.nodes(); ++n)
    for (int k = A.offsets()[n]; k < A.offsets()[n + 1]; ++k)
      for (int i = 0; i < 9; ++i)
        result(static_cast<int>(3 * n) + i / 3, 3 * A.columns()[static_cast<std::size_t>(k)] + i % 3) =
            A.values()[9 * static_cast<std::size_t>(k) + static_cast<std::size_t>(i)];
  return result;
}

inline Eigen::MatrixXd dense(const linalg::NodeMatrix& A) {
  const auto size = static_cast<Eigen::Index>(A.nodes());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t n = 0; n < A.nodes(); ++n)
    for (int k = A.offsets()[n]; k < A.offsets()[n + 1]; ++k)
      result(static_cast<int>(n), A.columns()[static_cast<std::size_t>(k)]) = A.values()[static_cast<std::size_t>(k)];
  return result;
}

/// The consistent mass of a term, one number per pair of nodes.
inline Eigen::MatrixXd massMatrixOf(const Term& term, std::size_t nodes) {
  linalg::MatrixPattern pattern(nodes);
  term.addPattern(pattern);
  linalg::NodeMatrix M(std::move(pattern));
  term.addConsistentMass(M);
  return dense(M);
}

/// Volume mean of the first Piola–Kirchhoff stress, from −Σ f ⊗ X = ∫ P dV.
inline Eigen::Matrix3d meanFirstStress(const SolidScene& scene) {
  std::vector<Vec3> f(scene.model.nodes.u.size());
  scene.solid->addForces(scene.model.nodes, {}, f);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < f.size(); ++n)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) -= f[n][i] * scene.model.nodes.X[n][j];
  return P / volumeOf(scene);
}

inline linalg::BlockMatrix tangentOf(Term& term, const Nodes& nodes) {
  linalg::MatrixPattern pattern(nodes.u.size());
  term.addPattern(pattern);
  linalg::BlockMatrix K(std::move(pattern));
  term.addTangent(nodes, {}, K);
  return K;
}

}  // namespace dovetail::fem
