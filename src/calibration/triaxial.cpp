#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/calibration/cell_probes.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/dem/setup/cell.hpp"
#include "dovetail/dem/setup/relax.hpp"

namespace dovetail::calibration {

double TriaxialCurve::mobilisedAngle(std::size_t k) const {
  return std::asin((axial[k] - lateral[k]) / (axial[k] + lateral[k]));
}

namespace {

void check(const TriaxialOptions& s) {
  if (!(s.strain > 0.0 && s.strain <= 1.0))
    throw InputError("the strain is " + formatNumber(s.strain), "triaxial compression",
                     "give one above 0, of at most 1");
  if (s.increments < 10 || s.increments > 1000000)
    throw InputError("the number of increments is " + std::to_string(s.increments), "triaxial compression",
                     "give 10 to 1000000");
  requirePositive(s.tolerance, "tolerance of the pressures across");
}

/// A cell on its way, and the strains across that keep the pressure there.
class Shearing {
public:
  Shearing(dem::Model& cell, const TriaxialOptions& settings)
      : cell_(cell), settings_(settings), wanted_(meanOf(cellPressures(cell))), volumeAtStart_(cellVolume(cell)) {
    requirePositive(wanted_, "pressure of the cell");
    look();
    record();
  }

  void shorten(double strain) {
    double lateral[2] = {ratio_[0] * strain, ratio_[1] * strain};
    const double before = now_.z;
    move({lateral[0], lateral[1], -strain});
    look();
    // As stiff across as the first increment, which hardly slides, was along.
    if (stiffness_ == 0.0) stiffness_ = std::max((now_.z - before) / strain, wanted_);
    for (int pass = 0; pass < passes && off() > settings_.tolerance; ++pass) {
      const double more[2] = {(now_.x - wanted_) / stiffness_, (now_.y - wanted_) / stiffness_};
      for (int k = 0; k < 2; ++k) lateral[k] += std::clamp(more[k], -strain, strain);
      move({std::clamp(more[0], -strain, strain), std::clamp(more[1], -strain, strain), 0.0});
      look();
    }
    if (off() > 0.1)
      throw NumericalError("the pressures across are " + formatNumber(now_.x) + " and " + formatNumber(now_.y) +
                               " Pa in place of " + formatNumber(wanted_) + " Pa",
                           "triaxial compression at a strain of " + formatNumber(strain_ + strain),
                           "take smaller increments, or a softer or denser packing");
    for (int k = 0; k < 2; ++k) ratio_[k] = 0.5 * (ratio_[k] + lateral[k] / strain);
    strain_ += strain;
    record();
  }

  TriaxialCurve curve;

private:
  static constexpr int passes = 10;

  void move(const Vec3& strain) {
    dem::strainCell(cell_, {std::expm1(strain.x), std::expm1(strain.y), std::expm1(strain.z)});
  }
  void look() {
    const dem::RelaxationReport report = dem::relax(cell_, {settings_.unbalanced, settings_.steps});
    curve.largestUnbalanced = std::max(curve.largestUnbalanced, report.residual);
    now_ = cellPressures(cell_);
  }
  double off() const { return std::max(std::abs(now_.x - wanted_), std::abs(now_.y - wanted_)) / wanted_; }
  void record() {
    curve.strain.push_back(strain_);
    curve.volume.push_back(-std::log(cellVolume(cell_) / volumeAtStart_));
    curve.axial.push_back(now_.z);
    curve.lateral.push_back(0.5 * (now_.x + now_.y));
  }

  dem::Model& cell_;
  const TriaxialOptions& settings_;
  double wanted_, volumeAtStart_, strain_ = 0.0, stiffness_ = 0.0;
  double ratio_[2] = {0.25, 0.25};
  Vec3 now_;
};

}  // namespace

TriaxialCurve triaxialCompression(dem::Model cell, const TriaxialOptions& settings) {
  check(settings);
  dem::findForces(cell);
  Shearing shearing(cell, settings);
  for (int k = 0; k < settings.increments; ++k) shearing.shorten(settings.strain / settings.increments);
  return shearing.curve;
}

double atStrain(const TriaxialCurve& curve, std::span<const double> values, double strain) {
  if (!(strain >= 0.0) || curve.strain.empty() || strain > curve.strain.back() * (1.0 + 1e-9))
    throw InputError(
        "there is nothing at a strain of " + formatNumber(strain), "triaxial compression",
        curve.strain.empty() ? "the curve is empty" : "take one from 0 to " + formatNumber(curve.strain.back()));
  const auto above = std::upper_bound(curve.strain.begin() + 1, curve.strain.end() - 1, strain);
  const auto k = static_cast<std::size_t>(above - curve.strain.begin());
  const double fraction = (strain - curve.strain[k - 1]) / (curve.strain[k] - curve.strain[k - 1]);
  return values[k - 1] + fraction * (values[k] - values[k - 1]);
}

Strength strengthOf(const TriaxialCurve& curve) {
  const std::size_t n = curve.size();
  if (n < 11) throw InputError("a curve of " + std::to_string(n) + " points", "strength", "take 10 increments or more");
  Strength found;
  for (std::size_t k = 0; k < n; ++k)
    if (curve.mobilisedAngle(k) > found.peakAngle) {
      found.peakAngle = curve.mobilisedAngle(k);
      found.peakStrain = curve.strain[k];
    }
  double axial = 0.0, lateral = 0.0;
  for (std::size_t k = n - n / 4; k < n; ++k) {
    axial += curve.axial[k];
    lateral += curve.lateral[k];
  }
  found.residualAngle = std::asin((axial - lateral) / (axial + lateral));
  const std::size_t window = n / 10;
  double steepest = 1e300;
  for (std::size_t k = window; k < n; ++k)
    steepest =
        std::min(steepest, (curve.volume[k] - curve.volume[k - window]) / (curve.strain[k] - curve.strain[k - window]));
  found.dilatancyAngle = std::asin(-steepest / (2.0 - steepest));
  return found;
}

Cone coneThrough(std::span<const TriaxialCurve> curves) {
  if (curves.empty()) throw InputError("there are no curves", "cone of Drucker and Prager", "give one at least");
  double n = 0.0, sp = 0.0, sq = 0.0, spp = 0.0, spq = 0.0;
  Cone cone;
  std::vector<std::array<double, 2>> peaks;
  for (const TriaxialCurve& curve : curves) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < curve.size(); ++k)
      if (curve.mobilisedAngle(k) > curve.mobilisedAngle(at)) at = k;
    const double p = (curve.axial[at] + 2.0 * curve.lateral[at]) / 3.0, q = curve.deviator(at);
    peaks.push_back({p, q});
    n += 1.0, sp += p, sq += q, spp += p * p, spq += p * q;
    cone.dilatancyAngle += strengthOf(curve).dilatancyAngle / static_cast<double>(curves.size());
  }
  const double spread = n * spp - sp * sp;
  double slope = spq / spp, intercept = 0.0;
  if (spread > 1e-6 * n * spp) {
    const double lineSlope = (n * spq - sp * sq) / spread, lineIntercept = (sq - lineSlope * sp) / n;
    if (lineIntercept > 0.0) slope = lineSlope, intercept = lineIntercept;
  }
  const double sine = 3.0 * slope / (6.0 + slope);
  cone.frictionAngle = std::asin(sine);
  cone.cohesion = intercept * (3.0 - sine) / (6.0 * std::cos(cone.frictionAngle));
  cone.dilatancyAngle = std::clamp(cone.dilatancyAngle, 0.0, cone.frictionAngle);
  for (const auto& [p, q] : peaks) cone.misfit = std::max(cone.misfit, std::abs(q - slope * p - intercept) / q);
  return cone;
}

}  // namespace dovetail::calibration
