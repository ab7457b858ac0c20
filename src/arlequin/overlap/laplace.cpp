// s of an overlap of any shape from Laplace's equation.
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/arlequin/cells.hpp"
#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

namespace {

/// ∫∇ψ_a·∇ψ_b dV of the corners' vertex shape functions, on the cell of first order with these corners, m. Bricks:
/// 2×2×2 Gauss points.
Eigen::MatrixXd laplacian(const fem::SolidMesh& mesh, const Cell& cell) {
  const std::span<const int> node = cell.corner();
  const bool brick = node.size() == 8;
  const fem::ElementShape shape = brick ? fem::ElementShape::hex8 : fem::ElementShape::tet4;
  const double gauss = 1.0 / std::sqrt(3.0), weight = brick ? 1.0 : 1.0 / 6.0;
  const auto count = static_cast<Eigen::Index>(node.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(count, count);
  std::vector<double> value(node.size());
  std::vector<Vec3> parent(node.size());
  for (int p = 0; p < (brick ? 8 : 1); ++p) {
    const Vec3 xi =
        brick ? Vec3{p & 1 ? gauss : -gauss, p & 2 ? gauss : -gauss, p & 4 ? gauss : -gauss} : Vec3{0.25, 0.25, 0.25};
    fem::shapeFunctions(shape, xi, value, parent);
    Eigen::MatrixXd gradient(3, count);
    Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
    for (std::size_t a = 0; a < node.size(); ++a)
      for (int i = 0; i < 3; ++i) {
        gradient(i, static_cast<Eigen::Index>(a)) = parent[a][i];
        for (int j = 0; j < 3; ++j) J(i, j) += mesh.X[static_cast<std::size_t>(node[a])][i] * parent[a][j];
      }
    gradient = J.transpose().inverse() * gradient;
    K += weight * J.determinant() * gradient.transpose() * gradient;
  }
  return K;
}

constexpr int unused = -1, fixedZero = -2, fixedOne = -3;

/// Number of the unknown at each node, or why it has none.
std::vector<int> unknowns(const fem::SolidMesh& mesh, std::span<const int> elements, std::span<const int> zero,
                          std::span<const int> one, int& count) {
  std::vector<int> row(mesh.X.size(), unused);
  count = 0;
  const auto hold = [&](std::span<const int> set, int mark) {
    for (const int n : set) {
      if (n < 0 || static_cast<std::size_t>(n) >= row.size())
        throw InputError("node " + std::to_string(n) + " does not exist", "laplaceCoordinate",
                         "use node numbers of the mesh");
      if (row[n] != unused && row[n] != mark)
        throw InputError("node " + std::to_string(n) + " is on both borders", "laplaceCoordinate",
                         "keep the borders apart: the overlap needs a width");
      row[n] = mark;
    }
  };
  hold(zero, fixedZero);
  hold(one, fixedOne);
  for (const int e : elements)
    for (const int n : cellOf(mesh, e).corner())
      if (row[n] == unused) row[n] = count++;
  return row;
}

}  // namespace

std::vector<double> laplaceCoordinate(const fem::SolidMesh& mesh, std::span<const int> elements,
                                      std::span<const int> solidBorder, std::span<const int> particleBorder) {
  if (elements.empty() || solidBorder.empty() || particleBorder.empty())
    throw InputError("the elements or a border are missing", "laplaceCoordinate",
                     "give the overlap's elements and a node set for each border");
  int count = 0;
  const std::vector<int> row = unknowns(mesh, elements, solidBorder, particleBorder, count);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(count);
  for (const int e : elements) {
    const Cell cell = cellOf(mesh, e);
    const std::span<const int> corner = cell.corner();
    const Eigen::MatrixXd K = laplacian(mesh, cell);
    for (Eigen::Index a = 0; a < K.rows(); ++a)
      for (Eigen::Index b = 0; b < K.rows(); ++b) {
        const int i = row[corner[static_cast<std::size_t>(a)]], j = row[corner[static_cast<std::size_t>(b)]];
        if (i >= 0 && j >= 0) entries.emplace_back(i, j, K(a, b));
        if (i >= 0 && j == fixedOne) load[i] -= K(a, b);
      }
  }
  Eigen::SparseMatrix<double> K(count, count);
  K.setFromTriplets(entries.begin(), entries.end());
  Eigen::VectorXd inner = load;
  if (count > 0) {
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(K);
    if (solver.info() != Eigen::Success)
      throw NumericalError("Laplace's equation has no solution", "laplaceCoordinate",
                           "give elements that are connected with both borders");
    inner = solver.solve(load);
  }
  std::vector<bool> within(mesh.X.size(), false);
  for (const int e : elements)
    for (const int n : cellOf(mesh, e).corner()) within[n] = true;
  std::vector<double> s(mesh.X.size(), beyondOverlap);
  for (std::size_t n = 0; n < s.size(); ++n) {
    if (!within[n]) continue;
    s[n] = row[n] == fixedZero ? 0.0 : row[n] == fixedOne ? 1.0 : std::clamp(inner[row[n]], 0.0, 1.0);
  }
  for (const int e : elements) {
    const Cell cell = cellOf(mesh, e);
    const std::span<const Vec3> place = fem::parentNodes(cell.shape);
    for (std::size_t a = cell.corner().size(); a < cell.node.size(); ++a) {
      const std::vector<double> vertexShape = vertexShapes(cell.shape, place[a]);
      double& mean = s[static_cast<std::size_t>(cell.node[a])] = 0.0;
      for (std::size_t c = 0; c < vertexShape.size(); ++c)
        mean += vertexShape[c] * s[static_cast<std::size_t>(cell.node[c])];
    }
  }
  return s;
}

}  // namespace dovetail::arlequin
