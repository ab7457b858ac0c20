// Meshes, states and a dense static solver for the tests.
#pragma once

#include <Eigen/Dense>
#include <random>

#include "dovetail/fem/elements/elements.hpp"

namespace dovetail::fem {

inline const ElementType bothTypes[] = {ElementType::hex8, ElementType::hybrid8};

inline Vec3 randomVec3(std::mt19937& random, double amplitude) {
  std::uniform_real_distribution<double> value(-amplitude, amplitude);
  const double x = value(random), y = value(random), z = value(random);
  return {x, y, z};
}

/// A box of 0.9 × 1.1 × 0.7 m; if `distorted`, every node is moved by up to 15 % of the element size.
inline Mesh testMesh(std::array<int, 3> counts, bool distorted, unsigned seed = 1) {
  Mesh mesh = boxMesh(counts, {0.1, -0.2, 0.3}, {1.0, 0.9, 1.0});
  std::mt19937 random(seed);
  if (distorted)
    for (Vec3& X : mesh.X) {
      const Vec3 move = randomVec3(random, 0.15);
      X += {move.x * 0.9 / counts[0], move.y * 1.1 / counts[1], move.z * 0.7 / counts[2]};
    }
  return mesh;
}

inline double volumeOf(const ElementBlock& block) {
  Nodes nodes;
  nodes.mass.assign(block.nodeCount(), 0.0);
  addLumpedMass(block, nodes);
  double sum = 0.0;
  for (const double mass : nodes.mass) sum += mass;
  return sum / density(block.material());
}

/// u = (F − 1) X + shift.
inline void setAffine(Nodes& nodes, const Eigen::Matrix3d& F, const Vec3& shift = {}) {
  const Eigen::Matrix3d H = F - Eigen::Matrix3d::Identity();
  for (std::size_t n = 0; n < nodes.X.size(); ++n) {
    const Eigen::Vector3d u = H * Eigen::Vector3d(nodes.X[n].x, nodes.X[n].y, nodes.X[n].z);
    nodes.u[n] = Vec3{u[0], u[1], u[2]} + shift;
  }
}

inline void setRandom(std::vector<Vec3>& field, double amplitude, unsigned seed) {
  std::mt19937 random(seed);
  for (Vec3& value : field) value = randomVec3(random, amplitude);
}

/// Volume mean of the first Piola–Kirchhoff stress, from −Σ f ⊗ X = ∫ P dV.
inline Eigen::Matrix3d meanFirstStress(const ElementBlock& block, Nodes& nodes) {
  clearForces(nodes);
  addInternalForces(block, nodes);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  for (std::size_t n = 0; n < nodes.f.size(); ++n)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) P(i, j) -= nodes.f[n][i] * nodes.X[n][j];
  return P / volumeOf(block);
}

inline Eigen::MatrixXd dense(const SparseMatrix& A) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(A.size, A.size);
  for (int column = 0; column < A.size; ++column)
    for (int k = A.offsets[static_cast<std::size_t>(column)]; k < A.offsets[static_cast<std::size_t>(column) + 1]; ++k)
      result(A.row[static_cast<std::size_t>(k)], column) = A.value[static_cast<std::size_t>(k)];
  return result;
}

inline Eigen::VectorXd flat(const std::vector<Vec3>& field) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(3 * field.size()));
  for (std::size_t n = 0; n < field.size(); ++n)
    for (int c = 0; c < 3; ++c) result[static_cast<Eigen::Index>(3 * n) + c] = field[n][c];
  return result;
}

inline std::vector<Eigen::Index> freeDofs(const Nodes& nodes) {
  std::vector<Eigen::Index> dofs;
  for (std::size_t n = 0; n < nodes.X.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (!(nodes.fixed[n] >> c & 1)) dofs.push_back(static_cast<Eigen::Index>(3 * n) + c);
  return dofs;
}

/// Newton's method for f_int(u) = load; returns the norm of the last residual over that of the first.
inline double solveStatics(const ElementBlock& block, Nodes& nodes, const std::vector<Vec3>& load, int iterations) {
  const std::vector<Eigen::Index> dofs = freeDofs(nodes);
  double first = 0.0, last = 0.0;
  for (int i = 0; i <= iterations; ++i) {
    nodes.f = load;
    addInternalForces(block, nodes);
    const Eigen::VectorXd residual = flat(nodes.f)(dofs);
    last = residual.norm();
    if (i == 0) first = last;
    if (i == iterations) break;
    const Eigen::VectorXd step = dense(tangent(block, nodes))(dofs, dofs).ldlt().solve(residual);
    for (std::size_t k = 0; k < dofs.size(); ++k)
      nodes.u[static_cast<std::size_t>(dofs[k] / 3)][static_cast<int>(dofs[k] % 3)] +=
          step[static_cast<Eigen::Index>(k)];
  }
  return last / first;
}

}  // namespace dovetail::fem
