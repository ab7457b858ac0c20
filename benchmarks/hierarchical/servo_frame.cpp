// Periodic frames held by a servo, which moves them until opposite reactions cancel, beside the multipliers of the
// cell.
#include <algorithm>
#include <array>

#include "dovetail/core/parallel.hpp"
#include "figure.hpp"
#include "liu_packings.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double stiffness = 1e4;  // N/m (Liu, thesis TU Eindhoven 2018, Table 2.4)
constexpr double gain = 0.3;       // of k_n; printed ones make 1.5e-4 or 0.15
constexpr double tolerance = 1e-2, shear = 0.05;
constexpr int increments = 20, mostCorrections = 300;

struct Shearing {
  double stress = 0.0;       ///< norm of the mean, Pa
  double steps = 0.0;        ///< of all grains
  double residual = 0.0;     ///< largest that was accepted
  double corrections = 0.0;  ///< of the frame
};

const RestCriterion rest{.tolerance = 1e-3, .steps = 20000};

Eigen::Matrix3d sheared(int k) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 1) = shear * k / increments;
  return F;
}

/// Moves grains that are one by what pushes them together: a correction of Liu 2018, eqs 2.33 and 2.34, with the
/// reactions' sign mended. @return largest sum of forces over the mean contact force
double correct(rve::Rve& cell, double fraction) {
  const rve::CellState& s = cell.state;
  rve::Components w = s.v, theta = s.spin;
  for (rve::Components* field : {&w, &theta})
    for (std::vector<double>& component : *field) component.assign(component.size(), 0.0);
  const double meanForce = rve::balance(cell).meanForce;
  double worst = 0.0;
  for (const std::vector<int>& group : cell.frame.alike) {
    std::array<double, 3> sum{};
    double radius = 0.0;
    for (const int q : group) {
      const auto g = static_cast<std::size_t>(cell.frame.grain[static_cast<std::size_t>(q)]);
      for (std::size_t k = 0; k < 2; ++k) sum[k] += s.force[k][g];
      sum[2] += s.torque[2][g];
      radius = cell.radius[g];
    }
    worst = std::max({worst, std::hypot(sum[0], sum[1]) / meanForce, std::abs(sum[2]) / (radius * meanForce)});
    for (const int q : group) {
      const auto g = static_cast<std::size_t>(cell.frame.grain[static_cast<std::size_t>(q)]);
      for (std::size_t k = 0; k < 2; ++k) w[k][g] = fraction * sum[k] / stiffness;
      theta[2][g] = fraction * sum[2] / (stiffness * radius * radius);
    }
  }
  rve::displace(cell, w, theta);
  return worst;
}

Shearing byServo(const rve::Rve& packing, double fraction) {
  rve::Rve cell = rve::framed(packing, rve::everywhere(rve::Condition::displacement));
  Shearing course;
  for (int k = 1; k <= increments; ++k) {
    const rve::PathReport path = rve::followPath(cell, sheared(k), {.rest = rest});
    course.steps += static_cast<double>(path.steps + path.rest.steps);
    double worst = 1.0;
    for (int n = 0; n < mostCorrections && worst > tolerance; ++n) {
      worst = correct(cell, fraction);
      course.steps += static_cast<double>(rve::relax(cell, rest).steps);
      course.corrections += 1.0 / increments;
    }
    course.residual = std::max(course.residual, worst);
    course.stress += cauchyOf(cell).norm() / increments;
  }
  return course;
}

Shearing byMultipliers(const rve::Rve& packing) {
  rve::Rve cell = rve::framed(packing, rve::everywhere(rve::Condition::periodic));
  Shearing course;
  for (int k = 1; k <= increments; ++k) {
    const rve::PathReport path = rve::followPath(cell, sheared(k), {.rest = rest});
    course.steps += static_cast<double>(path.steps + path.rest.steps);
    course.stress += cauchyOf(cell).norm() / increments;
  }
  return course;
}

}  // namespace

FigureRows servoFrame(bool quick) {
  const std::size_t packings = quick ? 2 : 5;
  std::vector<double> off(packings), steps(packings), corrections(packings), residual(packings), printed(packings);
  parallelTasks(packings, [&](std::size_t k) {
    const rve::Springs springs{.stiffness = stiffness, .tangential = 0.2, .friction = 0.4};
    const rve::Rve packing = densePacking({200, 0.67e-3, 1.34e-3, 2e3, springs, 0.846}, 1 + 1000 * k);
    const Shearing multipliers = byMultipliers(packing), servo = byServo(packing, gain);
    off[k] = 100.0 * std::abs(servo.stress / multipliers.stress - 1.0);
    steps[k] = servo.steps / multipliers.steps;
    corrections[k] = servo.corrections;
    residual[k] = servo.residual;
    try {
      printed[k] = byServo(packing, -gain).residual;
    } catch (const Error&) {
      printed[k] = 1e300;  // frames have gone through each other
    }
  });
  const double diverges = *std::ranges::min_element(printed) > 1.0 ? 1.0 : 0.0;
  return {rowOf("mean stress by the servo differs from that by multipliers by, %", off, std::nan(""), 0.0),
          rowOf("steps of grains, servo over multipliers", steps, std::nan(""), 0.0),
          rowOf("corrections an increment", corrections, std::nan(""), 0.0),
          rowOf("largest forces out of balance on the frame over the mean contact force", residual, std::nan(""), 0.0),
          {"with the sign that is printed it diverges (1: yes)", diverges, 0.0, 1.0, 0.0}};
}

}  // namespace dovetail::benchmark
