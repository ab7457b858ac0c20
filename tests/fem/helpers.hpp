// Meshes, states and thread counts for the tests.
#pragma once

#include <Eigen/Dense>
#include <random>

#include "../threads.hpp"
#include "dovetail/fem/model/model.hpp"

namespace dovetail::fem {

inline Vec3 randomVec3(std::mt19937& random, double amplitude) {
  std::uniform_real_distribution<double> value(-amplitude, amplitude);
  const double x = value(random), y = value(random), z = value(random);
  return {x, y, z};
}

/// A box of 0.9 × 1.1 × 0.7 m of hex8; if `distorted`, every node is moved by up to 15 % of the element size.
inline SolidMesh testMesh(std::array<int, 3> counts, bool distorted, unsigned seed = 1) {
  SolidMesh mesh = boxOf(ElementShape::hex8, counts, {0.1, -0.2, 0.3}, {1.0, 0.9, 1.0});
  std::mt19937 random(seed);
  if (distorted)
    for (Vec3& X : mesh.X) {
      const Vec3 move = randomVec3(random, 0.15);
      X += {move.x * 0.9 / counts[0], move.y * 1.1 / counts[1], move.z * 0.7 / counts[2]};
    }
  return mesh;
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

/// Displacements of all components that are not held.
inline void setRandomDisplacement(Nodes& nodes, double amplitude, unsigned seed) {
  setRandom(nodes.u, amplitude, seed);
  for (std::size_t n = 0; n < nodes.u.size(); ++n)
    for (int c = 0; c < 3; ++c)
      if (nodes.fixed[n] >> c & 1) nodes.u[n][c] = 0.0;
}

/// Cells of a box: one layer if they are plane.
inline std::array<int, 3> layered(ElementShape shape, std::array<int, 3> cells) {
  if (dimensionOf(shape) == 2) cells[2] = 1;
  return cells;
}

/// A gradient that does not move plane cells out of their plane.
inline Eigen::Matrix3d inPlane(ElementShape shape, Eigen::Matrix3d F) {
  if (dimensionOf(shape) == 3) return F;
  F.row(2) = Eigen::RowVector3d(0, 0, 1);
  F.col(2) = Eigen::Vector3d(0, 0, 1);
  return F;
}

inline Eigen::VectorXd flat(const std::vector<Vec3>& field) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(3 * field.size()));
  for (std::size_t n = 0; n < field.size(); ++n)
    for (int c = 0; c < 3; ++c) result[static_cast<Eigen::Index>(3 * n) + c] = field[n][c];
  return result;
}

}  // namespace dovetail::fem
