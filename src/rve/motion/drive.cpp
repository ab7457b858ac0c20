#include "dovetail/rve/drive.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "dovetail/core/error.hpp"
#include "dovetail/core/finite.hpp"
#include "dovetail/rve/equilibrium.hpp"
#include "servo.hpp"

namespace dovetail::rve {

namespace {

constexpr const char* where = "drive of a cell";
constexpr double learning = 1e-2;  // of the strains that come with that of the test, per step
constexpr double atMost = 4.0;     // of these, over that of the test

void check(const Rve& cell, const Drive& how, std::span<const double> strains, const DriveOptions& settings) {
  if (!cell.frame.empty()) throw InputError("the cell has a frame", where, "give a periodic cell");
  if (!(settings.inertialNumber > 0.0 && settings.inertialNumber <= 1e-2))
    throw InputError("the inertial number is " + formatNumber(settings.inertialNumber), where,
                     "give one above 0, of at most 0.01: faster is not quasi-static");
  requirePositive(settings.tolerance, "tolerance of the stresses");
  requireFraction(settings.damping, "damping", where, true);
  requireFraction(settings.stepFraction, "the fraction of the critical step", where);
  if (settings.rest) validate(*settings.rest, where, 1);
  for (const double strain : strains)
    if (!std::isfinite(strain)) throw InputError("a strain is " + formatNumber(strain), where, "give finite strains");
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const bool held = !std::isnan(how.stress(i, j)), driven = how.rate(i, j) != 0.0;
      std::string name = "L";
      name.append(std::to_string(i + 1)).append(std::to_string(j + 1));
      if (!std::isfinite(how.rate(i, j)) || (held && !std::isfinite(how.stress(i, j))))
        throw InputError("rate or stress of " + name + " is not finite", where, "give finite numbers");
      if (held && driven) throw InputError(name + " has a rate and a stress", where, "give one of the two");
      if ((held || driven) && std::max(i, j) >= cell.dimension())
        throw InputError(name + " of discs is driven or held", where, "leave what lies out of their plane alone");
      if (held && i != j && !std::isnan(how.stress(j, i)))
        throw InputError(name + " and its mirror image are held", where, "hold one of the two: stress is symmetric");
    }
  if (how.rate.isZero(0.0)) throw InputError("nothing is driven", where, "give a rate other than 0");
  const double pressure = stress(cell).pressure;
  if (how.holds() && !(pressure > 0.0))
    throw InputError("the pressure is " + formatNumber(pressure) + " Pa", where, "press the cell together first");
}

class Driving {
public:
  Driving(Rve& cell, const Drive& how, const DriveOptions& settings)
      : cell_(cell), how_(how), settings_(settings), start_(cell.state.F) {
    servo_ = {.stress = how.stress,
              .pressure = std::max(stress(cell).pressure, std::numeric_limits<double>::min()),
              .lag = leastLag,
              .inertialNumber = atMost * settings.inertialNumber,
              .tolerance = settings.tolerance,
              .damping = settings.damping,
              .stepFraction = settings.stepFraction,
              .rest = settings.rest,
              .quiet = 1,
              .steps = settings.steps,
              .where = where};
  }

  void to(double strain) {
    while (strain_ != strain) {
      if (taken_ >= settings_.steps)
        throw NumericalError("the strain is " + formatNumber(strain_) + " after " + std::to_string(taken_) + " steps",
                             where, "allow more steps, or a larger tolerance of the stresses");
      advance(strain);
    }
    if (how_.holds())
      holdStress(cell_, servo_, taken_);
    else if (settings_.rest)
      relax(cell_, *settings_.rest, settings_.stepFraction);
  }

private:
  void advance(double strain) {
    const double dt = settings_.stepFraction * cell_.state.criticalStep;
    const double whole = strainOfStep(cell_, servo_, settings_.inertialNumber, dt);
    // It waits where stresses are off.
    const double off = how_.holds() ? stressOff(cell_, servo_) / settings_.tolerance : 0.0;
    const double pace = std::clamp(2.0 - off, 0.0, 1.0), left = strain - strain_;
    const bool arrives = std::abs(left) <= pace * whole;
    const double ds = arrives ? left : std::copysign(pace * whole, left);
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    if (how_.holds()) {
      const Eigen::Matrix3d given = servoStrain(cell_, servo_, dt);
      if (ds != 0.0) accompanying_ = (accompanying_ + learning * given / ds).cwiseMin(atMost).cwiseMax(-atMost);
      G += given + ds * accompanying_;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) G(i, j) += i == j ? std::expm1(ds * how_.rate(i, i)) : ds * how_.rate(i, j);
    } else {
      G = relativeDeformation(cell_, inClosedForm(strain_ + ds));
    }
    step(cell_, dt, G, settings_.damping);
    strain_ = arrives ? strain : strain_ + ds;
    ++taken_;
  }
  /// F at a strain when nothing is held: exp(s L) of the start's.
  Eigen::Matrix3d inClosedForm(double strain) const { return exponential(strain * how_.rate) * start_; }

  static Eigen::Matrix3d exponential(const Eigen::Matrix3d& A) {
    int halvings = 0;
    for (double size = A.norm(); size > 0.1; size *= 0.5) ++halvings;
    const Eigen::Matrix3d small = std::ldexp(1.0, -halvings) * A;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Identity(), term = sum;
    for (int k = 1; k <= 12; ++k) {
      term = (term * small / k).eval();
      sum += term;
    }
    for (int k = 0; k < halvings; ++k) sum = (sum * sum).eval();
    return sum;
  }

  Rve& cell_;
  const Drive& how_;
  const DriveOptions& settings_;
  Eigen::Matrix3d start_;
  Servo servo_;
  Eigen::Matrix3d accompanying_ = Eigen::Matrix3d::Zero();  // strains of what is held, over that of the test
  double strain_ = 0.0;
  std::int64_t taken_ = 0;
};

void requireAxis(Shape shape, int axis) {
  const int last = shape == Shape::disc ? 1 : 2;
  if (axis < 0 || axis > last)
    throw InputError("the axis is " + std::to_string(axis), where, "give 0 to " + std::to_string(last));
}

}  // namespace

Drive isotropicCompression(Shape shape) {
  Drive how;
  const int dimension = shape == Shape::disc ? 2 : 3;
  for (int k = 0; k < dimension; ++k) how.rate(k, k) = -1.0 / dimension;
  return how;
}

Drive oedometer(Shape shape, int axis) {
  requireAxis(shape, axis);
  Drive how;
  how.rate(axis, axis) = -1.0;
  return how;
}

Drive biaxial(Shape shape, int axis, std::optional<double> pressure) {
  requireAxis(Shape::disc, axis);
  Drive how = oedometer(shape, axis);
  const int across = 1 - axis;
  if (pressure)
    how.stress(across, across) = -requirePositive(*pressure, "pressure of the sides");
  else
    how.rate(across, across) = 1.0;
  return how;
}

Drive triaxial(int axis, std::optional<double> pressure) {
  Drive how = oedometer(Shape::sphere, axis);
  for (int k = 0; k < 3; ++k) {
    if (k == axis) continue;
    if (pressure)
      how.stress(k, k) = -requirePositive(*pressure, "pressure of the sides");
    else
      how.rate(k, k) = 0.5;
  }
  return how;
}

Drive simpleShear(std::optional<double> pressure) {
  Drive how;
  how.rate(0, 1) = 1.0;
  if (pressure) how.stress(1, 1) = -requirePositive(*pressure, "normal pressure");
  return how;
}

DrivenState lookAt(const Rve& cell, double strain) {
  DrivenState found;
  found.strain = strain;
  found.F = cell.state.F;
  found.stress = stress(cell).cauchy;
  found.volume = volume(cell);
  found.solidFraction = solidFraction(cell);
  const Balance now = balance(cell);
  found.coordination = now.coordination;
  found.sliding = now.contacts > 0 ? static_cast<double>(now.sliding) / now.contacts : 0.0;
  found.unbalanced = now.unbalanced;
  found.fabric = fabric(cell);
  found.ledger = cell.state.ledger;
  found.stored = storedEnergy(cell);
  found.kinetic = kineticEnergy(cell);
  return found;
}

std::vector<DrivenState> drive(Rve& cell, const Drive& how, std::span<const double> strains,
                               const DriveOptions& settings, const std::function<void(const DrivenState&)>& each) {
  check(cell, how, strains, settings);
  std::vector<DrivenState> course;
  const auto look = [&](double strain) {
    course.push_back(lookAt(cell, strain));
    if (each) each(course.back());
  };
  look(0.0);
  Driving driving(cell, how, settings);
  for (const double strain : strains) {
    driving.to(strain);
    look(strain);
  }
  return course;
}

std::vector<double> equalStrains(double most, int n) {
  std::vector<double> strains;
  for (int k = 1; k <= n; ++k) strains.push_back(most * k / n);
  return strains;
}

std::vector<double> growingStrains(double least, double most, int n) {
  std::vector<double> strains;
  for (int k = 0; k < n; ++k)
    strains.push_back(k + 1 == n ? most : least * std::pow(most / least, static_cast<double>(k) / (n - 1)));
  return strains;
}

}  // namespace dovetail::rve
