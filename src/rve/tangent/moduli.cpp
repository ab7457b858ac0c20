#include "dovetail/rve/moduli.hpp"

#include <Eigen/LU>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/equilibrium.hpp"

namespace dovetail::rve {

namespace {

constexpr const char* where = "secant moduli of a cell";

/// Change of the Cauchy stress per size of a strain without spin.
Eigen::Matrix3d answerTo(const Rve& cell, const Tangent& tangent, const Eigen::Matrix3d& strain) {
  const Eigen::Matrix3d& F = cell.state.F;
  const Eigen::Matrix3d dF = strain * F;
  Eigen::Matrix3d dP = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 9; ++i)
    for (int k = 0; k < 9; ++k) dP(i / 3, i % 3) += tangent(i, k) * dF(k / 3, k % 3);
  return (dP * F.transpose() + nominalStress(cell) * dF.transpose()) / F.determinant() -
         stress(cell).cauchy * strain.trace();
}

/// States of a copy at rest, the first before any strain.
std::vector<DrivenState> course(Rve cell, const Drive& how, std::span<const double> strains,
                                const DriveOptions& settings) {
  if (!settings.rest) throw InputError("states are not brought to rest", where, "give DriveOptions::rest");
  for (std::size_t k = 0; k < strains.size(); ++k)
    if (!(strains[k] > (k > 0 ? strains[k - 1] : 0.0)))
      throw InputError("strain " + std::to_string(k) + " is " + formatNumber(strains[k]), where,
                       "give strains above 0 that grow");
  relax(cell, *settings.rest, settings.stepFraction);
  std::vector<DrivenState> states = drive(cell, how, strains, settings);
  for (const DrivenState& state : states)
    if (!(state.unbalanced <= settings.rest->tolerance))
      throw NumericalError("forces are out of balance by " + formatNumber(state.unbalanced) + " at a strain of " +
                               formatNumber(state.strain),
                           where, "allow more steps of rest, or a larger tolerance");
  return states;
}

}  // namespace

Moduli moduliOf(const Rve& cell, const Tangent& tangent) {
  const int dimension = cell.dimension();
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  for (int k = 0; k < dimension; ++k) all(k, k) = 1.0;
  double stretched = 0.0, sheared = 0.0, pairs = 0.0;
  for (int i = 0; i < dimension; ++i)
    for (int j = i + 1; j < dimension; ++j) {
      Eigen::Matrix3d stretch = Eigen::Matrix3d::Zero(), shear = Eigen::Matrix3d::Zero();
      stretch(i, i) = 0.5;
      stretch(j, j) = -0.5;
      shear(i, j) = shear(j, i) = 0.5;
      const Eigen::Matrix3d answer = answerTo(cell, tangent, stretch);
      stretched += 0.5 * (answer(i, i) - answer(j, j));
      sheared += 0.5 * (answerTo(cell, tangent, shear) + answerTo(cell, tangent, shear).transpose())(i, j);
      ++pairs;
    }
  // Deviatoric strains: as many stretches as axes less one, and one shear for each pair of axes.
  const double stretches = dimension - 1.0;
  return {answerTo(cell, tangent, all).trace() / (dimension * dimension),
          (stretches * stretched / pairs + sheared) / (stretches + pairs)};
}

SecantModuli secantModuli(const Rve& cell, std::span<const double> strains, const DriveOptions& settings) {
  const std::vector<DrivenState> pressed = course(cell, isotropicCompression(cell.shape), strains, settings),
                                 sheared = course(cell, simpleShear({}), strains, settings);
  SecantModuli found{{strains.begin(), strains.end()}, {}, {}};
  for (std::size_t k = 0; k < strains.size(); ++k) {
    const auto pressure = [&](const DrivenState& state) { return -state.stress.trace() / cell.dimension(); };
    found.bulk.push_back((pressure(pressed[k + 1]) - pressure(pressed[0])) / strains[k]);
    found.shear.push_back((sheared[k + 1].stress(0, 1) - sheared[0].stress(0, 1)) / strains[k]);
  }
  return found;
}

}  // namespace dovetail::rve
