// Solids whose points own cells of grains.
#pragma once

#include <Eigen/Dense>

#include "../fem/helpers.hpp"
#include "../rve/cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/elements/solid.hpp"
#include "dovetail/fem/model/checkpoint.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/hierarchical/cell_field.hpp"
#include "dovetail/rve/operators.hpp"

namespace dovetail::hierarchical {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

inline Eigen::Matrix3d matrixAt(const std::vector<double>& values, std::size_t point) {
  return Eigen::Map<const RowMajor>(values.data() + 9 * point);
}

/// Three cells of 60 discs at rest under 100 kPa.
inline const std::vector<rve::Rve>& threeCells() {
  static const std::vector<rve::Rve> cells{rve::pressedDiscs(60, 4), rve::pressedDiscs(60, 5),
                                           rve::pressedDiscs(60, 6)};
  return cells;
}
inline std::vector<rve::Rve> oneCell() { return {threeCells()[0]}; }

/// 0.1 m × 0.2 m, pressed together along y at `rate` m/s under a side pressure of 100 kPa that follows.
struct Biaxial {
  fem::SolidMesh mesh;
  fem::Model model;
  std::shared_ptr<fem::Solid> solid;

  Biaxial(std::array<int, 2> elements, std::shared_ptr<fem::PointField> field,
          fem::ElementShape shape = fem::ElementShape::quad4, double rate = 2e-4,
          fem::Formulation formulation = fem::Formulation::standard)
      : mesh(fem::boxOf(shape, {elements[0], elements[1], 1}, {}, {0.1, 0.2, 0.1})),
        model(fem::makeModel(mesh)),
        solid(fem::makeSolid(mesh, std::move(field), {.formulation = formulation, .name = "sand"})) {
    model.add(solid);
    model.add(fem::followingPressure(mesh, fem::faceSet(mesh, "x+"), 1e5));
    model.constraints.hold(fem::nodeSet(mesh, "x-"), fem::componentX);
    model.constraints.hold(fem::nodeSet(mesh, "y-"), fem::componentY);
    model.constraints.prescribe(fem::nodeSet(mesh, "y+"), 1, [rate](double t) { return -rate * t; });
  }
  fem::Solid::Sample sample() { return solid->sample(model.nodes, {model.t, 0.0}); }
};

inline fem::StaticOptions roughly(double tolerance = 1e-5, double step = 0.5) {
  return {.newton = {.relativeTolerance = tolerance, .lineSearch = false}, .firstStep = step, .largestStep = step};
}

/// A field without elements: F in, answers out.
class Asked {
public:
  explicit Asked(std::shared_ptr<fem::PointField> field, int points = 1) : field_(std::move(field)) {
    std::vector<fem::PointPlace> places;
    for (int e = 0; e < points; ++e) places.push_back({e, 0, {}, 1.0});
    field_->open(places);
    const auto n = static_cast<std::size_t>(points);
    F_.resize(9 * n), P.resize(9 * n), tangent.resize(81 * n), energy.resize(n), dissipated.resize(n), reason.resize(n);
  }
  /// The same F at all points. @return the stress at the first
  Eigen::Matrix3d operator()(const Eigen::Matrix3d& F, bool withTangent = false, double dt = 1.0,
                             bool willCommit = false, bool moved = true) {
    for (std::size_t p = 0; p < energy.size(); ++p) Eigen::Map<RowMajor>(F_.data() + 9 * p) = F;
    std::ranges::fill(reason, std::string{});
    field_->evaluate({.F = F_,
                      .dt = dt,
                      .moved = moved,
                      .P = P,
                      .tangent = withTangent ? std::span<double>(tangent) : std::span<double>{},
                      .energy = energy,
                      .dissipated = dissipated,
                      .reason = reason,
                      .willCommit = willCommit});
    return matrixAt(P, 0);
  }
  rve::Tangent tangentAt(const Eigen::Matrix3d& F) {
    (*this)(F, true);
    return Eigen::Map<const Eigen::Matrix<double, 9, 9, Eigen::RowMajor>>(tangent.data());
  }
  fem::PointField& field() { return *field_; }

  std::vector<double> P, tangent, energy, dissipated;
  std::vector<std::string> reason;

private:
  std::shared_ptr<fem::PointField> field_;
  std::vector<double> F_;
};

}  // namespace dovetail::hierarchical
