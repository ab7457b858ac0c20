// s of an overlap of any shape from Laplace's equation.
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/arlequin/weights.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/mesh/shape.hpp"

namespace dovetail::arlequin {

namespace {

using ElementMatrix = Eigen::Matrix<double, 8, 8>;

/// ∫∇ψ_a·∇ψ_b dV with 2×2×2 Gauss points, m.
ElementMatrix laplacian(const Bricks& mesh, const std::array<int, 8>& element) {
  const double gauss = 1.0 / std::sqrt(3.0);
  ElementMatrix K = ElementMatrix::Zero();
  for (int p = 0; p < 8; ++p) {
    const Vec3 xi{p & 1 ? gauss : -gauss, p & 2 ? gauss : -gauss, p & 4 ? gauss : -gauss};
    const std::array<Vec3, 8> parent = fem::parentGradients(xi);
    Eigen::Matrix<double, 3, 8> gradient;
    Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
    for (std::size_t a = 0; a < 8; ++a)
      for (int i = 0; i < 3; ++i) {
        gradient(i, static_cast<Eigen::Index>(a)) = parent[a][i];
        for (int j = 0; j < 3; ++j) J(i, j) += mesh.X[static_cast<std::size_t>(element[a])][i] * parent[a][j];
      }
    gradient = J.transpose().inverse() * gradient;
    K += J.determinant() * gradient.transpose() * gradient;
  }
  return K;
}

constexpr int unused = -1, fixedZero = -2, fixedOne = -3;

/// Number of the unknown at each node, or why it has none.
std::vector<int> unknowns(const Bricks& mesh, std::span<const int> elements, std::span<const int> zero,
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
    for (const int n : mesh.elements[static_cast<std::size_t>(e)])
      if (row[n] == unused) row[n] = count++;
  return row;
}

}  // namespace

std::vector<double> laplaceCoordinate(const Bricks& mesh, std::span<const int> elements,
                                      std::span<const int> solidBorder, std::span<const int> particleBorder) {
  if (elements.empty() || solidBorder.empty() || particleBorder.empty())
    throw InputError("the elements or a border are missing", "laplaceCoordinate",
                     "give the overlap's elements and a node set for each border");
  int count = 0;
  const std::vector<int> row = unknowns(mesh, elements, solidBorder, particleBorder, count);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(count);
  for (const int e : elements) {
    const std::array<int, 8>& element = mesh.elements[static_cast<std::size_t>(e)];
    const ElementMatrix K = laplacian(mesh, element);
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        const int i = row[element[static_cast<std::size_t>(a)]], j = row[element[static_cast<std::size_t>(b)]];
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
    for (const int n : mesh.elements[static_cast<std::size_t>(e)]) within[n] = true;
  std::vector<double> s(mesh.X.size(), beyondOverlap);
  for (std::size_t n = 0; n < s.size(); ++n) {
    if (!within[n]) continue;
    s[n] = row[n] == fixedZero ? 0.0 : row[n] == fixedOne ? 1.0 : std::clamp(inner[row[n]], 0.0, 1.0);
  }
  return s;
}

}  // namespace dovetail::arlequin
