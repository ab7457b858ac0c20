#include "dovetail/rve/operators.hpp"

#include <Eigen/LU>
#include <limits>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "motion/polar.hpp"
#include "network.hpp"

namespace dovetail::rve {

namespace {

/// From strains δF F⁻¹ to δF, and from the stress Σ f ⊗ b to V₀ P.
Tangent pulledBack(const Rve& cell, const Eigen::MatrixXd& spatial) {
  const int dimension = cell.dimension();
  const Eigen::Matrix3d inverse = cell.state.F.inverse();
  Tangent tangent = Tangent::Zero();
  for (int i = 0; i < dimension; ++i)
    for (int J = 0; J < dimension; ++J)
      for (int k = 0; k < dimension; ++k)
        for (int L = 0; L < dimension; ++L)
          for (int m = 0; m < dimension; ++m)
            for (int n = 0; n < dimension; ++n)
              tangent(3 * i + J, 3 * k + L) +=
                  inverse(J, m) * inverse(L, n) * spatial(dimension * i + m, dimension * k + n) / cell.volume;
  return tangent;
}

Eigen::Matrix3d probed(Rve cell, const Eigen::Matrix3d& F, const ProbeOptions& settings) {
  deform(cell, relativeDeformation(cell, F));
  RestReport rest = polish(cell, settings.unbalanced);
  if (!rest.atRest) {
    relax(cell, {.tolerance = 1e-6});
    rest = polish(cell, settings.unbalanced);
  }
  if (!rest.atRest)
    throw NumericalError("forces are out of balance by " + formatNumber(rest.residual), "elastic probe of a cell",
                         "relax the cell first, or take a larger tolerance or another strain");
  return nominalStress(cell);
}

Eigen::Matrix3d answered(Rve cell, const Eigen::Matrix3d& F, const PathOptions& path) {
  const RestReport rest = followPath(cell, F, path).rest;
  if (!rest.atRest)
    throw NumericalError("forces are out of balance by " + formatNumber(rest.residual), "path probe of a cell",
                         "allow more steps of rest, or a larger tolerance");
  return nominalStress(cell);
}

/// What changes by each component, at the tangent's columns.
template <class Slope>
Tangent byComponents(const Rve& cell, const Slope& slope) {
  Tangent tangent = Tangent::Zero();
  for (int k = 0; k < cell.dimension(); ++k)
    for (int L = 0; L < cell.dimension(); ++L) {
      const Eigen::Matrix3d change = slope(k, L);
      for (int i = 0; i < 3; ++i)
        for (int J = 0; J < 3; ++J) tangent(3 * i + J, 3 * k + L) = change(i, J);
    }
  return tangent;
}

}  // namespace

Tangent elasticTangent(const Rve& cell) { return pulledBack(cell, Network(cell, {}).relaxedStressByStrain()); }

Tangent frictionalTangent(const Rve& cell) {
  return pulledBack(cell, Network(cell, {.slips = true}).relaxedStressByStrain());
}

Tangent voigtTangent(const Rve& cell) { return pulledBack(cell, affineStressByStrain(cell, {.prestress = false})); }

Tangent elasticProbe(const Rve& start, const ProbeOptions& settings) {
  requirePositive(settings.strain, "strain of the probe");
  requirePositive(settings.unbalanced, "unbalanced fraction of forces");
  Rve cell = start;
  stop(cell);
  if (cell.springs.slides()) {
    Springs sticking = cell.springs;
    sticking.friction = std::numeric_limits<double>::infinity();
    setSprings(cell, sticking);
  }
  const double never = std::numeric_limits<double>::infinity();
  cell.bonds.tensileStrength = cell.bonds.shearStrength = cell.bonds.bendingStrength = never;
  cell.state.bonds = cell.bonds;
  return byComponents(cell, [&](int k, int L) -> Eigen::Matrix3d {
    Eigen::Matrix3d more = cell.state.F, less = more;
    more(k, L) += settings.strain;
    less(k, L) -= settings.strain;
    return (probed(cell, more, settings) - probed(cell, less, settings)) / (2.0 * settings.strain);
  });
}

Tangent numericalTangent(const Rve& committed, const Eigen::Matrix3d& F, const NumericalTangentOptions& settings) {
  requirePositive(settings.strain, "strain of the probe");
  const Eigen::Matrix3d P = answered(committed, F, settings.path);
  return byComponents(committed, [&](int k, int L) -> Eigen::Matrix3d {
    Eigen::Matrix3d more = F;
    more(k, L) += settings.strain;
    return (answered(committed, more, settings.path) - P) / settings.strain;
  });
}

namespace {

/// Components i and k of ∂P_iJ/∂F_kL, turned.
Tangent turned(const Tangent& tangent, const Eigen::Matrix3d& by) {
  Tangent T = Tangent::Zero();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) T.block<3, 3>(3 * i, 3 * k).diagonal().setConstant(by(i, k));
  return T * tangent * T.transpose();
}

}  // namespace

Tangent AveragedTangent::at(const Eigen::Matrix3d& nowF) const { return turned(mean, polar(nowF).turn); }

Tangent AveragedTangent::next(const Eigen::Matrix3d& nowF, const Eigen::Matrix3d& nowP,
                              const std::function<Tangent()>& probe) {
  if (count > 0 && nowF != F) {
    const Eigen::Matrix3d back = polar(nowF * F.inverse()).turn.transpose();
    frozen = frozen || (back * nowP - P).cwiseProduct(back * nowF - F).sum() <= 0.0;
  }
  if (frozen) return at(nowF);
  F = nowF;
  P = nowP;
  Tangent now = probe();
  mean += (turned(now, polar(F).turn.transpose()) - mean) / ++count;
  return now;
}

RestReport polish(Rve& cell, double tolerance, int iterations) {
  requirePositive(tolerance, "unbalanced fraction of forces");
  stop(cell);
  RestReport report;
  report.residual = balance(cell).unbalanced;
  CellState best;
  for (int k = 0; k < iterations && report.residual > tolerance; ++k) {
    save(cell, best);
    bool better = false;
    for (const bool slips : {true, false}) {
      Components w, theta;
      Network(cell, {.slips = slips}).solve(w, theta);
      displace(cell, w, theta);
      const double now = balance(cell).unbalanced;
      better = now < report.residual;
      if (better) report.residual = now;
      if (better || balance(cell).sliding == 0) break;
      restore(cell, best);
    }
    if (!better) {
      restore(cell, best);
      break;
    }
    ++report.steps;
  }
  report.atRest = report.residual <= tolerance;
  return report;
}

}  // namespace dovetail::rve
