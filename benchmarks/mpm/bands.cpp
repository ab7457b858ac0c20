// Soft sand pressed between plates until it forms a band: beside elements, with and without a width of the band.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "cases.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/fem/motion/dynamics.hpp"
#include "dovetail/fem/motion/stable_step.hpp"
#include "dovetail/fem/terms/contact_plane.hpp"
#include "dovetail/fem/terms/loads.hpp"
#include "dovetail/mpm/fill.hpp"
#include "dovetail/mpm/pair_gradient.hpp"
#include "scenes.hpp"
#include "soft_sand.hpp"

namespace dovetail::benchmark {

namespace {

constexpr double width = 1.0, height = 2.0, rate = 0.05, end = 0.04;
constexpr double plateStiffness = 50e6 * 1.35;  // Pa, the confined modulus, over the distance of points

/// Axial stress, Pa, and the fraction of the points that holds half of the shear, at 1 %, 2 % …
struct Course {
  std::vector<double> axial, fraction;
  double step = 0.0, residual = 0.0, broken = 0.0;
};

double plateAt(double t) {
  constexpr double start = 0.005 / rate;  // s, to come to its speed
  return -height * rate * (t < start ? 0.5 * t * t / start : t - 0.5 * start);
}

/// Fraction of the points that holds half of the shear |(F₁₁ − F₂₂, F₁₂ + F₂₁)|.
double fractionOf(const mpm::PointSolid& points) {
  std::vector<double> shear;
  const std::span<const double> F = points.answers().F();
  for (std::size_t k = 0; k < F.size(); k += 9) shear.push_back(std::hypot(F[k] - F[k + 4], F[k + 1] + F[k + 3]));
  std::ranges::sort(shear, std::greater<>());
  double all = 0.0, part = 0.0;
  for (const double one : shear) all += one;
  std::size_t taken = 0;
  while (part < 0.5 * all) part += shear[taken++];
  return static_cast<double>(taken) / static_cast<double>(shear.size());
}

class Biaxial {
public:
  Biaxial(int across, double modulus) {
    const double spacing = width / across, distance = 0.5 * spacing;
    const mpm::GridOptions grid{.spacing = spacing, .borders = {{.axis = 1, .place = 0.0}}};
    const mpm::MaterialPoints start = box({}, width, height, distance);
    points_ = mpm::makePoints(start, softSand({.weakSpot = Vec3{0.5 * width, 0.5 * height, 0.0}}), {.grid = grid});
    model_ = mpm::makeModel(points_);
    if (modulus > 0.0) model_.add(mpm::pairGradient(points_, start, {.modulus = modulus}));
    const fem::SolidMesh faces = mpm::facesOfBox(grid, {{}, {width, height, 1.0}}, 2);
    const std::size_t set = points_->addMarkers(faces.X);
    for (const char* const side : {"x-", "x+"})
      model_.add(mpm::onMarkers(points_, set, fem::deadPressure(faces, fem::faceSet(faces, side), allRoundPressure)));
    plate_ = fem::makeContactPlane(faces, fem::faceSet(faces, "y+"),
                                   {.point = {0.0, height - allRoundPressure * distance / plateStiffness, 0.0},
                                    .normal = {0.0, -1.0, 0.0},
                                    .motion =
                                        [](double t) {
                                          return Vec3{0.0, plateAt(t), 0.0};
                                        }},
                                   {.penalty = plateStiffness / distance});
    onPlate_ = &model_.add(mpm::onMarkers(points_, set, plate_));
    model_.add(fem::massDamping(20.0));
    fem::addMass(model_);
  }

  Course press() {
    Course course;
    course.step = 0.5 * fem::stableStep(model_).dt;
    fem::ExplicitIntegrator run(model_, course.step, {.energyEvery = 50, .checkEvery = 10});
    double mark = 0.0025, sum = 0.0;
    int count = 0, means = 0;
    try {
      while (means < 4 * std::lround(100.0 * end)) {
        run.step();
        sum += plate_->report(onPlate_->seen(model_.nodes), {.t = model_.t}).force.y, ++count;
        if (-plateAt(model_.t) / height < mark) continue;
        if (++means % 4 == 0) {
          course.axial.push_back(std::abs(sum / count / width));
          course.fraction.push_back(fractionOf(*points_));
        }
        mark += 0.0025, sum = 0.0, count = 0;
      }
    } catch (const NumericalError&) {
      course.broken = -plateAt(model_.t) / height;
    }
    course.residual = run.ledger().largestResidual() / std::abs(run.ledger().joules("motion of contact plane"));
    return course;
  }

private:
  std::shared_ptr<mpm::PointSolid> points_;
  std::shared_ptr<fem::ContactPlane> plate_;
  const mpm::MarkerTerm* onPlate_ = nullptr;
  fem::Model model_;
};

/// Largest difference of two courses from 2 % on, Pa.
double apart(const Course& a, const Course& b) {
  double most = 0.0;
  for (std::size_t k = 1; k < std::min(a.axial.size(), b.axial.size()); ++k)
    most = std::max(most, std::abs(a.axial[k] - b.axial[k]));
  return most;
}

}  // namespace

bool bands(bool quick) {
  const std::vector<int> grids = quick ? std::vector{8, 16} : std::vector{8, 16, 32};
  std::printf(
      "Axial stress, kPa, and the fraction of the points that holds half of the shear\n\n| cells | D, N | 1 %% | 2 %% "
      "| 3 %% | 4 %% | step, s | residual |\n|---|---|---|---|---|---|---|---|\n");
  std::vector<double> spread;
  for (const double modulus : {0.0, 90.0, 360.0}) {
    std::vector<Course> courses;
    for (const int across : grids) {
      courses.push_back(Biaxial(across, modulus).press());
      const Course& course = courses.back();
      std::printf("| %d × %d | %g |", across, 2 * across, modulus);
      for (std::size_t k = 0; k < 4; ++k)
        if (k < course.axial.size())
          std::printf(" %.1f, %.3f |", course.axial[k] / 1e3, course.fraction[k]);
        else
          std::printf(" broken at %.2f %% |", 100.0 * course.broken);
      std::printf(" %.2e | %.1e |\n", course.step, course.residual);
      std::fflush(stdout);
    }
    spread.push_back(apart(courses[courses.size() - 2], courses.back()));
  }
  std::printf("\nThe two finest grids are %.1f, %.1f and %.1f kPa apart at most\n", spread[0] / 1e3, spread[1] / 1e3,
              spread[2] / 1e3);
  return spread[2] < 0.3 * spread[0];
}

}  // namespace dovetail::benchmark
