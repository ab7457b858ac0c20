// Which steps, transfers and shapes live through what: a block thrown into a held border, hit and spun.
#include <cmath>
#include <cstdio>
#include <vector>

#include "cases.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "scenes.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double side = 0.5, poisson = 0.3;
constexpr int cells = 8, steps = 200;

enum class Event { thrown, hit, spun };
constexpr const char* eventName[] = {"thrown", "hit", "spun"};

struct Setting {
  Event event = Event::thrown;
  double pace = 0.1;  ///< over that of waves
  double youngs = 1e6;
  double fraction = 0.8;  ///< of the stable step at the start
  mpm::Shape shape = mpm::Shape::quadratic;
  mpm::Transfer transfer = mpm::Transfer::flip;
};

double youngsWave(double youngs) {
  return std::sqrt(youngs * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson)) / density);
}

void setOff(const Setting& set, double pace, mpm::MaterialPoints& points) {
  const Vec3 centre = points.x.front() + 0.5 * (points.x.back() - points.x.front());
  for (std::size_t p = 0; p < points.x.size(); ++p) {
    const Vec3 arm = points.x[p] - centre;
    if (set.event == Event::thrown) points.v[p] = {0.3 * pace, -pace, 0.0};
    if (set.event == Event::hit) points.v[p] = {0.0, arm.y > 0.25 * side ? -pace : 0.0, 0.0};
    if (set.event == Event::spun) points.v[p] = 2.0 / side * pace * Vec3{-arm.y, arm.x, 0.0};
  }
}

/// What comes of it in one sign: "·" it lives, "r" refused with the point named, "E" its energy has grown, "!" it has
/// numbers that are none, or was refused without a name.
char fate(const Setting& set) {
  const double h = side / cells;
  mpm::MaterialPoints points = box({0.0, 0.5 * h, 0.0}, side, side, 0.5 * h);
  setOff(set, set.pace * youngsWave(set.youngs), points);
  std::vector<mpm::GridBorder> borders;
  if (set.event != Event::spun) borders.push_back({.axis = 1, .kind = mpm::BorderKind::held});
  try {
    const auto solid =
        mpm::makePoints(points, neoHookeanField(set.youngs, poisson),
                        {.grid = {.spacing = h, .shape = set.shape, .borders = borders}, .transfer = set.transfer});
    fem::Model model = mpm::makeModel(solid);
    fem::addMass(model);
    fem::ExplicitIntegrator run(model, set.fraction * fem::stableStep(model).dt, {.checkStep = false});
    const double before = run.kineticEnergy() + fem::storedEnergy(model, {});
    run.run(steps);
    const double after = run.kineticEnergy() + fem::storedEnergy(model, {.t = model.t});
    for (const Vec3& x : solid->places(model.nodes))
      if (!isFinite(x)) return '!';
    if (!std::isfinite(after)) return '!';
    return after > 1.1 * before ? 'E' : '.';
  } catch (const NumericalError& error) {
    const std::string why = error.what();
    return why.find("point ") != std::string::npos || why.find("node ") != std::string::npos ? 'r' : '!';
  }
}

}  // namespace

bool stability(bool quick) {
  const std::vector<double> fractions{0.5, 0.9, 1.5, 3.0}, stiffnesses{1e4, 1e8};
  std::printf("Steps over the bound at the start:");
  for (const double fraction : fractions) std::printf(" %g", fraction);
  std::printf(
      ", one sign each, first E = 10 kPa, then 100 MPa; . lives, r refused by name, E energy has grown, ! neither\n\n"
      "| event | speed over c | flip linear | flip gimp | flip quadratic | flip cubic | apic quadratic | apic cubic |\n"
      "|---|---|---|---|---|---|---|---|\n");
  bool holds = true;
  for (const Event event : {Event::thrown, Event::hit, Event::spun})
    for (const double pace : {0.05, 0.2, 0.5, 1.0, 2.0}) {
      if (quick && pace != 0.2) continue;
      std::printf("| %s | %g |", eventName[static_cast<int>(event)], pace);
      for (const mpm::Transfer transfer : {mpm::Transfer::flip, mpm::Transfer::apic})
        for (const mpm::Shape shape :
             {mpm::Shape::linear, mpm::Shape::gimp, mpm::Shape::quadratic, mpm::Shape::cubic}) {
          if (transfer == mpm::Transfer::apic && mpm::secondMoment(shape) == 0.0) continue;
          std::printf(" ");
          for (const double youngs : stiffnesses) {
            for (const double fraction : fractions) {
              const char sign = fate({event, pace, youngs, fraction, shape, transfer});
              holds = holds && sign != '!';
              std::printf("%c", sign);
            }
            std::printf("%s", youngs == stiffnesses.back() ? " |" : " ");
          }
          std::fflush(stdout);
        }
      std::printf("\n");
    }
  return holds;
}

}  // namespace dovetail::benchmark
