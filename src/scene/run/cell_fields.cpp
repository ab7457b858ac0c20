#include "cell_fields.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "dovetail/core/archive.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/rve_archive.hpp"
#include "point_means.hpp"
#include "warnings/warnings.hpp"

namespace dovetail::scene {

namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// ½ ln F Fᵀ
Eigen::Matrix3d logarithmicStrain(const Eigen::Matrix3d& F) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> b(F * F.transpose());
  return b.eigenvectors() * (0.5 * b.eigenvalues().array().log()).matrix().asDiagonal() * b.eigenvectors().transpose();
}

CellMeasures measured(const rve::Rve& cell) {
  const rve::Balance balance = rve::balance(cell);
  return {.voidRatio = 1.0 / rve::solidFraction(cell) - 1.0,
          .coordination = balance.coordination,
          .sliding = balance.contacts > 0 ? static_cast<double>(balance.sliding) / balance.contacts : 0.0,
          .fabric = rve::fabric(cell),
          .cauchy = rve::stress(cell).cauchy};
}

/// Calls act(element, X, volume, cell) for all points with a cell.
template <class Act>
void forEachCell(const fem::Model& model, Act&& act) {
  forEachSolid(model, [&](const fem::Solid& solid, const fem::Solid::Sample& sample) {
    const fem::PointField* const field = solid.field();
    if (!field) return;
    for (std::size_t p = 0; p < sample.element.size(); ++p)
      hierarchical::visitCell(
          *field, p, [&](const rve::Rve& cell) { act(sample.element[p], sample.X[p], sample.volume[p], cell); });
  });
}

}  // namespace

CellMeasures& CellMeasures::operator+=(const CellMeasures& other) {
  voidRatio += other.voidRatio, coordination += other.coordination, sliding += other.sliding;
  fabric += other.fabric, cauchy += other.cauchy;
  return *this;
}

CellMeasures CellMeasures::operator*(double factor) const {
  return {factor * voidRatio, factor * coordination, factor * sliding, factor * fabric, factor * cauchy};
}

double CellMeasures::pressure(int dimension) const {
  return -cauchy.topLeftCorner(dimension, dimension).trace() / dimension;
}

double CellMeasures::stressRatio(int dimension) const {
  const Eigen::MatrixXd part = -cauchy.topLeftCorner(dimension, dimension);
  const Eigen::VectorXd principal = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(part).eigenvalues();
  const double least = principal[0], most = principal[dimension - 1];
  return most + least > 0.0 ? (most - least) / (most + least) : 0.0;
}

std::vector<MeshField> elementStrains(const fem::Model& model, std::size_t elements) {
  Means strain(elements, 9), volume(elements, 1), shear(elements, 1);
  forEachSolid(model, [&](const fem::Solid&, const fem::Solid::Sample& sample) {
    for (std::size_t p = 0; p < sample.element.size(); ++p) {
      const RowMajor e = logarithmicStrain(Eigen::Map<const RowMajor>(&sample.F[9 * p]));
      const double trace = e.trace();
      const double gamma = std::sqrt(2.0) * (e - trace / 3.0 * RowMajor::Identity()).norm();
      strain.add(sample.element[p], sample.volume[p], e.data());
      volume.add(sample.element[p], sample.volume[p], &trace);
      shear.add(sample.element[p], sample.volume[p], &gamma);
    }
  });
  return {{"strain", strain.take(), 9}, {"volume_strain", volume.take()}, {"shear_strain", shear.take()}};
}

std::vector<MeshField> elementCells(const fem::Model& model, std::size_t elements) {
  Means scalars[] = {{elements, 1}, {elements, 1}, {elements, 1}};
  Means fabric(elements, 9);
  bool any = false;
  forEachCell(model, [&](int element, const Vec3&, double weight, const rve::Rve& cell) {
    const CellMeasures now = measured(cell);
    const RowMajor rows = now.fabric;
    scalars[0].add(element, weight, &now.voidRatio);
    scalars[1].add(element, weight, &now.coordination);
    scalars[2].add(element, weight, &now.sliding);
    fabric.add(element, weight, rows.data());
    any = true;
  });
  if (!any) return {};
  return {{"void_ratio", scalars[0].take()},
          {"coordination", scalars[1].take()},
          {"sliding", scalars[2].take()},
          {"fabric", fabric.take(), 9}};
}

CellMeasures meanOfCells(const fem::Model& model, const Vec3* at, int& dimension) {
  CellMeasures sum;
  double weights = 0.0, nearest = std::numeric_limits<double>::infinity();
  forEachCell(model, [&](int, const Vec3& X, double volume, const rve::Rve& cell) {
    dimension = cell.dimension();
    if (!at) {
      sum += measured(cell) * volume;
      weights += volume;
    } else if (const double distance = squaredNorm(X - *at); distance < nearest) {
      sum = measured(cell);
      weights = 1.0;
      nearest = distance;
    }
  });
  if (weights == 0.0) throw InputError("the solid has no cells of grains", "", "leave the probe out");
  return sum * (1.0 / weights);
}

namespace {

std::string lineOn(const std::string& name, const std::vector<rve::Rve>& cells) {
  const rve::Rve& first = cells.front();
  return "cells \"" + name + "\": " + std::to_string(cells.size()) + " of " + std::to_string(first.size()) +
         (first.shape == rve::Shape::disc ? " discs" : " spheres") + ", solid fraction " +
         rounded(rve::solidFraction(first)) + ", " + rounded(rve::balance(first).coordination) +
         " contacts per grain, pressure " + rounded(rve::stress(first).pressure) + " Pa";
}

}  // namespace

std::vector<std::string> linesOnCells(const Built& built) {
  std::vector<std::string> lines;
  for (const auto& [name, cells] : built.cells)
    if (!cells.empty()) lines.push_back(lineOn(name, cells));
  for (std::size_t s = 0; s < built.run->solids(); ++s) {
    std::size_t points = 0, grains = 0, bytes = 0;
    forEachCell(*built.run->solid(s).model, [&](int, const Vec3&, double, const rve::Rve& cell) {
      if (points == 0) {
        ByteWriter state;
        rve::writeState(cell, cell.state, state);
        bytes = 2 * state.bytes().size();  // as committed, and as asked
      }
      ++points;
      grains += cell.size();
    });
    if (points > 0)
      lines.push_back("solid \"" + built.run->solid(s).name + "\": " + std::to_string(points) + " points with " +
                      std::to_string(grains) + " grains, " + rounded(static_cast<double>(bytes * points) / 1048576.0) +
                      " MiB");
  }
  return lines;
}

}  // namespace dovetail::scene
