#include "reference/beam_modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "reference/legendre.hpp"

namespace dovetail::cantilever {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Integrals from 0 satisfy the clamp; the integral of P_k vanishes at both ends for k ≥ 1, which is a simple support.
void chooseFields(const BeamTheory& theory, RitzField& deflection, RitzField& rotation) {
  const bool clamped = theory.supports == Supports::clampedFree;
  deflection.integrals = clamped && !theory.shear ? 2 : 1;
  deflection.first = clamped ? 0 : 1;
  rotation.integrals = theory.shear ? (clamped ? 1 : 0) : deflection.integrals - 1;
  rotation.first = theory.shear ? 0 : deflection.first;
}

VectorXd basisValues(const LegendreFamily& family, const RitzField& field, int derivative, int count, double length) {
  VectorXd value(count);
  for (int k = 0; k < count; ++k) value[k] = family(field.integrals - derivative, k + field.first);
  return value / std::pow(length, derivative);
}

struct RitzSystem {
  MatrixXd stiffness, mass;
};

// Unknowns: the deflection's coefficients, then, with shear, the rotation's.
RitzSystem assemble(const Section& section, double length, const BeamTheory& theory, const RitzField& deflection,
                    const RitzField& rotation) {
  const int n = theory.basis, unknowns = theory.shear ? 2 * n : n;
  RitzSystem system{MatrixXd::Zero(unknowns, unknowns), MatrixXd::Zero(unknowns, unknowns)};
  LegendreFamily family(n + 1);
  const GaussRule rule = gaussRule(n + 4);
  VectorXd w = VectorXd::Zero(unknowns), angle = w, curvature = w, shearAngle = w;
  for (std::size_t g = 0; g < rule.point.size(); ++g) {
    family.evaluate(rule.point[g]);
    const double dy = rule.weight[g] * length;
    w.head(n) = basisValues(family, deflection, 0, n, length);
    if (theory.shear) {
      angle.tail(n) = basisValues(family, rotation, 0, n, length);
      curvature.tail(n) = basisValues(family, rotation, 1, n, length);
      shearAngle.head(n) = basisValues(family, deflection, 1, n, length);
      shearAngle.tail(n) = -angle.tail(n);
    } else {
      angle = basisValues(family, deflection, 1, n, length);
      curvature = basisValues(family, deflection, 2, n, length);
    }
    system.stiffness += dy * section.bending * curvature * curvature.transpose();
    system.mass += dy * section.mass * w * w.transpose();
    if (theory.shear) system.stiffness += dy * section.shear * shearAngle * shearAngle.transpose();
    if (theory.rotaryInertia) system.mass += dy * section.rotaryMass * angle * angle.transpose();
  }
  return system;
}

}  // namespace

BeamModes computeModes(const Section& section, double length, const BeamTheory& theory, int count) {
  if (theory.basis < 2 || theory.basis > 160)
    throw InputError("the Ritz basis has " + std::to_string(theory.basis) + " polynomials per field", "basis",
                     "give 2 to 160");
  if (count < 1 || count > theory.basis)
    throw InputError(std::to_string(count) + " modes asked of " + std::to_string(theory.basis) + " polynomials",
                     "modes", "give 1 to the size of the basis");
  BeamModes modes{.length = length, .omega = {}, .deflection = {}, .rotation = {}};
  chooseFields(theory, modes.deflection, modes.rotation);
  const RitzSystem system = assemble(section, length, theory, modes.deflection, modes.rotation);
  // M x = ω⁻² K x rather than K x = ω² M x: K is always positive definite, M is not without rotary inertia, and the
  // lowest modes come out with the smallest error.
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(system.mass, system.stiffness);
  if (solver.info() != Eigen::Success)
    throw NumericalError("the beam's eigenproblem did not converge", "beam modes", "check the section's stiffness");
  const int n = theory.basis;
  modes.deflection.coefficient.resize(n, count);
  modes.rotation.coefficient.resize(n, count);
  for (int j = 0; j < count; ++j) {
    const Eigen::Index column = solver.eigenvalues().size() - 1 - j;
    const double inverseSquare = solver.eigenvalues()[column];
    const VectorXd x = solver.eigenvectors().col(column) / std::sqrt(inverseSquare);
    modes.omega.push_back(1.0 / std::sqrt(inverseSquare));
    modes.deflection.coefficient.col(j) = x.head(n);
    modes.rotation.coefficient.col(j) = theory.shear ? VectorXd(x.tail(n)) : VectorXd(x / length);
  }
  return modes;
}

ModeShapes evaluateModes(const BeamModes& modes, double s) {
  const int n = static_cast<int>(modes.deflection.coefficient.rows());
  LegendreFamily family(n + 1);
  family.evaluate(s / modes.length);
  ModeShapes shapes;
  shapes.deflection.resize(modes.deflection.coefficient.cols(), 3);
  shapes.rotation.resize(modes.rotation.coefficient.cols(), 3);
  for (int d = 0; d < 3; ++d) {
    shapes.deflection.col(d) =
        modes.deflection.coefficient.transpose() * basisValues(family, modes.deflection, d, n, modes.length);
    shapes.rotation.col(d) =
        modes.rotation.coefficient.transpose() * basisValues(family, modes.rotation, d, n, modes.length);
  }
  return shapes;
}

}  // namespace dovetail::cantilever
