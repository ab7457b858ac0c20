#include "reference/mode_table.hpp"

#include <algorithm>
#include <cmath>

#include "dovetail/core/error.hpp"

namespace dovetail::cantilever {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Quintic = std::array<double, 6>;

// Hermite's quintics through value, slope and curvature at both ends of a cell of width h; one row per mode.
void fitCell(const Eigen::MatrixX3d& left, const Eigen::MatrixX3d& right, double h, Eigen::Ref<MatrixXd> coefficient) {
  const VectorXd c0 = left.col(0), c1 = left.col(1), c2 = left.col(2) / 2.0;
  const VectorXd value = right.col(0) - c0 - c1 * h - c2 * (h * h);
  const VectorXd slope = (right.col(1) - c1 - c2 * (2.0 * h)) * h;
  const VectorXd curvature = (right.col(2) - 2.0 * c2) * (h * h);
  const double h3 = h * h * h;
  coefficient.col(0) = c0;
  coefficient.col(1) = c1;
  coefficient.col(2) = c2;
  coefficient.col(3) = (10.0 * value - 4.0 * slope + 0.5 * curvature) / h3;
  coefficient.col(4) = (-15.0 * value + 7.0 * slope - curvature) / (h3 * h);
  coefficient.col(5) = (6.0 * value - 3.0 * slope + 0.5 * curvature) / (h3 * h * h);
}

std::array<double, 3> evaluate(const Quintic& c, double t) {
  double value = c[5], first = 0.0, halfSecond = 0.0;
  for (int p = 4; p >= 0; --p) {
    halfSecond = halfSecond * t + first;
    first = first * t + value;
    value = value * t + c[p];
  }
  return {value, first, 2.0 * halfSecond};
}

using PowerWeights = Eigen::Matrix<double, 6, 1>;

// Three Gauss points a cell.
constexpr int gaussPoints = 3;
constexpr double gaussPlace[] = {0.1127016653792583115, 0.5, 0.8872983346207416885};
constexpr double gaussWeight[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

double slopeAt(const Quintic& c, double t) {
  return (((5.0 * c[5] * t + 4.0 * c[4]) * t + 3.0 * c[3]) * t + 2.0 * c[2]) * t + c[1];
}

// Weights of t⁰ … t⁵ that give the derivative at t.
PowerWeights slopeWeights(double t) {
  PowerWeights weights;
  weights[0] = 0.0;
  double power = 1.0;
  for (int p = 1; p < 6; ++p, power *= t) weights[p] = p * power;
  return weights;
}

PowerWeights powers(double t) {
  PowerWeights weights;
  weights[0] = 1.0;
  for (int p = 1; p < 6; ++p) weights[p] = weights[p - 1] * t;
  return weights;
}

}  // namespace

ModeTable::ModeTable(const BeamModes& modes, int cells, bool largeRotations)
    : length_(modes.length), cellWidth_(modes.length / cells), cells_(cells), largeRotations_(largeRotations) {
  if (cells < 1) throw InputError("the mode table has no cells", "tableCells", "give at least one");
  const auto n = static_cast<Eigen::Index>(modes.omega.size());
  deflection_.resize(n, 6 * cells);
  rotation_.resize(n, 6 * cells);
  if (largeRotations) gaussSlope_.resize(n, gaussPoints * cells);
  ModeShapes left = evaluateModes(modes, 0.0);
  for (int c = 0; c < cells; ++c) {
    const ModeShapes right = evaluateModes(modes, c + 1 == cells ? length_ : (c + 1) * cellWidth_);
    fitCell(left.deflection, right.deflection, cellWidth_, deflection_.middleCols(6 * c, 6));
    fitCell(left.rotation, right.rotation, cellWidth_, rotation_.middleCols(6 * c, 6));
    for (int g = 0; largeRotations && g < gaussPoints; ++g)
      gaussSlope_.col(gaussPoints * c + g) =
          deflection_.middleCols<6>(6 * c) * slopeWeights(gaussPlace[g] * cellWidth_);
    left = right;
  }
}

int ModeTable::cellOf(double s) const { return std::clamp(static_cast<int>(s / cellWidth_), 0, cells_ - 1); }

void ModeTable::loadCell(double s, const VectorXd& q, BeamCell& cell) const {
  cell.index = cellOf(s);
  cell.start = cell.index * cellWidth_;
  Eigen::Map<PowerWeights>(cell.deflection.data()).noalias() =
      deflection_.middleCols<6>(6 * cell.index).transpose() * q;
  Eigen::Map<PowerWeights>(cell.rotation.data()).noalias() = rotation_.middleCols<6>(6 * cell.index).transpose() * q;
  if (!largeRotations_) return;
  const Eigen::Index count = gaussPoints * cell.index;
  const VectorXd slope = gaussSlope_.leftCols(count).transpose() * q;
  Eigen::MatrixX2d integrandSlope(count, 2);
  cell.axialAtStart = cell.sinkAtStart = 0.0;
  for (Eigen::Index g = 0; g < count; ++g) {
    const double weight = gaussWeight[g % gaussPoints] * cellWidth_;
    const double sine = std::sin(slope[g]), cosine = std::cos(slope[g]);
    cell.axialAtStart += weight * (cosine - 1.0);
    cell.sinkAtStart += weight * (sine - slope[g]);
    integrandSlope(g, 0) = -weight * sine;
    integrandSlope(g, 1) = weight * (cosine - 1.0);
  }
  cell.gradientAtStart.noalias() = gaussSlope_.leftCols(count) * integrandSlope;
}

BeamFields ModeTable::fields(const BeamCell& cell, double s) const {
  const double t = s - cell.start;
  BeamFields fields{{0.0, 0.0, 0.0}, evaluate(cell.deflection, t), evaluate(cell.rotation, t)};
  if (!largeRotations_) return fields;
  double axial = cell.axialAtStart, sink = cell.sinkAtStart;
  for (int g = 0; g < gaussPoints; ++g) {
    const double slope = slopeAt(cell.deflection, gaussPlace[g] * t);
    axial += gaussWeight[g] * t * (std::cos(slope) - 1.0);
    sink += gaussWeight[g] * t * (std::sin(slope) - slope);
  }
  const auto [w, slope, curvature] = fields.vertical;
  const double sine = std::sin(slope), cosine = std::cos(slope);
  fields.axial = {axial, cosine - 1.0, -sine * curvature};
  fields.vertical = {w + sink, sine, cosine * curvature};
  return fields;
}

void ModeTable::gradients(const BeamCell& cell, double s, BeamGradients& gradients) const {
  const double t = s - cell.start;
  const auto deflection = deflection_.middleCols<6>(6 * cell.index);
  gradients.rotation.noalias() = rotation_.middleCols<6>(6 * cell.index) * powers(t);
  PowerWeights axial = PowerWeights::Zero(), vertical = powers(t);
  for (int g = 0; largeRotations_ && g < gaussPoints; ++g) {
    const double slope = slopeAt(cell.deflection, gaussPlace[g] * t);
    const PowerWeights weights = gaussWeight[g] * t * slopeWeights(gaussPlace[g] * t);
    axial -= std::sin(slope) * weights;
    vertical += (std::cos(slope) - 1.0) * weights;
  }
  gradients.axial.noalias() = deflection * axial;
  gradients.vertical.noalias() = deflection * vertical;
  if (!largeRotations_) return;
  gradients.axial += cell.gradientAtStart.col(0);
  gradients.vertical += cell.gradientAtStart.col(1);
}

}  // namespace dovetail::cantilever
