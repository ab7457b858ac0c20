// Tests of cells: what is held is held, what is driven is driven, and nothing vanishes.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "cells.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/rve/drive.hpp"
#include "ledger.hpp"

namespace dovetail::rve {
namespace {

/// The same grains with x and y exchanged; without friction before, so that no springs are stretched.
Rve turned(const Rve& cell) {
  Grains grains{.shape = cell.shape, .radius = cell.radius, .density = cell.density};
  const auto swapped = [](const Vec3& a) { return Vec3{a.y, a.x, a.z}; };
  for (std::size_t i = 0; i < cell.size(); ++i)
    grains.centre.push_back(
        {cell.state.x[1][i], cell.state.x[0][i], cell.state.x[2].empty() ? 0.0 : cell.state.x[2][i]});
  geometry::Lattice lattice = cell.state.lattice;
  const auto before = lattice.period;
  lattice.period = {swapped(before[1]), swapped(before[0]), swapped(before[2])};
  return makeRve(grains, lattice, cell.springs);
}

/// ∫ V σ : D dt between states, by the trapezoidal rule; F of triangles or along the axes.
double workBetween(const std::vector<DrivenState>& course) {
  double work = 0.0;
  for (std::size_t k = 1; k < course.size(); ++k) {
    const DrivenState &a = course[k - 1], &b = course[k];
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity(), G = b.F * a.F.inverse();
    const Eigen::Matrix3d L = 2.0 * (G - one) * (G + one).inverse();
    work += 0.5 * (a.volume * a.stress + b.volume * b.stress).cwiseProduct(0.5 * (L + L.transpose())).sum();
  }
  return work;
}

double pressureOf(const DrivenState& state, int axis) { return -state.stress(axis, axis); }

const double atPressure = 1e5, ofSpheres = 1e6;

TEST(Drive, SidesKeepTheirPressure) {
  Rve discs = pressedDiscs(100);
  for (const DrivenState& state : drive(discs, biaxial(Shape::disc, 1, atPressure), equalStrains(0.03, 60))) {
    EXPECT_NEAR(pressureOf(state, 0), atPressure, 1e-3 * atPressure) << state.strain;
    EXPECT_NEAR(std::log(state.F(1, 1)), -state.strain, 1e-12);
    EXPECT_EQ(state.F(0, 1), 0.0);
  }
  Rve spheres = pressedSpheres(80);
  for (const DrivenState& state : drive(spheres, triaxial(2, ofSpheres), equalStrains(0.02, 20)))
    for (const int axis : {0, 1}) EXPECT_NEAR(pressureOf(state, axis), ofSpheres, 1e-3 * ofSpheres) << state.strain;
  Rve plane = pressedSpheres(80);
  for (const DrivenState& state : drive(plane, biaxial(Shape::sphere, 0, ofSpheres), equalStrains(0.01, 10))) {
    EXPECT_NEAR(pressureOf(state, 1), ofSpheres, 1e-3 * ofSpheres) << state.strain;
    EXPECT_EQ(state.F(2, 2), 1.0);
  }
}

TEST(Drive, LayersKeepTheirPressureWhileTheyAreSheared) {
  Rve cell = pressedDiscs(100);
  const std::vector<DrivenState> course = drive(cell, simpleShear(atPressure), equalStrains(0.05, 50));
  for (const DrivenState& state : course) {
    EXPECT_NEAR(pressureOf(state, 1), atPressure, 1e-3 * atPressure) << state.strain;
    EXPECT_EQ(state.F(0, 0), 1.0);
    EXPECT_EQ(state.F(1, 0), 0.0);
  }
  EXPECT_GT(course.back().stress(0, 1), 0.1 * atPressure);
  EXPECT_GT(course.back().F(1, 1), 1.0);  // dense grains need more room
}

TEST(Drive, StressesMayBeHeldInShear) {
  Rve cell = pressedDiscs(100);
  Drive how = biaxial(Shape::disc, 1, atPressure);
  how.stress(0, 1) = 0.02 * atPressure;
  const std::vector<DrivenState> course = drive(cell, how, equalStrains(0.005, 5));
  for (std::size_t k = 1; k < course.size(); ++k) EXPECT_NEAR(course[k].stress(0, 1), how.stress(0, 1), 2e-5 * 1e5);
}

TEST(Drive, OedometersHaveNoStrainAcross) {
  Rve discs = pressedDiscs(80), spheres = pressedSpheres(64);
  for (const DrivenState& state : drive(discs, oedometer(Shape::disc, 1), equalStrains(0.01, 5)))
    EXPECT_LT((state.F - plane(1.0, 0.0, 0.0, std::exp(-state.strain))).norm(), 1e-15);
  for (const DrivenState& state : drive(spheres, oedometer(Shape::sphere, 2), equalStrains(0.01, 5))) {
    const Eigen::Matrix3d F = Eigen::Vector3d(1.0, 1.0, std::exp(-state.strain)).asDiagonal();
    EXPECT_LT((state.F - F).norm(), 1e-15);
  }
}

TEST(Drive, ConstantVolumesAreConstant) {
  const auto volumesStay = [](Rve cell, const Drive& how) {
    for (const DrivenState& state : drive(cell, how, equalStrains(0.1, 3), {.inertialNumber = 1e-2})) {
      EXPECT_NEAR(state.F.determinant(), 1.0, 1e-12);
      EXPECT_NEAR(state.volume / cell.volume, 1.0, 1e-12);
    }
  };
  volumesStay(pressedDiscs(64), biaxial(Shape::disc, 0, {}));
  volumesStay(pressedDiscs(64), simpleShear({}));
  volumesStay(pressedSpheres(64), triaxial(1, {}));
}

TEST(Drive, StrainsAreLogarithmic) {
  Rve cell = pressedDiscs(64);
  const DrivenState end = drive(cell, isotropicCompression(Shape::disc), equalStrains(0.02, 4)).back();
  EXPECT_NEAR(std::log(end.F.determinant()), -0.02, 1e-14);
  EXPECT_NEAR(end.F(0, 0), end.F(1, 1), 1e-15);
  cell = pressedDiscs(64);
  EXPECT_NEAR(drive(cell, simpleShear({}), equalStrains(0.1, 2)).back().F(0, 1), 0.1, 1e-15);
  Rve spheres = pressedSpheres(64);
  const DrivenState pressed = drive(spheres, isotropicCompression(Shape::sphere), equalStrains(0.01, 1)).back();
  EXPECT_NEAR(std::log(pressed.F.determinant()), -0.01, 1e-14);
}

TEST(Drive, WorkIsThatOfStressAndStrain) {
  Rve cell = pressedDiscs(100);
  const auto errorOf = [](Rve sample, const Drive& how, int looks) {
    const std::vector<DrivenState> course =
        drive(sample, how, equalStrains(0.01, looks), {.inertialNumber = 1e-4, .damping = 0.1});
    return std::abs(workBetween(course) / course.back().ledger.work - 1.0);
  };
  EXPECT_LT(errorOf(cell, oedometer(Shape::disc, 1), 400), 1e-3);
  EXPECT_LT(errorOf(cell, simpleShear({}), 400), 1e-3);
  EXPECT_LT(errorOf(cell, biaxial(Shape::disc, 1, atPressure), 400), 5e-3);
}

TEST(Drive, NothingVanishes) {
  const Rve start = pressedDiscs(100);
  const double stored = storedEnergy(start);
  const auto residualOf = [&](double stepFraction) {
    Rve cell = start;
    const std::vector<DrivenState> course =
        drive(cell, biaxial(Shape::disc, 1, atPressure), equalStrains(0.02, 4), {.stepFraction = stepFraction});
    EXPECT_GT(course.back().ledger.friction, 0.2 * course.back().ledger.work);
    EXPECT_EQ(course.back().stored, storedEnergy(cell));
    return std::abs(ledgerResidual(cell, stored));
  };
  const double coarse = residualOf(0.8), fine = residualOf(0.1);
  EXPECT_LT(coarse, 1e-3);
  EXPECT_LT(fine, 0.5 * coarse);
}

TEST(Drive, AxesAreAlike) {
  const auto sameTurned = [](const Rve& cell, const Drive& how, const Drive& other) {
    constexpr double tolerance = 1e-7;
    // Both with new lists of contacts, and so with the same steps.
    Rve two = turned(cell), one = turned(two);
    const std::vector<double> strains = equalStrains(1e-3, 4);
    const std::vector<DrivenState> a = drive(one, how, strains), b = drive(two, other, strains);
    const int across[] = {1, 0, 2};
    for (std::size_t k = 0; k < a.size(); ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          EXPECT_NEAR(a[k].stress(i, j), b[k].stress(across[i], across[j]), tolerance * a[k].stress.norm());
          EXPECT_NEAR(a[k].F(i, j), b[k].F(across[i], across[j]), 1e-2 * tolerance);
        }
  };
  sameTurned(pressedDiscs(80), biaxial(Shape::disc, 1, atPressure), biaxial(Shape::disc, 0, atPressure));
  sameTurned(pressedSpheres(64), triaxial(0, ofSpheres), triaxial(1, ofSpheres));
  Drive across;
  across.rate(1, 0) = 1.0;
  sameTurned(pressedDiscs(80), simpleShear({}), across);
}

TEST(Drive, SmallStrainsGoBackWhenceTheyCame) {
  Rve cell = pressedDiscs(80);
  const DriveOptions quiet{.inertialNumber = 1e-4, .rest = RestCriterion{.tolerance = 1e-7}};
  const std::vector<DrivenState> course = drive(cell, oedometer(Shape::disc, 1), std::vector{1e-5, 0.0}, quiet);
  const double there = (course[1].stress - course[0].stress).norm(),
               back = (course[2].stress - course[0].stress).norm();
  EXPECT_GT(there, 1e-3 * atPressure);
  EXPECT_LT(back, 0.02 * there);
  EXPECT_LT((cell.state.F - Eigen::Matrix3d::Identity()).norm(), 1e-14);
}

TEST(Drive, StatesComeOneByOne) {
  Rve cell = pressedDiscs(64);
  std::vector<double> seen;
  const std::vector<DrivenState> course = drive(cell, oedometer(Shape::disc, 0), growingStrains(1e-4, 1e-2, 3), {},
                                                [&](const DrivenState& state) { seen.push_back(state.strain); });
  ASSERT_EQ(seen.size(), 4u);
  EXPECT_EQ(seen[0], 0.0);
  EXPECT_NEAR(seen[2], 1e-3, 1e-15);
  EXPECT_EQ(seen[3], 1e-2);
  EXPECT_EQ(course.back().stress, stress(cell).cauchy);
  EXPECT_EQ(course.back().coordination, balance(cell).coordination);
}

TEST(Drive, BadSettingsAreRefused) {
  Rve cell = squareArray(4), spheres = pressedSpheres(64);
  const std::vector<double> strains{0.01};
  EXPECT_THROW(drive(cell, {}, strains), InputError);
  EXPECT_THROW(drive(cell, oedometer(Shape::disc, 1), strains, {.inertialNumber = 0.1}), InputError);
  EXPECT_THROW(drive(cell, oedometer(Shape::disc, 1), strains, {.tolerance = 0.0}), InputError);
  EXPECT_THROW(drive(cell, oedometer(Shape::disc, 1), strains, {.damping = 1.0}), InputError);
  EXPECT_THROW(drive(cell, oedometer(Shape::disc, 1), std::vector{std::nan("")}), InputError);
  EXPECT_THROW(drive(cell, triaxial(2, atPressure), strains), InputError);
  EXPECT_THROW(oedometer(Shape::disc, 2), InputError);
  EXPECT_THROW(biaxial(Shape::sphere, 2, {}), InputError);
  EXPECT_THROW(biaxial(Shape::disc, 0, -1e5), InputError);
  Drive both = oedometer(Shape::disc, 1);
  both.stress(1, 1) = -1e5;
  EXPECT_THROW(drive(cell, both, strains), InputError);
  Drive twice = oedometer(Shape::disc, 1);
  twice.stress(0, 1) = twice.stress(1, 0) = 0.0;
  EXPECT_THROW(drive(cell, twice, strains), InputError);
  Rve open = framed(pressedDiscs(64), everywhere(Condition::periodic));
  EXPECT_THROW(drive(open, oedometer(Shape::disc, 1), strains), InputError);
  Rve loose = squareArray(4, 0.99e-3);
  EXPECT_THROW(drive(loose, biaxial(Shape::disc, 1, atPressure), strains), InputError);
}

TEST(Drive, GivesUp) {
  Rve cell = pressedDiscs(64);
  const Drive how = biaxial(Shape::disc, 1, atPressure);
  EXPECT_THROW(drive(cell, how, equalStrains(0.1, 2), {.steps = 100}), NumericalError);
}

}  // namespace
}  // namespace dovetail::rve
